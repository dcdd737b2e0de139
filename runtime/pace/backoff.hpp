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
  // From the next tick on; the pauses go on from where they are.
  void try_now() { at_ = 0; }

 private:
  Time at_ = 0;
  uint32_t pause_ = 1;
};

}  // namespace ipos::runtime
