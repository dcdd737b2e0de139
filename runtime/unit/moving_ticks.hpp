// Many ticks in which a unit does nothing but move: a ramp, a travel, a load that swings. Inputs, positioning and drive
// of each are executed as Unit does it in every tick (Unit::move); left out is what stands still meanwhile. The tasks
// have run before, all their ticks at once, and the variables are shown after the last one. A tick in which more
// happens is noticed when it has moved the axis; then the tasks go back to it, and the rest of it is done in full.
#pragma once

#include <cstdint>

#include "runtime/unit/program_reach.hpp"
#include "runtime/unit/unit.hpp"

namespace ipos::runtime {

class MovingTicks final {
 public:
  explicit MovingTicks(Unit& unit) : unit_(unit), length_(unit.milliseconds().length()) {}

  // After a tick, of an axis that moves: the next ones may be such ticks, as far as that can be said before. What is asked here stays so until
  // somebody touches the unit.
  bool possible(const ProgramReach& reach) const;

  // So many from `first` on, or as many as are such; returns how many.
  Ticks advance(Time first, Ticks most, const ProgramReach& reach);
  // There was none, and the next one was tried for nothing.
  bool in_vain() const { return in_vain_; }

  // The next tick has begun: it is finish() instead of Unit::tick().
  bool has_begun() const { return begun_; }
  void finish(Time now);

 private:
  Ticks move(Time first, Ticks most);
  void take_back(Ticks done, const vm::Machine::BeforeAhead& before, const ProgramReach& reach);

  Unit& unit_;
  Time length_;  // of a millisecond of the unit
  bool begun_ = false;
  bool in_vain_ = false;
};

}  // namespace ipos::runtime
