// Counting down, once a millisecond.
#include "runtime/services/timers.hpp"

#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

using stdlib::system_variable;

// True when it reaches 0.
bool count(int32_t& timer) { return timer > 0 && --timer == 0; }

}  // namespace

Timers::Expired Timers::tick(std::span<int32_t> h) {
  count(h[system_variable("Timer_1")]);
  count(h[system_variable("Timer_2")]);
  Expired expired;
  int32_t& timer_0 = h[system_variable("Timer_0")];
  expired.timer_0 = count(timer_0);
  const int32_t reload = h[system_variable("T0_Reload")];
  if (timer_0 == 0 && reload > 0) timer_0 = reload;
  int32_t& watchdog = h[system_variable("WdogTimer")];
  if (watchdog_) {
    count(watchdog);
    expired.watchdog = watchdog <= 0;
  }
  return expired;
}

bool Timers::rest(std::span<const int32_t> h) const {
  const int32_t timer_0 = h[system_variable("Timer_0")];
  return !watchdog_ && h[system_variable("Timer_1")] <= 0 && h[system_variable("Timer_2")] <= 0 &&
         (timer_0 < 0 || (timer_0 == 0 && h[system_variable("T0_Reload")] <= 0));
}

void Timers::start_watchdog(std::span<int32_t> h, int32_t ms) {
  h[system_variable("WdogTimer")] = ms;
  watchdog_ = true;
}

}  // namespace ipos::runtime
