// Counting down, once a millisecond.
#include "runtime/services/timers.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

void advance_timer(int32_t& timer, Ticks ticks) {
  if (timer > 0) timer = static_cast<int32_t>(std::max<int64_t>(int64_t{timer} - ticks, 0));
}

// Up to the millisecond before the one in which it reaches 0.
Ticks before_end(int32_t timer) { return static_cast<Ticks>(std::max(timer, 1) - 1); }

}  // namespace

void Timers::Counts::advance(Ticks ticks) {
  for (int32_t* timer : {&timer_0, &timer_1, &timer_2}) advance_timer(*timer, ticks);
  if (watched) advance_timer(watchdog, ticks);
}

Ticks Timers::Counts::bound() const {
  const bool stands = timer_0 < 0 || (timer_0 == 0 && reload <= 0);
  return std::min(stands ? kNoBound : before_end(timer_0), watched ? before_end(watchdog) : kNoBound);
}

}  // namespace ipos::runtime
