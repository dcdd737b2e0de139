// Rules of the manual and of EN 50170, one after the other.
#include "runtime/bus/profibus/line_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/bus/profibus/cfg_data.hpp"

namespace ipos::profibus {
namespace {

constexpr size_t kMostInSegment = 32;  // without a repeater

// Of SD2 without access points, and of the other frames.
constexpr Bits kDataFrame = 99, kTokenFrame = 33, kStatusFrame = 66;

struct CableLimit {
  std::string_view what;
  double Cable::*value;
  double from;
  double to;
  std::string_view unit;
};
// Cable type A (appendix A).
constexpr double kNoLimit = 1e9;
constexpr CableLimit kTypeA[] = {{"surge impedance", &Cable::ohms, 135, 165, "ohm"},
                                 {"capacitance", &Cable::picofarads_a_metre, 0, 30, "pF/m"},
                                 {"loop resistance", &Cable::ohms_a_kilometre, 0, 110, "ohm/km"},
                                 {"core diameter", &Cable::diameter, 0.64, kNoLimit, "mm"},
                                 {"core cross section", &Cable::section, 0.34, kNoLimit, "mm2"}};

void check_cable(const LinePlan& plan, std::vector<std::string>& found) {
  for (const CableLimit& limit : kTypeA) {
    const double value = plan.cable.*limit.value;
    if (value >= limit.from && value <= limit.to) continue;
    found.push_back(fmt::format("{} of the cable is {} {}, type A has {}", limit.what, value, limit.unit,
                                limit.to == kNoLimit ? fmt::format("more than {}", limit.from)
                                : limit.from == 0    ? fmt::format("less than {}", limit.to)
                                                     : fmt::format("{} to {}", limit.from, limit.to)));
  }
  const BaudRate* rate = find_baud_rate(plan.baud);
  if (rate == nullptr)
    found.push_back(fmt::format("{} baud is no rate of these units", plan.baud));
  else if (plan.cable.metres > rate->metres)
    found.push_back(fmt::format("{} m of cable; at {} baud a segment has at most {} m", plan.cable.metres,
                                plan.baud, rate->metres));
}

// At both ends and nowhere else. The master is the first on the cable.
void check_terminators(const LinePlan& plan, std::vector<std::string>& found) {
  if (plan.stations.empty()) return;
  if (!plan.master_terminated) found.push_back("the master is the first on the line and not terminated");
  for (const PlannedStation& station : plan.stations) {
    const bool last = &station == &plan.stations.back();
    if (last && !station.terminated)
      found.push_back(fmt::format("{} is the last on the line and not terminated", station.name));
    if (!last && station.terminated)
      found.push_back(fmt::format("{} is terminated, but not at an end of the line", station.name));
  }
}

// 2.1.2 and 2.2.
std::string misfit(const PlannedStation& s) {
  switch (s.interface) {
    case Interface::Ffp31A:
      if (s.series != InverterSeries::B) return "FFP 31A is for MOVITRAC 31B";
      if (s.service_code_4 < 14) return "FFP 31A wants a service code of component 4 of at least 14";
      return "";
    case Interface::Ffp31C:
      if (s.series != InverterSeries::C) return "FFP 31C is for MOVITRAC 31C";
      return s.size >= 1 && s.size <= 4 ? "" : "FFP 31C is for sizes 1 to 4";
    case Interface::Card: return "";
    case Interface::Size0: break;
  }
  return s.series == InverterSeries::C && s.size == 0
             ? ""
             : "the built-in interface is that of MOVITRAC 31C size 0";
}

void check_station(const PlannedStation& s, std::vector<std::string>& found) {
  if (const std::string text = misfit(s); !text.empty()) found.push_back(fmt::format("{}: {}", s.name, text));
  const auto kind = s.interface == Interface::Size0 ? OptionKind::Size0 : OptionKind::Ffp31;
  const OptionType& type = s.card != nullptr ? *s.card : option_type(kind);
  if (s.ident != type.ident)
    found.push_back(fmt::format("{}: the master expects ident {:04X}h, the unit has {:04X}h", s.name, s.ident,
                                type.ident));
  if (s.octets == 0 && s.of_fms) return;
  const auto all = configurations(type.accepts.set);
  if (std::none_of(all.begin(), all.end(), [&](const Configuration& c) {
        return c.octets == s.octets && c.words >= type.accepts.least && c.words <= type.accepts.most;
      }))
    found.push_back(fmt::format("{}: {} octets are no configuration of this unit", s.name, s.octets));
}

}  // namespace

Bits cycle_bits(const LinePlan& plan) {
  const auto masters = static_cast<Bits>(plan.masters.size());
  Bits bits = masters * (kSynBits + kTokenFrame + plan.idle_2);
  for (const PlannedStation& station : plan.stations)
    bits += kSynBits + 2 * (kDataFrame + kCharacterBits * station.octets) + plan.tsdr + plan.idle_1;
  const BaudRate* rate = find_baud_rate(plan.baud);
  if (plan.gap_poll && rate != nullptr) bits += masters * (kSynBits + kStatusFrame + rate->slot);
  return bits;
}

std::vector<std::string> check_line(const LinePlan& plan) {
  std::vector<std::string> found;
  check_cable(plan, found);
  check_terminators(plan, found);
  if (const size_t all = plan.stations.size() + plan.masters.size(); all > kMostInSegment)
    found.push_back(fmt::format("{} stations; a segment has at most {}", all, kMostInSegment));
  std::set<uint8_t> addresses;
  for (const uint8_t master : plan.masters)
    if (!addresses.insert(master).second)
      found.push_back(fmt::format("two masters have the address {}", master));
  for (const PlannedStation& s : plan.stations) {
    if (s.address > kLastStation)
      found.push_back(fmt::format("{}: address {} is not in 0..{}", s.name, s.address, kLastStation));
    if (!addresses.insert(s.address).second)
      found.push_back(fmt::format("{}: address {} is given twice", s.name, s.address));
  }
  return found;
}

size_t wrong_terminators(const LinePlan& plan) {
  std::vector<std::string> found;
  check_terminators(plan, found);
  return found.size();
}

std::vector<std::string> check_plan(const LinePlan& plan) {
  std::vector<std::string> found = check_line(plan);
  for (const PlannedStation& station : plan.stations) {
    check_station(station, found);
    if (!station.watchdog || find_baud_rate(plan.baud) == nullptr) continue;
    const Time cycle = time_of(cycle_bits(plan), plan.baud);
    if (*station.watchdog <= cycle)
      found.push_back(fmt::format("{}: the watchdog of {} ms is not longer than a cycle of {:.2f} ms",
                                  station.name, *station.watchdog / runtime::kMillisecond,
                                  static_cast<double>(cycle) / 1e6));
  }
  return found;
}

}  // namespace ipos::profibus
