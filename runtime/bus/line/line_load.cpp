// Counts occupied units second by second.
#include "runtime/bus/line/line_load.hpp"

#include <algorithm>
#include <cassert>

namespace ipos::runtime {
namespace {

uint32_t percent_of(uint64_t part, uint64_t whole) {
  return whole == 0 ? 0 : static_cast<uint32_t>(part * 100 / whole);
}

}  // namespace

// Not all of it in the second being counted.
void LoadMeter::add_beyond(uint64_t begin, uint64_t count) {
  busy_ += count;
  while (count > 0) {
    const uint64_t window = begin / rate_;
    if (window != window_) begin_window(window);
    const uint64_t part = std::min(count, window_end_ - begin);
    window_busy_ += part;
    begin += part;
    count -= part;
  }
}

// One step for those that end within the second being counted, one for that which does not.
void LoadMeter::add_repeated(uint64_t begin, uint64_t count, uint64_t period, uint64_t times) {
  while (times > 0) {
    const bool fits = begin + count <= window_end_;
    const uint64_t within = fits ? std::min(times, (window_end_ - begin - count) / period + 1) : 1;
    if (fits) {
      busy_ += within * count;
      window_busy_ += within * count;
    } else {
      add_beyond(begin, count);
    }
    begin += within * period;
    times -= within;
  }
}

void LoadMeter::begin_window(uint64_t window) {
  assert(window > window_);
  const uint64_t gap = window - window_;
  peak_busy_ = std::max({peak_busy_, previous_busy_, gap == 1 ? 0 : window_busy_});
  before_previous_busy_ = gap == 1 ? previous_busy_ : gap == 2 ? window_busy_ : 0;
  previous_busy_ = gap == 1 ? window_busy_ : 0;
  window_ = window;
  window_end_ = (window + 1) * rate_;
  window_busy_ = 0;
}

LineLoad LoadMeter::load(uint64_t elapsed) const {
  LineLoad load;
  load.busy_bits = busy_;
  load.elapsed_bits = elapsed;
  load.percent = percent_of(busy_, elapsed);
  const uint64_t current = elapsed / rate_;
  assert(current + 1 >= window_);  // a second before window_ where the end of a frame lies ahead
  uint64_t last = 0;
  uint64_t peak = peak_busy_;
  if (current + 1 == window_) last = before_previous_busy_;
  if (current == window_) last = previous_busy_;
  if (current == window_ + 1) last = window_busy_;
  if (current >= window_) peak = std::max(peak, previous_busy_);
  if (current > window_) peak = std::max(peak, window_busy_);
  load.window_percent = percent_of(last, rate_);
  load.peak_window_percent = percent_of(peak, rate_);
  return load;
}

}  // namespace ipos::runtime
