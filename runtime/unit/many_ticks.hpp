// Many milliseconds of a unit at once: finds out how many of the next ticks decide nothing, and does them in
// one step. What it does is compared with the plain ticks of Unit on every kind of command and part
// (tests/runtime/plant: late, sleep, every row).
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/pace/backoff.hpp"
#include "runtime/unit/moving_ticks.hpp"
#include "runtime/unit/noted_variables.hpp"
#include "runtime/unit/program_reach.hpp"
#include "runtime/unit/unit.hpp"

namespace ipos::runtime {

class ManyTicks final {
 public:
  // How the next ticks are done.
  enum class Mode : uint8_t {
    InFull,  // each of them in full
    Moving,  // the axis moves, and that is all: the tasks run for many ticks, and what is shown is that of the last one
    Steady,  // drive and positioning decide nothing; timers and tasks tick by tick
    Ahead,   // the tasks, too, run for many ticks, and drive and positioning follow when they are asked for
    Idle,    // and the tasks wait, have ended, or go round in a loop that leads nowhere
  };

  // How late ticks may be, so that who watches the run sees it move on.
  static constexpr Ticks kLatest = 31;

  explicit ManyTicks(Unit& unit) : unit_(unit), length_(unit.milliseconds().length()) {}

  // As Timed (runtime/pace/timed.hpp) has them.
  bool tick(Time now);
  Ticks horizon(Time first) {
    if (left_ != 0) return left_;
    return mode_ == Mode::InFull ? 0 : find_horizon(first);
  }
  Ticks advance(Time first, Ticks most);
  void settle() {
    if (pending_ != 0) settle_pending();
  }
  bool settled() const { return pending_ == 0; }
  void touched();
  // `waits`: frames of the unit that a fault of its program would take back. Not asked for where it is known.
  Ticks silence(Time first, bool waits);
  Ticks known_silence() const {
    if (left_ == 0) return 0;
    return mode_ == Mode::Idle ? left_ : lets_wait() ? kLatest : 0;
  }
  // The next ticks in which the unit decides nothing, whatever its program does.
  Ticks undecided() const { return mode_ == Mode::Idle || lets_wait() ? left_ : 0; }
  // The drive counts or moves on, positioning follows no master, and the tasks have nothing to do with it: found so, and nobody has
  // touched the unit since.
  bool goes_on() const { return left_ != 0 && (mode_ == Mode::Ahead || mode_ == Mode::Moving); }
  bool lets_wait() const { return mode_ == Mode::Ahead && left_ != 0 && !reach_.may_fault; }

  Mode mode() const { return mode_; }

  // --- what others may do while it is not settled ---
  // The variables are those of the present.
  bool shows_variables() const { return mode_ != Mode::Idle || idle_.steady; }
  // They stay as they are until somebody writes.
  bool variables_rest() const { return mode_ == Mode::Idle && left_ != 0 && idle_.steady; }
  // Writing this variable and the next one changes what the next ticks do beyond what the tasks read.
  bool minds(uint32_t first) const;
  // Telegrams have variables that are not there before settle().
  bool sends_pending() const { return pending_ != 0 && (reach_.sends_position || !shows_variables()); }
  // The tasks go round for ever, whatever comes.
  bool is_endless() const { return mode_ == Mode::Ahead && left_ != 0 && !reach_.may_stop; }

 private:
  // What is compared with what a tick leaves.
  struct Before {
    explicit Before(const Unit& unit);
    Drive::Moment drive;
    std::optional<PositioningService::Left> positioning;
    uint32_t commands = 0;  // to positioning, so far
  };

  void tick_in_full(Time now);
  void compare_tick(Time now);
  Ticks begin_moving(Time first);
  Ticks move(Time first, Ticks most);
  void know_program();
  bool is_steady(const Before& before);
  bool is_still_steady();
  bool must_look();
  Ticks find_horizon(Time first);
  void choose(Time first, bool touched);
  bool try_idle(Time first, Ticks steady);
  bool can_run_ahead();
  // Between two ticks only others write system variables.
  bool is_quiet() const { return unit_.machine() == nullptr || reach_.quiet; }
  Ticks steady_tick(Time now);
  void settle_pending();
  void find_reach(Time first);
  bool can_be_late(bool waits) const;
  uint32_t positioning_commands() const {
    return unit_.positioning() == nullptr ? 0 : unit_.positioning()->changes();
  }

  Unit& unit_;
  Time length_;  // of a millisecond of the unit
  MovingTicks moving_{unit_};
  Mode mode_ = Mode::InFull;
  Ticks left_ = 0;         // ticks that are done in this way
  Ticks pending_ = 0;      // ticks that drive and positioning, and idle tasks, are behind
  Time last_ = 0;          // the last one of them
  bool touched_ = false;   // somebody has written since the last tick
  bool may_order_ = true;  // the program can write the control word of the drive
  uint32_t commands_ = 0;  // to positioning, when the ticks became steady
  uint32_t program_ = 0;   // that all this is known of
  vm::Rates rates_;        // of Ahead and Idle
  vm::Idle idle_;          // of Idle
  ProgramReach reach_;
  Backoff steady_backoff_, idle_backoff_, ahead_backoff_, reach_backoff_, moving_backoff_;
  NotedVariables noted_;
};

}  // namespace ipos::runtime
