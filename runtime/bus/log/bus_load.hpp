// Bus load of a log, in windows of one second and by identifier, as canbusload shows it: exact with the stuff
// bits that are really there, and at worst. Both count the 3 bits of intermission; error frames and
// repetitions leave no trace in a log and are not in it.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

struct LoadCount {
  uint64_t frames = 0;
  uint64_t data_bits = 0;
  uint64_t exact_bits = 0;
  uint64_t worst_bits = 0;

  void add(const Frame& frame);
  // In hundredths of a percent of what `baud` carries in `span`.
  static uint64_t percent_hundredths(uint64_t bits, uint32_t baud, Time span);
};

struct LoadWindow {
  Time start;
  LoadCount count;
};

struct LoggedIdentifier {
  uint32_t id;
  bool extended;
};
constexpr bool operator<(const LoggedIdentifier& a, const LoggedIdentifier& b) {
  return a.extended != b.extended ? b.extended : a.id < b.id;
}

// Frames in rising order of time; one that is earlier than the last counts in the last window.
class BusLoad {
 public:
  void add(Time time, const Frame& frame);

  const std::vector<LoadWindow>& windows() const {
    return windows_;
  }  // without gaps; the last one may be cut short
  const std::map<LoggedIdentifier, LoadCount>& identifiers() const { return identifiers_; }
  const LoadCount& total() const { return total_; }
  Time span() const { return windows_.empty() ? 0 : last_ - windows_.front().start; }  // first to last frame

 private:
  std::vector<LoadWindow> windows_;
  std::map<LoggedIdentifier, LoadCount> identifiers_;
  LoadCount total_;
  Time last_ = 0;
};

}  // namespace ipos::runtime
