// Runs a simulation in step with a real clock and with real ports: virtual time is the host's monotonic time
// since the start of the loop. What has arrived at the ports by a moment is on its way into the simulation
// before virtual time passes that moment.
#pragma once

#include <vector>

#include "runtime/clock/lateness.hpp"
#include "runtime/os_port/port.hpp"

namespace ipos::runtime {

// What runs in virtual time.
class Simulation {
 public:
  virtual Time now() const = 0;
  virtual Time next_time() const = 0;  // of the next event, kNever without one
  // Runs all events up to and including `end`; false: the run is over before.
  virtual bool run_until(Time end) = 0;

 protected:
  ~Simulation() = default;
};

// A bridge between the simulation and a port.
class RealTimeMember {
 public:
  virtual PortNeeds needs() const = 0;
  // Takes what has arrived; virtual time 0 was at host time `epoch`. False: the port has gone.
  virtual bool collect(Time epoch) = 0;
  virtual bool flush() = 0;

 protected:
  ~RealTimeMember() = default;
};

// A tick that comes later than this is counted: the next one is due by then (ours).
inline constexpr Time kLateTick = kMillisecond;

struct Punctuality {
  uint64_t late_ticks = 0;  // milliseconds of virtual time that ran more than kLateTick late
  Time worst = 0;           // the latest start of an event
  Time first_late = -1;     // virtual time of the first late tick, -1 without one
  Time lag = 0;             // host time minus virtual time when the loop ended, without what was left out
  Time left_out = 0;        // host time that was not made up for
};

class RealTimeLoop {
 public:
  RealTimeLoop(RealClock& clock, Simulation& simulation) : clock_(clock), simulation_(simulation) {}

  void add(RealTimeMember& member) { members_.push_back(&member); }

  enum class End : uint8_t { Reached, Stopped, PortGone };

  // Runs until virtual time `end`, until the simulation is over, or until a port has gone.
  End run(Time end);

  const Punctuality& punctuality() const { return punctuality_; }

 private:
  bool flush();
  void judge(Time target);
  // How much of the clock is left out, that virtual time begins its next event now; 0 when it is not later than is made up for.
  Time forgive(Time target);
  void note_late(Time late);

  RealClock& clock_;
  Simulation& simulation_;
  std::vector<RealTimeMember*> members_;
  std::vector<PortNeeds> needs_;
  Punctuality punctuality_;
};

}  // namespace ipos::runtime
