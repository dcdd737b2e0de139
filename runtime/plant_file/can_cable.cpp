// The rules of the cable, one after the other.
#include "runtime/plant_file/can_cable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace ipos::runtime {
namespace {

constexpr size_t kMostCanStations = 64;
constexpr uint32_t kCanImpedance = 120;   // ohm at 1 MHz
constexpr uint32_t kCanCapacitance = 40;  // pF/m at 1 kHz, at most
constexpr std::array<std::pair<uint32_t, uint32_t>, 4> kCanLengths = {
    {{125'000, 320}, {250'000, 160}, {500'000, 80}, {1'000'000, 40}}};

// Who hangs on the line, with the switch of its terminating resistor.
struct Plug {
  std::string name;
  const StationConfig* station;  // null: a master control, or a gateway
  std::string_view terminator;
  std::optional<bool> on;
  bool branch;
  uint32_t place;
};

// In the order of the cable, which is that of the file.
std::vector<Plug> plugs_of(const PlantFile& file, const std::string& bus) {
  std::vector<Plug> plugs;
  for (const StationConfig& station : file.stations) {
    const uint32_t place = station.place.line;
    if (station.sbus == bus)
      plugs.push_back({station.name, &station, "S12", station.terminator, station.branch, place});
    if (station.sbus2 == bus)
      plugs.push_back({station.name, &station, "switch R", station.terminator2, false, place});
  }
  for (const ControlConfig& control : file.controls)
    if (control.sbus == bus)
      plugs.push_back({control.name, nullptr, "S12", control.terminator, false, control.place.line});
  std::stable_sort(plugs.begin(), plugs.end(),
                   [](const Plug& a, const Plug& b) { return a.place < b.place; });
  return plugs;
}

class CanCableCheck {
 public:
  CanCableCheck(const PlantFile& file, const BusConfig& bus) : bus_(bus), plugs_(plugs_of(file, bus.name)) {}

  std::vector<CableFinding> run() {
    if (plugs_.size() > kMostCanStations)
      find(CableRule::TooManyStations,
           fmt::format("{} stations, at most {} may share the line", plugs_.size(), kMostCanStations));
    length();
    cable();
    termination();
    mixed_units();
    return std::move(findings_);
  }

 private:
  void find(CableRule rule, std::string text) { findings_.push_back({rule, std::move(text)}); }

  void length() {
    const uint32_t limit = can_length_limit(bus_.baud);
    const uint32_t length = (bus_.length_mm + 999) / 1000;
    if (length > limit)
      find(CableRule::LineTooLong,
           fmt::format("{} m of cable, at {} kbaud at most {} m", length, bus_.baud / 1000, limit));
  }

  void cable() {
    if (bus_.impedance != 0 && bus_.impedance != kCanImpedance)
      find(CableRule::CableData,
           fmt::format("cable of {} ohm, {} ohm are needed", bus_.impedance, kCanImpedance));
    if (bus_.capacitance > kCanCapacitance)
      find(CableRule::CableData,
           fmt::format("cable of {} pF/m, at most {} pF/m", bus_.capacitance, kCanCapacitance));
  }

  // Looked at once anybody on the line states his.
  void termination() {
    if (plugs_.size() < 2 ||
        std::none_of(plugs_.begin(), plugs_.end(), [](const Plug& plug) { return plug.on.has_value(); }))
      return;
    for (size_t n = 0; n < plugs_.size(); ++n) {
      const Plug& plug = plugs_[n];
      const bool end = n == 0 || n + 1 == plugs_.size();
      const bool on = plug.on.value_or(false);
      if (on && plug.branch)
        find(CableRule::Termination,
             fmt::format("{}: S12 is on, so the cable that goes on over SC21/SC22 is dead", plug.name));
      else if (end != on)
        find(CableRule::Termination, fmt::format("{} is {} an end of the line, but its {} is {}", plug.name,
                                                 end ? "at" : "not at", plug.terminator, on ? "on" : "off"));
    }
  }

  void mixed_units() {
    if (bus_.baud != 1'000'000) return;
    std::string mch, other;
    for (const Plug& plug : plugs_) {
      if (plug.station == nullptr || !plug.station->unit->has(stdlib::Trait::CableOfMovidrive)) continue;
      (plug.station->device == "MCH42A" ? mch : other) = plug.name;
    }
    if (!mch.empty() && !other.empty())
      find(CableRule::MixedMch42a,
           fmt::format("{} is an MCH42A, {} another MOVIDRIVE: at 1000 kbaud they must not share a line", mch,
                       other));
  }

  const BusConfig& bus_;
  std::vector<Plug> plugs_;
  std::vector<CableFinding> findings_;
};

}  // namespace

uint32_t can_length_limit(uint32_t baud) {
  for (const auto& [rate, metres] : kCanLengths)
    if (rate == baud) return metres;
  return 0;
}

std::vector<CableFinding> can_cable_findings(const PlantFile& file, const BusConfig& bus) {
  return CanCableCheck(file, bus).run();
}

}  // namespace ipos::runtime
