// A tick that is more than its motion is known by what it has changed, not foreseen: so nothing has to be concluded about drive,
// ramps and load.
#include "runtime/unit/moving_ticks.hpp"

#include <algorithm>
#include <cassert>

namespace ipos::runtime {

bool MovingTicks::possible(const ProgramReach& reach) const {
  if (unit_.machine() != nullptr) {
    if (!reach.mute || !reach.apart || !reach.modest) return false;
    if (unit_.is_led() ? reach.reads_travel : reach.reads_position) return false;
  }
  return unit_.can_only_move();
}

Ticks MovingTicks::advance(Time first, Ticks most, const ProgramReach& reach) {
  assert(!begun_);
  in_vain_ = false;
  vm::Machine* const machine = unit_.machine();
  if (machine == nullptr) return move(first, most);
  most = std::min(most, machine->waits_on());
  if (most == 0) return 0;
  vm::Machine::BeforeAhead before;
  if (!machine->run_ahead(unit_.rates().commands, most, reach.rollback, before)) {
    in_vain_ = true;
    return 0;
  }
  const Ticks done = move(first, most);
  if (done != most) take_back(done, before, reach);
  return done;
}

// The tasks to the tick that has begun. Their ticks before it are done as in every tick: there are few such moments.
void MovingTicks::take_back(Ticks done, const vm::Machine::BeforeAhead& before, const ProgramReach& reach) {
  vm::Machine& machine = *unit_.machine();
  machine.take_back(reach.rollback, before);
  for (; done != 0; --done) vm::run_tick(machine, unit_.rates());
}

Ticks MovingTicks::move(Time first, Ticks most) {
  const Ticks done = unit_.move_on(most);
  begun_ = done != most;
  in_vain_ = begun_ && done == 0;
  // The one that has begun shows itself, and the tasks go back to what was shown before.
  const Time last = first + (static_cast<Time>(done) - 1) * length_;
  if (done != 0) unit_.count_moved(last, done);
  if (!begun_) unit_.show_moved(last);
  return done;
}

void MovingTicks::finish(Time now) {
  begun_ = false;
  unit_.begin_moved(now);
  unit_.run_tasks();
  unit_.finish(now);
}

}  // namespace ipos::runtime
