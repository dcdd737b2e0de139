// A tick is a function of what the unit is. So when one has left a part as counting alone would have
// (runtime/part/part.hpp), and nobody has written what it follows since, the next ones do the same.
#include "runtime/unit/many_ticks.hpp"

#include <algorithm>
#include <cassert>


namespace ipos::runtime {
namespace {

// What did not help is tried again after 2, 4, 8.. ticks, at most these: to compare a tick; to run ahead of a
// command that stops; to look for an idle loop, where the unit moves and where its program works; to look
// what the program can still do.
constexpr uint32_t kSteadyPause = 32, kAheadPause = 64, kIdlePause = 32, kProgramPause = 1024,
                   kReachPause = 4096;
// And to move where that is not possible, or where the tasks or the drive have more to do in the first tick.
constexpr uint32_t kMovingPause = 64;

}  // namespace

// What was found out about another program is forgotten.
void ManyTicks::know_program() {
  if (program_ == unit_.programs()) return;
  program_ = unit_.programs();
  reach_ = {};
  reach_backoff_ = {};
  may_order_ = unit_.machine() != nullptr && unit_.program()->may_order();
}

bool ManyTicks::tick(Time now) {
  assert(pending_ == 0);
  mode_ = Mode::InFull;
  left_ = 0;
  touched_ = false;
  tick_in_full(now);
  if (mode_ == Mode::InFull) begin_moving(now + length_);
  return true;
}

// An axis on its way to a target is not steady.
void ManyTicks::tick_in_full(Time now) {
  if (moving_.has_begun())
    moving_.finish(now);
  else if (steady_backoff_.due(now) && (unit_.drive().standing() || !unit_.is_led()))
    compare_tick(now);
  else
    unit_.tick(now);
}

// Where nothing leads the axis it may come to turn evenly: that is looked at now and then.
Ticks ManyTicks::begin_moving(Time first) {
  know_program();
  mode_ = Mode::InFull;
  left_ = 0;
  if (unit_.drive().standing() || !moving_backoff_.due(first)) return 0;
  if (!moving_.possible(reach_)) {
    moving_backoff_.fail(first, kMovingPause);
    return 0;
  }
  left_ = unit_.is_led() ? kLatest : std::min(kLatest, steady_backoff_.pause_from(first));
  if (left_ != 0) mode_ = Mode::Moving;
  return left_;
}

Ticks ManyTicks::move(Time first, Ticks most) {
  const Ticks done = moving_.advance(first, most, reach_);
  left_ -= done;
  if (done == most) {
    moving_backoff_.succeed();
    return done;
  }
  mode_ = Mode::InFull;
  left_ = 0;
  if (moving_.in_vain()) moving_backoff_.fail(first + length_, kMovingPause);
  return done;
}

ManyTicks::Before::Before(const Unit& unit) : drive(unit.drive().moment()) {
  if (unit.positioning() == nullptr) return;
  positioning.emplace(*unit.positioning());
  commands = unit.positioning()->changes();
}

// Executes a tick and looks what it has changed.
void ManyTicks::compare_tick(Time now) {
  const Before before(unit_);
  unit_.begin(now);
  if (unit_.has_variables()) noted_.note(unit_.variables());
  unit_.run_tasks();
  unit_.finish(now);
  know_program();
  if (is_steady(before)) {
    mode_ = Mode::Steady;
    commands_ = positioning_commands();
    steady_backoff_.succeed();
  } else {
    steady_backoff_.fail(now + length_, kSteadyPause);
  }
}

// The tick has changed nothing but what advance() changes.
bool ManyTicks::is_steady(const Before& before) {
  Drive& drive = unit_.drive();
  const Ticks ticks = drive.steady_since(before.drive);
  if (ticks == 0 || before.commands != positioning_commands() || unit_.synchronizes()) return false;
  if (const PositioningService* positioning = unit_.positioning(); positioning != nullptr) {
    if (!positioning->reads_system_variables_only()) return false;
    // In motion only what positioning cannot act on goes on by itself.
    const bool rests = drive.standing() ? before.positioning && positioning->has_left(*before.positioning)
                                        : positioning->idles();
    if (!rests) return false;
  }
  if (unit_.has_variables() && (!noted_.same(unit_.variables()) || unit_.controls())) return false;
  drive.hold_steady(ticks);
  return true;
}

// Nobody has written anything since that a part of the unit follows.
bool ManyTicks::is_still_steady() {
  if (program_ != unit_.programs() || unit_.drive().steady_left() == 0 || !unit_.inputs().known())
    return false;
  if (!touched_) return true;
  touched_ = false;
  return commands_ == positioning_commands() &&
         (!unit_.has_variables() || noted_.same(unit_.variables()));
}

// After the tasks of a steady tick: something has happened that a part of the unit must see.
bool ManyTicks::must_look() {
  return unit_.server().has_reasons() || unit_.has_fresh_fault() ||
         (!is_quiet() && (commands_ != positioning_commands() || !noted_.same(unit_.variables())));
}

Ticks ManyTicks::find_horizon(Time first) {
  if (mode_ == Mode::Moving) return begin_moving(first);
  settle();
  const bool touched = touched_;
  if (!is_still_steady())
    mode_ = Mode::InFull;
  else
    choose(first, touched);
  return left_;
}

// What was written just now the machine sees in a tick of its own: a request of an interrupt (H530).
void ManyTicks::choose(Time first, bool touched) {
  const Ticks steady = unit_.drive().steady_left();
  if (unit_.drive().standing() && idle_backoff_.due(first) && try_idle(first, steady)) return;
  if (!touched && ahead_backoff_.due(first) && can_run_ahead()) {
    mode_ = Mode::Ahead;
    rates_ = unit_.rates();
    left_ = steady;
    return;
  }
  mode_ = Mode::Steady;
  left_ = 1;
}

bool ManyTicks::try_idle(Time first, Ticks steady) {
  uint64_t ticks = steady;
  if (unit_.has_variables() && !unit_.timers().rest(unit_.variables())) {
    idle_backoff_.fail(first, kIdlePause);
    return false;
  }
  idle_.steady = true;
  if (vm::Machine* machine = unit_.machine(); machine != nullptr) {
    rates_ = unit_.rates();
    ticks = std::min(ticks, machine->idle_ticks(rates_.commands, idle_));
  }
  if (ticks == 0) {
    idle_backoff_.fail(first, kProgramPause);
    return false;
  }
  idle_backoff_.succeed();
  mode_ = Mode::Idle;
  left_ = static_cast<Ticks>(ticks);
  return true;
}

// Nothing that is asked here changes before somebody touches the unit.
bool ManyTicks::can_run_ahead() {
  if (unit_.machine() != nullptr) {
    if (!reach_.apart || !reach_.quiet) return false;
    if (reach_.reads_position && !unit_.drive().standing()) return false;
  }
  return !unit_.has_variables() || unit_.timers().rest(unit_.variables());
}

Ticks ManyTicks::advance(Time first, Ticks most) {
  assert(most <= left_);
  if (mode_ == Mode::Moving) return move(first, most);
  if (mode_ == Mode::Steady) return steady_tick(first);
  if (mode_ == Mode::Ahead && unit_.machine() != nullptr) {
    vm::Machine::BeforeAhead before;
    if (!unit_.machine()->run_ahead(rates_.commands, most, reach_.rollback, before)) {
      settle();
      ahead_backoff_.fail(first, kAheadPause);
      mode_ = Mode::Steady;
      return steady_tick(first);
    }
    ahead_backoff_.succeed();
  }
  left_ -= most;
  pending_ += most;
  last_ = first + static_cast<Time>(most - 1) * length_;
  return most;
}

// Drive and positioning go on, and the rest is as in every tick.
Ticks ManyTicks::steady_tick(Time now) {
  left_ = 0;
  unit_.advance(1);
  if (!unit_.has_variables()) {
    unit_.store(now);
    return 1;
  }
  unit_.count_timers();
  if (!is_quiet()) noted_.note(unit_.variables());
  unit_.run_tasks();
  if (must_look()) {
    unit_.take_variables(now);
    mode_ = Mode::InFull;
  }
  unit_.store(now);
  return 1;
}

void ManyTicks::settle_pending() {
  const Ticks ticks = std::exchange(pending_, 0);
  if (mode_ == Mode::Idle && unit_.machine() != nullptr)
    unit_.machine()->skip_ticks(rates_.commands, idle_, ticks);
  unit_.advance(ticks);
  unit_.server().memory().set_time(last_);
}

// What is written is compared with what was there before. A program that can write it with commands of its
// own is not asked: there the variables are noted each time before it runs.
void ManyTicks::touched() {
  assert(pending_ == 0);
  left_ = 0;
  idle_backoff_.try_now();
  if (std::exchange(touched_, true) || mode_ == Mode::InFull) return;
  if (mode_ == Mode::Moving) {
    mode_ = Mode::InFull;
    return;
  }
  if (is_quiet() && unit_.has_variables()) noted_.note(unit_.variables());
  mode_ = Mode::Steady;
}

bool ManyTicks::minds(uint32_t first) const {
  return mode_ == Mode::Idle || is_system_variable(first) || is_system_variable(first + 1);
}

void ManyTicks::find_reach(Time first) {
  std::array<const VariableObjects*, 2> objects{};
  size_t count = 0;
  for (const VariableObjects* of_bus : unit_.objects())
    if (of_bus != nullptr) objects[count++] = of_bus;
  reach_ = ProgramReach(*unit_.machine(), std::span(objects).first(count), unit_.positioning() != nullptr,
                        std::move(reach_.rollback));
  reach_backoff_.fail(first, kReachPause);
}

// Nothing the unit does reaches anybody before its next telegram. A fault of the program would: it takes back
// telegrams that wait, and when it is reset the restarted program calls the bus. It is not reset in time
// where the program does not order it.
bool ManyTicks::can_be_late(bool waits) const {
  const vm::Machine* machine = unit_.machine();
  if (machine == nullptr) return true;
  if (!reach_.mute || machine->fault().number != 0) return false;
  if (!reach_.may_fault && !unit_.timers().watchdog_runs()) return true;
  return !may_order_ && !waits;
}

Ticks ManyTicks::silence(Time first, bool waits) {
  know_program();
  const vm::Machine* machine = unit_.machine();
  const bool known = reach_.mute && reach_.apart && reach_.quiet;
  if (machine != nullptr && !known && reach_backoff_.due(first) && machine->fault().number == 0)
    find_reach(first);
  return can_be_late(waits) ? kLatest : 0;
}

}  // namespace ipos::runtime
