// Decides which milliseconds of a Timed are executed in their turn, later, or many at once. Nobody else does.
//
// It is behind while ticks are still to be executed whose time has passed: nobody can notice anything of them
// before silent_to_ or the next telegram. Who reads catches up first, who writes touches: then the next tick
// comes in its turn again.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/clock/event_queue.hpp"
#include "runtime/clock/own_milliseconds.hpp"
#include "runtime/pace/inbox.hpp"
#include "runtime/pace/timed.hpp"

namespace ipos::runtime {

enum class Pace : uint8_t {
  InTurn,  // every tick at its time: the plain run
  Lazy,
};

class Pacer final : private EventTarget {
 public:
  // `source` orders its events among those of one time. Ticks come at the begin of each of `milliseconds`. All must outlive it.
  Pacer(EventQueue& queue, uint32_t source, Timed& timed, Pace pace, OwnMilliseconds& milliseconds)
      : queue_(queue), source_(source), timed_(timed), pace_(pace), milliseconds_(milliseconds) {}
  Pacer(const Pacer&) = delete;
  Pacer& operator=(const Pacer&) = delete;

  void start();  // the first tick is now
  void stop();   // no tick comes any more
  void use(Pace pace);
  Pace pace() const { return pace_; }

  bool behind() const { return behind_; }
  // Behind, and nothing that others can see changes before the end of the silence, unless somebody touches it.
  bool rests() const { return rests_; }

  // Before somebody reads: all ticks up to now are executed.
  void catch_up() {
    if (behind_) make_up();
  }
  // The same with the tick of this moment, if there is one: it was to come first.
  void catch_up_after_tick();
  // Before somebody writes: the same, and the next tick comes in its turn.
  void touch();
  // The ticks up to now are executed, but not settled.
  void execute_pending() {
    if (behind_) run_to(last_tick());
  }

  // A telegram waits for its reader. False: it must be read at once.
  bool post(TelegramReader& reader, size_t number, const TelegramData& data);

  // The tick that stopped in the middle has come to its end.
  void resume();

  // Somebody writes, and the ticks from the next one on move towards coming `behind` this moment and whole milliseconds after
  // that; by `most` at most.
  void align(Time behind, Time most);

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  bool run_to(Time last);
  void make_up();
  void plan(Time now);
  void end_rest() {
    if (!rests_) return;
    rests_ = false;
    timed_.rest_ends();
  }
  Time last_tick() const;
  Time begun_tick() const;

  EventQueue& queue_;
  uint32_t source_;
  Timed& timed_;
  Pace pace_;
  OwnMilliseconds& milliseconds_;
  bool behind_ = false;
  bool rests_ = false;
  bool runs_ = false;  // run_to() is under way
  EventId event_ = kNoEvent;
  Time done_to_ = 0;    // the first tick that was not executed
  Time silent_to_ = 0;  // the tick that comes in its turn again
  Inbox inbox_;
};

}  // namespace ipos::runtime
