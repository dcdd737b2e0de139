// A connection of a station to a line, as its station knows it: what the buses make of it is behind.
#pragma once

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

class StationPort {
 public:
  // After the tick at `now`: sends what is due, with the variables as they are now. Returns the next tick that
  // sends something; kNever for none.
  virtual Time tick(Time now) = 0;
  // The same when the variables stay as they are until then, or the rest ends before: the line may send for the port.
  virtual Time tick_at_rest(Time now, Time /*until*/) { return tick(now); }
  virtual void rest_ends() {}
  // The unit has no power: nothing is heard or sent any more. The line is told first, as frames that were waiting
  // come back.
  virtual void power_off() = 0;
  // Frames that a fault of the program would take back.
  virtual bool has_waiting_frames() const { return false; }
  // The variables may change from now on: the line tells of repeated frames again.
  virtual void want_again() {}

 protected:
  ~StationPort() = default;
};

}  // namespace ipos::runtime
