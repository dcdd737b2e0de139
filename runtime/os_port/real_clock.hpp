// The real time as ports and the real-time loop see it: a clock and a way to wait. Tests drive both by hand;
// SystemClock is the real one.
#pragma once

#include <span>

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

// What a port waits for.
struct PortNeeds {
  int descriptor = -1;  // to be polled for input, on Windows the handle of an event; -1: none
  bool output = false;  // also wait until it takes output
  Time wake = kNever;   // flush the port at this time at the latest
};

class RealClock {
 public:
  virtual ~RealClock() = default;

  // Monotonic, in nanoseconds from any start; "host time" in this layer.
  virtual Time now() = 0;

  // Nanoseconds since 1970, the clock of the kernel's time stamps. It may be set; use it for differences
  // only.
  virtual Time wall() = 0;

  // Returns at host time `until`, or when a port needs service, or on a signal.
  virtual void wait(Time until, std::span<const PortNeeds> ports) = 0;
};

}  // namespace ipos::runtime
