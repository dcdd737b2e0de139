// Texts.
#include "tools/test_file/test_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant_file/state_names.hpp"

namespace ipos::tools::testing {
namespace {

std::string range_text(const Subject& of, std::pair<int64_t, int64_t> range) {
  const std::string first = of.value_text(range.first);
  if (range.first == range.second) return first;
  if (range.first == INT64_MIN) return "at most " + of.value_text(range.second);
  if (range.second == INT64_MAX) return "at least " + first;
  return first + " to " + of.value_text(range.second);
}

}  // namespace

std::string Subject::text() const {
  if (kind != Kind::Message) return fmt::format("{}{} of {}", is_old() ? "state " : "", signal.name, signal.station);
  const char* quote = message == "frame" && pattern.find(' ') == std::string::npos ? "" : "'";
  return fmt::format("{} {}{}{} on {}", message, quote, pattern, quote, bus);
}

std::string Subject::value_text(int64_t value) const { return runtime::decimal_text(value, signal.decimals); }

bool Subject::is_old() const {
  return kind == Kind::Signal && signal.kind == runtime::SignalKind::State && !runtime::old_state(signal.name).empty();
}

bool Subject::operator==(const Subject& other) const {
  return kind == other.kind && signal.station == other.signal.station && signal.kind == other.signal.kind &&
         signal.name == other.signal.name && signal.decimals == other.signal.decimals && bus == other.bus && pattern == other.pattern;
}

bool Condition::holds(int64_t value) const {
  const bool inside = std::any_of(ranges.begin(), ranges.end(), [&](const auto& range) {
    return value >= range.first && value <= range.second;
  });
  return inside != negated;
}

std::string Condition::text(const Subject& of) const {
  std::vector<std::string> parts;
  for (const auto& range : ranges) parts.push_back(range_text(of, range));
  return fmt::format("{}{}{}", negated ? "not " : "", parts.size() > 1 ? "one of " : "",
                     fmt::join(parts, ", "));
}

std::string time_text(Time time) {
  if (time % runtime::kMillisecond == 0) return fmt::format("{} ms", time / runtime::kMillisecond);
  return fmt::format("{:.3f} ms", static_cast<double>(time) / 1e6);
}

}  // namespace ipos::tools::testing
