// Texts and the table of states.
#include "tools/testing/test_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace ipos::tools::testing {
namespace {

using runtime::Station;

// The line of the command that ended the program, 0 when no fault has.
int32_t fault_line(const Station& station) {
  if (station.machine() == nullptr || station.machine()->fault().number == 0) return 0;
  const std::string place = station.source_place(station.machine()->fault().address);
  const size_t column = place.rfind(':');
  const size_t line = column == std::string::npos ? column : place.rfind(':', column - 1);
  if (line == std::string::npos) return 0;
  int32_t number = 0;
  std::from_chars(place.data() + line + 1, place.data() + column, number);
  return number;
}

std::string range_text(std::pair<int64_t, int64_t> range) {
  if (range.first == range.second) return std::to_string(range.first);
  if (range.first == INT64_MIN) return fmt::format("at most {}", range.second);
  if (range.second == INT64_MAX) return fmt::format("at least {}", range.first);
  return fmt::format("{} to {}", range.first, range.second);
}

}  // namespace

const std::vector<StationState> kStationStates = {
    {"fault", "fault number, errors and warnings; 0 is none",
     [](const Station& station) { return int32_t{station.fault()}; }},
    {"status", "status word 1", [](const Station& station) { return int32_t{station.status_word_1()}; }},
    {"enabled", "1 while it is enabled",
     [](const Station& station) {
       return station.drive().state().verdict().reason == runtime::Block::None ? 1 : 0;
     }},
    {"ready", "1 while it is ready",
     [](const Station& station) { return station.drive().state().ready() ? 1 : 0; }},
    {"speed", "of the shaft, 1/1000 rpm",
     [](const Station& station) { return station.drive().state().axis().speed; }},
    {"setpoint", "speed the ramp orders, 1/1000 rpm",
     [](const Station& station) { return station.drive().state().axis().setpoint; }},
    {"position", "increments of the shaft",
     [](const Station& station) { return station.drive().state().shaft_position(); }},
    {"powered", "1 while the power is on", [](const Station& station) { return station.powered() ? 1 : 0; }},
    {"running", "1 while a task of the program runs or waits",
     [](const Station& station) { return station.program_over() ? 0 : 1; }},
    {"program_fault", "number of the fault that ended the program; 0 is none",
     [](const Station& station) {
       return station.machine() == nullptr ? 0 : int32_t{station.machine()->fault().number};
     }},
    {"program_fault_line", "source line of that fault", fault_line},
};

std::string Subject::text() const {
  switch (kind) {
    case Kind::Frame: return fmt::format("frame {} on {}", pattern, bus);
    case Kind::Telegram: return fmt::format("telegram '{}' on {}", pattern, bus);
    case Kind::State:
    case Kind::ProcessData:
    case Kind::Signal: break;
  }
  return fmt::format("{} of {}", signal.name, signal.station);
}

bool Subject::operator==(const Subject& other) const {
  return kind == other.kind && signal.station == other.signal.station && signal.kind == other.signal.kind &&
         signal.name == other.signal.name && bus == other.bus && pattern == other.pattern;
}

bool Condition::holds(int64_t value) const {
  const bool inside = std::any_of(ranges.begin(), ranges.end(), [&](const auto& range) {
    return value >= range.first && value <= range.second;
  });
  return inside != negated;
}

std::string Condition::text() const {
  std::vector<std::string> parts;
  for (const auto& range : ranges) parts.push_back(range_text(range));
  return fmt::format("{}{}{}", negated ? "not " : "", parts.size() > 1 ? "one of " : "",
                     fmt::join(parts, ", "));
}

std::string time_text(Time time) {
  if (time % runtime::kMillisecond == 0) return fmt::format("{} ms", time / runtime::kMillisecond);
  return fmt::format("{:.3f} ms", static_cast<double>(time) / 1e6);
}

}  // namespace ipos::tools::testing
