// Timer_0 to Timer_2 and the watchdog of a program: H variables that count milliseconds down. Only WdogTimer
// is on a page read (IPOSplus p. 34); p. 45 says that timer 0 can interrupt. The rest is common knowledge,
// and where that is silent ours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/part/part.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::runtime {

class Timers {
 public:
  struct Expired {
    bool timer_0 = false;
    bool watchdog = false;
  };

  // What a program's timers are at one moment.
  struct Counts {
    int32_t timer_0 = 0;
    int32_t timer_1 = 0;
    int32_t timer_2 = 0;
    int32_t reload = 0;  // of timer 0
    int32_t watchdog = 0;
    bool watched = false;  // the watchdog counts

    // One millisecond. A timer goes down to 0 and stays there; a negative one stands still. Timer_0 reports
    // its way to 0 and takes T0_Reload if that is above 0, so it reports every T0_Reload ms; standing at 0 it
    // takes it without a report.
    Expired tick() {
      count(timer_1);
      count(timer_2);
      Expired expired;
      expired.timer_0 = count(timer_0);
      if (timer_0 == 0 && reload > 0) timer_0 = reload;
      if (watched) {
        count(watchdog);
        expired.watchdog = watchdog <= 0;
      }
      return expired;
    }
    // Milliseconds in which nothing is reported or loaded (pace/part.hpp).
    void advance(Ticks ticks);
    Ticks bound() const;
    bool operator==(const Counts&) const = default;
  };
  Counts counts(std::span<const int32_t> h) const {
    return {h[kTimer0], h[kTimer1], h[kTimer2], h[kReload], h[kWatchdog], watchdog_};
  }

  // One millisecond of the variables.
  Expired tick(std::span<int32_t> h) {
    Counts now = counts(h);
    const Expired expired = now.tick();
    h[kTimer0] = now.timer_0;
    h[kTimer1] = now.timer_1;
    h[kTimer2] = now.timer_2;
    h[kWatchdog] = now.watchdog;
    return expired;
  }
  // It would change nothing and report nothing.
  bool rest(std::span<const int32_t> h) const {
    const bool counts = h[kTimer0] > 0 || h[kTimer1] > 0 || h[kTimer2] > 0 || watchdog_;
    return !counts && (h[kTimer0] < 0 || h[kReload] <= 0);
  }

  // WDON: from now on WdogTimer counts, and its end is fault F41. The program writes it again before that.
  void start_watchdog(std::span<int32_t> h, int32_t ms) {
    h[kWatchdog] = ms;
    watchdog_ = true;
  }
  bool watchdog_runs() const { return watchdog_; }
  void stop_watchdog() { watchdog_ = false; }  // WDOFF, end of the program by a fault

 private:
  static constexpr size_t kTimer0 = stdlib::system_variable("Timer_0");
  static constexpr size_t kTimer1 = stdlib::system_variable("Timer_1");
  static constexpr size_t kTimer2 = stdlib::system_variable("Timer_2");
  static constexpr size_t kReload = stdlib::system_variable("T0_Reload");
  static constexpr size_t kWatchdog = stdlib::system_variable("WdogTimer");

  // True when it reaches 0.
  static bool count(int32_t& timer) { return timer > 0 && --timer == 0; }

  bool watchdog_ = false;
};

}  // namespace ipos::runtime
