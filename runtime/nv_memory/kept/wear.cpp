// Rates in whole milliseconds; a span below one counts as one.
#include "runtime/nv_memory/kept/wear.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {
namespace {

// From `seconds` of the unit on, and the next unit not yet.
struct TimeUnit {
  int64_t from;
  int64_t length;
  const char* name;
};
constexpr int64_t kDay = 86'400, kYear = 31'557'600;
constexpr TimeUnit kTimeUnits[] = {{2 * kYear, kYear, "years"}, {2 * kDay, kDay, "days"}, {3'600, 3'600, "h"}};

// "36 s", "2.7 h", "115.7 days", "3.8 years"
std::string duration(int64_t seconds) {
  for (const TimeUnit& unit : kTimeUnits)
    if (seconds >= unit.from)
      return fmt::format("{}.{} {}", seconds / unit.length, seconds % unit.length * 10 / unit.length, unit.name);
  return fmt::format("{} s", seconds);
}

}  // namespace

std::string memory_life(Time interval) { return duration(interval / (kSecond / kEepromLife)); }

std::optional<std::string> WearWatch::note(Time now, uint16_t index, uint32_t total, std::string_view name) {
  if (total == kEepromLife)
    return fmt::format("{} has been stored {} times: the non-volatile memory may be worn out", name, total);
  Recent& recent = recent_[index];
  if (recent.count == 0) recent.first = now;
  recent.times[recent.count % kCyclicWrites] = now;
  ++recent.count;
  const Time oldest = recent.times[recent.count % kCyclicWrites];  // of the last kCyclicWrites
  if (recent.told || recent.count < kCyclicWrites || now - oldest > kCyclicSpan) return std::nullopt;
  recent.told = true;
  const int64_t ms = std::max<int64_t>(1, (now - oldest) / kMillisecond);
  return fmt::format(
      "{} was stored {} times within {}.{:03} s: the memory lasts about {} writes, at this rate {}; cyclic "
      "values "
      "belong into service 3, write volatile",
      name, kCyclicWrites, ms / 1000, ms % 1000, kEepromLife,
      memory_life(ms * kMillisecond / static_cast<int64_t>(kCyclicWrites - 1)));
}

std::vector<WearWatch::Use> WearWatch::uses() const {
  std::vector<Use> uses;
  for (const auto& [index, recent] : recent_) {
    if (recent.count < 2) continue;
    const Time last = recent.times[(recent.count - 1) % kCyclicWrites];
    uses.push_back({index, recent.count, (last - recent.first) / static_cast<Time>(recent.count - 1)});
  }
  return uses;
}

}  // namespace ipos::runtime
