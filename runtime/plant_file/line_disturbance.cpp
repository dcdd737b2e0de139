// The shares, and what the file says of each kind of line.
#include "runtime/plant_file/line_disturbance.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/profibus/line_plan.hpp"
#include "runtime/plant_file/can_cable.hpp"
#include "runtime/plant_file/profibus_paper.hpp"
#include "runtime/plant_file/serial_plan.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kShareOfTerminator = 500;

// What of a cable matters here.
struct Cable {
  uint32_t limit_m = 0;  // 0: there is none
  size_t wrong_ends = 0;
};

Cable can_cable(const PlantFile& file, const BusConfig& bus) {
  Cable cable{can_length_limit(bus.baud)};
  for (const CableFinding& finding : can_cable_findings(file, bus)) cable.wrong_ends += finding.rule == CableRule::Termination;
  return cable;
}

Cable profibus_cable(const PlantFile& file, const BusConfig& bus) {
  Cable cable;
  if (const profibus::BaudRate* rate = profibus::find_baud_rate(bus.baud)) cable.limit_m = rate->metres;
  cable.wrong_ends = profibus::wrong_terminators(profibus_paper(file, bus));
  return cable;
}

Cable serial_cable(const PlantFile& file, const BusConfig& bus) {
  Cable cable{serial_length_limit(file, bus) / 1000};
  for (const SerialCableFinding& finding : serial_cable_findings(file, bus))
    cable.wrong_ends += finding.rule == SerialCableFinding::Rule::Terminated;
  return cable;
}

Cable cable_of(const PlantFile& file, const BusConfig& bus) {
  switch (bus.kind) {
    case BusKind::Can: return can_cable(file, bus);
    case BusKind::Profibus: return profibus_cable(file, bus);
    case BusKind::Rs485:
    case BusKind::Rs232: return serial_cable(file, bus);
    default: return {};
  }
}

// Lines of RS-485 and RS-232 have a resistor in each unit, so only one more can be wrong.
std::string cause_of_terminators(const BusConfig& bus, const Cable& cable) {
  if (is_serial(bus.kind)) return "there are terminating resistors beside those of the units";
  if (cable.wrong_ends == 1) return "a terminating resistor is not where it must be";
  return fmt::format("{} terminating resistors are not where they must be", cable.wrong_ends);
}

}  // namespace

uint32_t share_of_length(uint32_t length_mm, uint32_t limit_m) {
  const uint64_t limit_mm = uint64_t{limit_m} * 1000;
  if (limit_mm == 0 || length_mm <= limit_mm) return 0;
  const uint64_t share = (length_mm - limit_mm) * kAllFrames / limit_mm;
  return static_cast<uint32_t>(std::clamp<uint64_t>(share, 1, kAllFrames));
}

uint32_t share_of_terminators(size_t wrong) {
  return static_cast<uint32_t>(std::min<size_t>(wrong * kShareOfTerminator, kAllFrames));
}

std::vector<LineDisturbance> line_disturbances(const PlantFile& file, const BusConfig& bus) {
  std::vector<LineDisturbance> found;
  const Cable cable = cable_of(file, bus);
  if (const uint32_t share = share_of_length(bus.length_mm, cable.limit_m); share != 0)
    found.push_back({"length", share, fmt::format("the line is longer than {} m", cable.limit_m)});
  if (const uint32_t share = share_of_terminators(cable.wrong_ends); share != 0)
    found.push_back({bus.kind == BusKind::Rs232 ? "noise" : "terminator", share, cause_of_terminators(bus, cable)});
  return found;
}

}  // namespace ipos::runtime
