// Timer_0 to Timer_2 and the watchdog of a program: H variables that count milliseconds down. Only WdogTimer
// is on a page read (IPOSplus p. 34); p. 45 says that timer 0 can interrupt. The rest is common knowledge,
// and where that is silent ours.
#pragma once

#include <cstdint>
#include <span>

namespace ipos::runtime {

class Timers {
 public:
  struct Expired {
    bool timer_0 = false;
    bool watchdog = false;
  };

  // One millisecond. A timer goes down to 0 and stays there; a negative one stands still. Timer_0 reports its
  // way to 0 and takes T0_Reload if that is above 0, so it reports every T0_Reload ms; standing at 0 it takes
  // it without a report.
  Expired tick(std::span<int32_t> h);
  // It would change nothing and report nothing.
  bool rest(std::span<const int32_t> h) const;

  // WDON: from now on WdogTimer counts, and its end is fault F41. The program writes it again before that.
  void start_watchdog(std::span<int32_t> h, int32_t ms);
  bool watchdog_runs() const { return watchdog_; }
  void stop_watchdog() { watchdog_ = false; }  // WDOFF, end of the program by a fault

 private:
  bool watchdog_ = false;
};

}  // namespace ipos::runtime
