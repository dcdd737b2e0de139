// Counts occupied units second by second.
#include "runtime/bus/line_load.hpp"

#include <algorithm>

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
    if (window != window_) {
      peak_window_busy_ = std::max(peak_window_busy_, window_busy_);
      previous_window_busy_ = window == window_ + 1 ? window_busy_ : 0;
      window_ = window;
      window_end_ = (window + 1) * rate_;
      window_busy_ = 0;
    }
    const uint64_t part = std::min(count, window_end_ - begin);
    window_busy_ += part;
    begin += part;
    count -= part;
  }
}

LineLoad LoadMeter::load(uint64_t elapsed) const {
  LineLoad load;
  load.busy_bits = busy_;
  load.elapsed_bits = elapsed;
  load.percent = percent_of(busy_, elapsed);
  const uint64_t current = elapsed / rate_;
  uint64_t last = 0;
  if (current == window_) last = previous_window_busy_;
  if (current == window_ + 1) last = window_busy_;
  load.window_percent = percent_of(last, rate_);
  load.peak_window_percent =
      percent_of(current > window_ ? std::max(peak_window_busy_, window_busy_) : peak_window_busy_, rate_);
  return load;
}

}  // namespace ipos::runtime
