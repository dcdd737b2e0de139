// What can be wrong with the cable and who is on it (1053 1610 p. 8, 12, 13; MOVITRAC 07
// chapters 2.1, 3.1, 7.1).
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runtime/bus_plan/checks.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kMostStations = 64;
constexpr uint32_t kImpedance = 120;   // ohm at 1 MHz
constexpr uint32_t kCapacitance = 40;  // pF/m at 1 kHz, at most
constexpr std::array<std::pair<uint32_t, uint32_t>, 4> kLengths = {
    {{125'000, 320}, {250'000, 160}, {500'000, 80}, {1'000'000, 40}}};

bool is_movidrive(const Station& station) {
  const std::string_view name = station.config().unit->name;
  return name == "md60a" || name == "compact" || name == "mdxb";
}

class CableCheck {
 public:
  CableCheck(const LineRoster& roster, std::vector<Finding>& findings)
      : roster_(roster), findings_(findings) {}

  void run(const PlantFile& file) {
    stations();
    length();
    cable();
    termination();
    mixed_units();
    for (const FaultConfig& fault : file.faults)
      if (fault.bus == roster_.config->name) planted(fault);
  }

 private:
  void find(FindingKind kind, std::string text) {
    findings_.push_back({kind, roster_.config->name, std::move(text)});
  }

  void stations() {
    if (roster_.members.size() > kMostStations)
      find(FindingKind::TooManyStations,
           fmt::format("{} stations, at most {} may share the line", roster_.members.size(), kMostStations));
    for (const Member& member : roster_.members)
      if (member.station != nullptr && settings_of(member).baud != roster_.config->baud)
        find(FindingKind::BaudRate,
             fmt::format("{} is set to {} kbaud ({}), the line has {} kbaud: it neither hears nor answers",
                         member.name, settings_of(member).baud / 1000,
                         member.station->config().unit->generation != stdlib::Generation::B ? "P816"
                         : member.sbus == 1                                                 ? "P884"
                                                                                            : "P894",
                         roster_.config->baud / 1000));
  }

  void length() {
    const uint32_t limit = cable_limit(roster_.config->baud);
    const uint32_t length = (roster_.config->length_mm + 999) / 1000;
    if (length > limit)
      find(FindingKind::LineTooLong, fmt::format("{} m of cable, at {} kbaud at most {} m", length,
                                                 roster_.config->baud / 1000, limit));
  }

  void cable() {
    if (roster_.config->impedance != 0 && roster_.config->impedance != kImpedance)
      find(FindingKind::CableData,
           fmt::format("cable of {} ohm, {} ohm are needed", roster_.config->impedance, kImpedance));
    if (roster_.config->capacitance > kCapacitance)
      find(FindingKind::CableData,
           fmt::format("cable of {} pF/m, at most {} pF/m", roster_.config->capacitance, kCapacitance));
  }

  // Looked at once any station of the line states its S12.
  void termination() {
    const auto& members = roster_.members;
    if (members.size() < 2 || std::none_of(members.begin(), members.end(),
                                           [](const Member& m) { return m.terminator.has_value(); }))
      return;
    for (size_t n = 0; n < members.size(); ++n) {
      const bool end = n == 0 || n + 1 == members.size();
      const bool on = members[n].terminator.value_or(false);
      if (on && members[n].branch)
        find(FindingKind::Termination,
             fmt::format("{}: S12 is on, so the cable that goes on over SC21/SC22 is dead", members[n].name));
      else if (end && !on)
        find(FindingKind::Termination,
             fmt::format("{} is at an end of the line, but its S12 is off", members[n].name));
      else if (!end && on)
        find(FindingKind::Termination,
             fmt::format("{} is not at an end of the line, but its S12 is on", members[n].name));
    }
  }

  void mixed_units() {
    if (roster_.config->baud != 1'000'000) return;
    std::string mch, other;
    for (const Member& member : roster_.members) {
      if (member.station == nullptr || !is_movidrive(*member.station)) continue;
      (member.station->config().device == "MCH42A" ? mch : other) = member.name;
    }
    if (!mch.empty() && !other.empty())
      find(FindingKind::MixedMch42a,
           fmt::format("{} is an MCH42A, {} another MOVIDRIVE: at 1000 kbaud they must not share a line", mch,
                       other));
  }

  void planted(const FaultConfig& config) {
    const FaultType& type = fault_type(config.fault.kind);
    const std::string whose = config.station.empty() ? "the line" : config.station;
    if (config.fault.kind == FaultKind::Swap)
      find(FindingKind::SwappedWires, fmt::format("{} {}", whose, type.text));
    else if (config.fault.behind)
      find(FindingKind::CableFault, fmt::format("the line {} behind {}", type.text, whose));
    else if (type.scope == FaultScope::Wiring || config.fault.kind == FaultKind::Terminator)
      find(FindingKind::CableFault, fmt::format("{} {}", whose, type.text));
  }

  const LineRoster& roster_;
  std::vector<Finding>& findings_;
};

}  // namespace

uint32_t cable_limit(uint32_t baud) {
  for (const auto& [rate, metres] : kLengths)
    if (rate == baud) return metres;
  return 0;
}

void check_cable(const LineRoster& roster, const PlantFile& file, std::vector<Finding>& findings) {
  CableCheck(roster, findings).run(file);
}

}  // namespace ipos::runtime
