// Monitoring of the process data of one bus: P812, P815, P819 (1053 1610 p. 27, 41, 64; MOVITRAC 07
// chapters 4.1 and 7.1). Until the first telegram after power-on or a reset the drive waits (display t).
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/part/part.hpp"

namespace ipos::runtime {

class LinkWatch {
 public:
  struct Rules {
    int32_t delay_ms = 0;        // 0: off
    bool supervised = false;     // silence is a fault; else it only brings back the waiting
    bool without_first = false;  // silence from the beginning is a fault, too (MOVITRAC 07)
    bool operator==(const Rules&) const = default;
  };

  // Process data for this unit have arrived; `restarts` is false for acyclic RS-485 requests, which are not
  // monitored (1053 1610 p. 23). True when the silence had been reported.
  bool on_process_data(bool restarts);

  // A cyclic request without process data: it restarts the monitoring, but does not end the waiting (ours).
  bool on_request();

  // The bus has found the silence by itself: it ends with the next process data.
  void report() { reported_ = true; }

  // One millisecond. True once when the time has run out.
  bool tick(const Rules& rules) {
    rules_ = rules;
    if (runs()) return run();
    if (rules.delay_ms == 0) silent_ms_ = 0;
    return false;
  }

  // With the rules of the last tick: a tick does something; else so it stays until telegrams come or the
  // rules change.
  bool runs() const {
    return rules_.delay_ms != 0 && !reported_ && (running_ || (rules_.without_first && rules_.supervised));
  }
  // Ticks that only count the silence (pace/part.hpp). Telegrams that come while it is alert only begin the
  // count from zero.
  void advance(Ticks ticks) {
    if (counts()) silent_ms_ += ticks;
  }
  Ticks bound() const {
    return counts() ? static_cast<Ticks>(std::max<int64_t>(rules_.delay_ms - silent_ms_, 0)) : kNoBound;
  }
  bool operator==(const LinkWatch&) const = default;
  bool alert() const { return seen_ && running_ && !reported_; }

  void forget() { *this = {}; }  // power-on, reset of a fault
  bool seen() const { return seen_; }
  bool silent() const { return reported_; }

 private:
  bool counts() const { return rules_.delay_ms != 0 && running_ && !reported_; }
  bool run();

  Rules rules_;
  bool seen_ = false;     // process data have arrived
  bool running_ = false;  // the time runs
  bool reported_ = false;
  int64_t silent_ms_ = 0;  // whole ticks since the last restart
};

}  // namespace ipos::runtime
