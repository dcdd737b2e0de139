// What has failed is tried again after 2, 4, 8.. ticks, so that trying costs little where it does not help.
#pragma once

#include <algorithm>

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

class Backoff {
 public:
  bool due(Time tick) const { return tick >= at_; }
  // `next` is the tick after the one in which it failed.
  void fail(Time next, uint32_t longest) {
    pause_ = std::min(2 * pause_, longest);
    at_ = next + pause_ * kMillisecond;
  }
  void succeed() { pause_ = 1; }
  // Ticks from `first` on in which it is not due.
  uint32_t pause_from(Time first) const {
    return at_ <= first ? 0 : static_cast<uint32_t>((at_ - first + kMillisecond - 1) / kMillisecond);
  }
  // From the next tick on; the pauses go on from where they are.
  void try_now() { at_ = 0; }

 private:
  Time at_ = 0;
  uint32_t pause_ = 1;
};

}  // namespace ipos::runtime
