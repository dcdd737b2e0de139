// How busy a line is: the occupied time units (bits, ticks) of the whole run and of every second of virtual
// time.
#pragma once

#include <cstdint>

namespace ipos::runtime {

struct LineLoad {
  uint64_t frames = 0;               // delivered
  uint64_t busy_bits = 0;            // on CAN with intermission and error frames
  uint64_t elapsed_bits = 0;         // since time 0
  uint32_t percent = 0;              // whole run; all percentages are rounded down
  uint32_t window_percent = 0;       // the last complete second
  uint32_t peak_window_percent = 0;  // the busiest complete second
};

class LoadMeter {
 public:
  explicit LoadMeter(uint32_t units_per_second) : rate_(units_per_second), window_end_(units_per_second) {}

  // Units `begin` to `begin` + `count` were occupied. Calls come in rising order and do not overlap.
  void add(uint64_t begin, uint64_t count) {
    if (begin + count > window_end_) return add_beyond(begin, count);
    busy_ += count;
    window_busy_ += count;
  }

  // As add() `times` times, each `period` units after the one before.
  void add_repeated(uint64_t begin, uint64_t count, uint64_t period, uint64_t times);

  // With `elapsed` units since time 0, at most a second before what was added last; `frames` is left to the caller.
  LineLoad load(uint64_t elapsed) const;

 private:
  void add_beyond(uint64_t begin, uint64_t count);
  void begin_window(uint64_t window);

  uint32_t rate_;
  uint64_t busy_ = 0;
  uint64_t window_ = 0;  // number of the second being counted
  uint64_t window_end_;  // its end
  uint64_t window_busy_ = 0;
  uint64_t previous_busy_ = 0;         // of second window_ - 1
  uint64_t before_previous_busy_ = 0;  // of second window_ - 2
  uint64_t peak_busy_ = 0;             // of the seconds before window_ - 1
};

}  // namespace ipos::runtime
