// The millisecond of a unit, step by step.
#include "runtime/unit/unit.hpp"

#include "runtime/unit/drive_variables.hpp"
#include "runtime/commands/source_places.hpp"

namespace ipos::runtime {
namespace {

constexpr uint8_t kFaultWatchdog = 41;

}  // namespace

vm::Limits limits_of(const stdlib::UnitType& unit) {
  return {unit.variables, unit.program_words, unit.tasks, unit.call_depth};
}

Unit::Unit(const EventQueue& clock, UnitConfig config, std::optional<vm::Image> program, Journal& journal,
           std::optional<vm::Rates> rates, const Execution& execution)
    : rates_(rates),
      drive_(config.type, config.machine, config.options),
      clock_(clock),
      milliseconds_(config.options.clock_ppm),
      config_(std::move(config)),
      journal_(journal),
      execution_(execution),
      movilink_(config_.type, drive_, drive_, journal, config_.name),
      image_(std::move(program)) {}

inline void Unit::show_positioning(Time now) {
  positioning_->show(now, variables());
  if (!machine_) return;
  if (positioning_->positioner().touch_probes().probe(0).fresh) machine_->raise_event(vm::Event::TouchProbe);
  positioning_commands_->tick(*machine_);
}

inline void Unit::show_variables(Time now) {
  const std::span<int32_t> h = variables();
  mirrored_->show(h);
  show_drive(drive(), drive_bits_, h);
  if (positioning_) show_positioning(now);
}

void Unit::begin(Time now) {
  move(now);
  begin_moved(now);
}

void Unit::move(Time now) {
  take_inputs();
  drive().tick(order_position(now));
  if (positioning_) positioning_->observe();
}

void Unit::begin_moved(Time now) {
  const uint32_t changes = drive().changes();
  const bool drive_changed = changes != drive_changes_;
  drive_changes_ = changes;
  if (drive_changed) {
    report_drive(now);
    drive_bits_ = drive_bits(drive());
  }
  if (!has_variables()) return;
  if (machine_ && drive_changed) {
    raise_events();
    restart_after_reset(now);
  }
  show_variables(now);
  count_timers();
  if (pid_) pid_->tick(variables());
}

bool Unit::can_only_move() const {
  if (!inputs_.known() || synchronizes() || has_fresh_fault() || drive_.has_reasons()) return false;
  if (!has_variables()) return !positioning_;
  const std::span<const int32_t> h = variables();
  if (!timers_.rest(h) || controls()) return false;
  if (!positioning_) return true;
  return positioning_->reads_system_variables_only() && positioning_->goes_on(h);
}

inline void Unit::move_on() {
  static constexpr PositionControl kNone;
  if (!positioning_) return drive().tick(kNone);
  drive().tick(positioning_->go_on(drive_.syncs()));
  positioning_->observe();
}

inline bool Unit::had_only_moved() const {
  constexpr size_t kOutputLevel = stdlib::system_variable("OutputLevel");
  if (drive().changes() != drive_changes_ || drive_.memory().has_changed()) return false;
  if (has_variables() && variables()[kOutputLevel] != drive().outputs()) return false;
  return !positioning_ || positioning_->had_only_moved();
}

Ticks Unit::move_on(Ticks most) {
  for (Ticks done = 0; done != most;) {
    Ticks moved = positioning_ ? positioning_->lead_on(drive_.syncs(), most - done) : 0;
    if (moved == 0) {
      move_on();
      moved = 1;
    }
    done += moved;
    if (!had_only_moved()) return done - 1;
  }
  return most;
}

void Unit::count_moved(Time now, Ticks ticks) {
  executed_ += ticks;
  drive_.memory().set_time(now);
}

void Unit::show_moved(Time now) {
  if (!has_variables()) return;
  const std::span<int32_t> h = variables();
  show_drive(drive(), drive_bits_, h);
  if (positioning_) positioning_->show(now, h);
}

bool Unit::run_tasks() {
  if (!machine_) return true;
  if (runner_ == nullptr) {
    vm::run_tick(*machine_, rates());
    return true;
  }
  if (!in_tasks_) steps_.begin(*machine_, rates());
  in_tasks_ = !runner_->run(*machine_, steps_);
  return !in_tasks_;
}

void Unit::finish(Time now) {
  if (has_variables()) take_variables(now);
  store(now);
}

void Unit::take_inputs() {
  if (inputs_.known()) return;
  drive().set_inputs(inputs_.levels());
  drive().set_analog(inputs_.analog());
}

const PositionControl& Unit::order_position(Time now) {
  static constexpr PositionControl kNone;
  if (!positioning_) return kNone;
  const PositionControl& order = positioning_->order(now, variables(), drive_.syncs());
  return synchronous_ ? synchronous_->order(now, order) : order;
}

// An error that is new, or back after a reset, is the event of the ERROR interrupt; warnings are not (ours).
void Unit::raise_events() {
  const uint8_t error = drive().error() ? drive().fault() : 0;
  if (error != 0 && (error != error_seen_ || drive().resets() != resets_seen_))
    machine_->raise_event(vm::Event::Error);
  error_seen_ = error;
}

// A program that a fault has stopped starts again when the fault is reset by any means (ours); its variables
// keep their values. Where the program memory has been changed meanwhile, what it holds now begins.
void Unit::restart_after_reset(Time now) {
  const uint32_t resets = drive().resets();
  if (resets != resets_seen_ && machine_->fault().number != 0) {
    std::optional<std::string> refused;
    if (std::ranges::equal(drive_.memory().program().code(), program_->code()))
      start_machine();
    else
      refused = load_program();
    if (refused)
      note(now, Weight::Warning, "program not started: " + *refused);
    else
      note(now, Weight::Why, "the program starts anew after the reset of its fault");
  }
  resets_seen_ = resets;
}

void Unit::count_timers() {
  const std::span<int32_t> h = variables();
  if (timers_.rest(h) || (machine_ && machine_->fault().number != 0)) return;
  const Timers::Expired expired = timers_.tick(h);
  if (!machine_) return;
  if (expired.timer_0) machine_->raise_event(vm::Event::Timer0);
  if (expired.watchdog) machine_->raise_fault(kFaultWatchdog, "the watchdog has run out, H490 is 0");
}

void Unit::take_variables(Time now) {
  const std::span<int32_t> h = variables();
  mirrored_->take(h);
  take_program_orders(h, drive());
  if (drive_.has_reasons()) report_reasons(now);
  if (has_fresh_fault()) report_fault(now);
}

void Unit::store(Time now) {
  ++executed_;
  drive_.memory().tick(now);
  if (drive_.memory().has_messages()) report_memory(now);
}

// The last one by itself: what is shown of a motion belongs to the tick before it, too.
void Unit::advance(Ticks ticks) {
  if (ticks > 1) drive().advance(ticks - 1);
  const int32_t before = drive().position();
  drive().advance(1);
  if (!has_variables()) return;
  const std::span<int32_t> h = variables();
  if (positioning_)
    positioning_->advance(h, drive_.syncs(), before);
  else
    show_drive(drive(), drive_bits_, h);
}

std::string Unit::source_place(uint32_t address) const {
  return runs_image() ? runtime::source_place(*image_, address) : std::string();
}

uint32_t Unit::source_line(uint32_t address) const {
  return runs_image() ? runtime::source_line(*image_, address) : 0;
}

}  // namespace ipos::runtime
