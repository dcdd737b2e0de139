// The millisecond of positioning, and travels.
#include "runtime/positioning/positioner.hpp"

namespace ipos::runtime {
namespace {

struct EventRow {
  uint8_t fault;
  PositioningCause cause;
  std::string_view text;
};
constexpr EventRow kEvents[] = {
#define POSITIONING_EVENT(name, fault, cause, text) {fault, PositioningCause::cause, text},
#include "runtime/positioning/events.def"
};

constexpr int32_t kFullSpeed = 1000;       // permille
constexpr uint32_t kKeepModuloTarget = 1;  // H453 bit 0

}  // namespace

uint8_t fault_of(PositioningEvent event) { return kEvents[static_cast<size_t>(event)].fault; }
PositioningCause cause_of(PositioningEvent event) { return kEvents[static_cast<size_t>(event)].cause; }
std::string_view text_of(PositioningEvent event) { return kEvents[static_cast<size_t>(event)].text; }

// --- what the program orders ---

void Positioner::write_target(int32_t target) {
  if (reference_.active()) {
    pending_ = Pending::Absolute;
    pending_value_ = target;
    return;
  }
  ordered_target_ = target;
  if (!inputs_.possible) report(PositioningEvent::NoPositioning);
  target_ = target;
  target_follows_ = given_up_ = false;
}

void Positioner::move_target(int64_t way) {
  if (reference_.active()) {
    const bool added = pending_ == Pending::Absolute || pending_ == Pending::Relative;
    pending_value_ = added ? pending_value_ + way : way;
    if (!added) pending_ = Pending::Relative;
    return;
  }
  const int64_t target = target_ + way;
  if (target != wrapped(target) && !modulo_.on()) return report(PositioningEvent::TargetOutOfRange, target);
  write_target(wrapped(target));
}

void Positioner::write_modulo_target(int32_t target) {
  modulo_target_ = target;
  if (reference_.active()) {
    pending_ = Pending::Modulo;
    pending_value_ = target;
    return;
  }
  if (!modulo_.on()) return report(PositioningEvent::ModuloOff, target);
  // From where the axis can be stopped, so that a one-way axis never has to turn back.
  const int64_t base = following_ ? profile_.stop_position(rules_) : in_position() ? target_ : actual();
  write_target(wrapped(base + modulo_.way_to(target, high_resolution(), wrapped(base - actual()))));
  modulo_target_ = modulo_.within_turn(target, high_resolution());
}

void Positioner::stop_here() {
  reference_.end();
  pending_ = Pending::None;
  if (following_)
    brake_here();
  else
    drop_target();
}

// --- the millisecond ---

void Positioner::power_on(const PositioningSettings& settings, int32_t shaft) {
  encoders_.configure(settings);
  encoders_.power_on(shaft);
  take_over(settings);
  modulo_.set(actual());
}

void Positioner::idle() { drop_target(); }

void Positioner::advance(int32_t before, int32_t motor_counter) {
  if (encoders_.counter() != before) move(before);
  idle();
  move(motor_counter);
}

// A position that counts otherwise from now on ends every travel.
void Positioner::take_over(const PositioningSettings& settings) {
  const bool other =
      settings.source != settings_.source || !(settings.source_factor() == settings_.source_factor());
  settings_ = settings;
  factor_ = settings_.source_factor();
  full_rules_ = rules_ = settings_.travel_rules(kFullSpeed);
  rules_override_ = kFullSpeed;
  plan_follows_ = false;
  encoders_.configure(settings_);
  if (other) {
    following_ = false;
    target_follows_ = true;
    modulo_.set(actual());
  }
  configure_modulo();
}

void Positioner::configure_modulo() {
  if (!modulo_.configure(settings_, actual())) report(PositioningEvent::ModuloTooFine);
}

void Positioner::find_rules() {
  if (rules_override_ == inputs_.override_permille) return;
  rules_override_ = inputs_.override_permille;
  rules_ = settings_.travel_rules(rules_override_);
  plan_follows_ = false;
}

// A turn of the output counts where P941 takes its position from X14.
inline void Positioner::count_external() {
  const int32_t before = actual();
  if (encoders_.count_external(inputs_.external)) modulo_.move(wrapped(int64_t{actual()} - before));
}

// Something else moves the axis, or nothing: position setpoint and actual position are one.
void Positioner::rest() {
  if (following_) {
    interrupted_ = !reference_.active() && follow_state_ == FollowState::Free && !profile_.at_rest();
    if (modulo_.on() && (inputs_.modulo_control & kKeepModuloTarget) == 0) target_follows_ = true;
  }
  if (given_up_ || !inputs_.possible) target_follows_ = true;
  following_ = false;
  follow_state_ = FollowState::Free;
  planned_target_.reset();
  refused_target_.reset();
  at_limit_ = false;
  lag_ = 0;
  if (target_follows_) drop_target();
  // Interrupted, it starts again.
  if (reference_.active()) reference_.start(settings_.reference_type, reference_.zero_pulse());
  reference_failed_ = false;
}

void Positioner::resume() {
  following_ = true;
  profile_.hold(fine(actual()), rate_of_speed(inputs_.speed, factor_));
  planned_target_.reset();
  reference_order_ = {};
  const bool goes_on = interrupted_ && !target_follows_ && target_allowed();
  if (goes_on && profile_.overruns(target_on_line(), rules_)) report(PositioningEvent::Overrun);
  if (target_follows_) brake_here();
  interrupted_ = given_up_ = false;
}

void Positioner::drop_target() {
  ordered_target_.reset();
  target_ = actual();
  target_follows_ = true;
  if (modulo_.on()) modulo_target_ = modulo_.position(high_resolution());
}

void Positioner::brake_here() {
  const int64_t end = profile_.stop_position(rules_);
  profile_.stop(rules_);
  ordered_target_.reset();
  target_ = wrapped(end);
  planned_target_ = end;
  planned_rules_ = rules_;
  planned_full_ = full_rules_;
}

bool Positioner::target_allowed() const {
  const bool limited = settings_.limit_cw != 0 || settings_.limit_ccw != 0;
  if (!limited || !referenced() || modulo_.on()) return true;
  return target_ <= settings_.limit_cw && target_ >= settings_.limit_ccw;
}

// In the profile's count, which does not wrap.
int64_t Positioner::target_on_line() const {
  if (!modulo_.on()) return target_;
  const int64_t base = whole(profile_.position());
  return base + distance(wrapped(base), target_);
}

inline void Positioner::run_travel() {
  watch_limit_switches();
  if (!target_allowed()) {
    if (refused_target_ == target_) return;
    refused_target_ = target_;
    report(PositioningEvent::TargetBeyondLimit);
    profile_.stop(rules_);
    planned_target_.reset();
    return;
  }
  refused_target_.reset();
  const int64_t goal = target_on_line();
  if (plan_holds(goal)) return;
  TravelRules now = rules_;
  if (planned_target_ && !profile_.at_rest()) {
    if (planned_rules_.shape == RampShape::Linear) {
      now.shape = RampShape::Linear;  // another type holds from the next travel on
    } else {
      if (!(full_rules_ == planned_full_)) report(PositioningEvent::RampChanged);
      planned_full_ = full_rules_;
      now = planned_rules_;
    }
  }
  plan(goal, now);
  plan_follows_ = planned_rules_ == rules_ && planned_full_ == full_rules_;
}

void Positioner::plan(int64_t goal, const TravelRules& now) {
  const bool kept = planned_target_ == goal;
  if (kept && planned_rules_ == now) return;
  profile_.travel(goal, now, kept ? Goal::Kept : Goal::New);
  planned_target_ = goal;
  planned_rules_ = now;
  planned_full_ = full_rules_;
}

void Positioner::watch_limit_switches() {
  const Rate speed = profile_.speed();
  const bool against = (speed > 0 && inputs_.limit_cw) || (speed < 0 && inputs_.limit_ccw);
  if (against && !at_limit_) {
    report(PositioningEvent::LimitReached);
    brake_here();
    given_up_ = true;
  }
  at_limit_ = against;
}

// The profile's count goes on for ever with the modulo function or behind a master; a circle of it is taken
// away in time.
inline void Positioner::keep_in_range() {
  if (!modulo_.on() && follow_state_ == FollowState::Free) return;
  const int64_t position = whole(profile_.position());
  if (magnitude(position) < (int64_t{1} << 33)) return;
  const int64_t change = wrapped(position) - position;
  profile_.shift(change);
  if (planned_target_) *planned_target_ += change;
}

// The millisecond of an axis that follows, and the speed for it.
[[gnu::always_inline]] inline int32_t Positioner::lead() {
  profile_.tick();
  keep_in_range();
  if (lags_too_far()) report(PositioningEvent::LagError);
  return speed_order(profile_.speed(), lag_, factor_, std::max(settings_.maximum_speed, 0));
}

int32_t Positioner::go_on() { return lead(); }

PositioningOrder Positioner::tick(const PositioningInputs& inputs) {
  if (!modulo_.possible()) configure_modulo();
  inputs_ = inputs;
  find_rules();
  count_external();
  touch_probes_.tick(inputs.levels, encoders_);
  if (inputs.reference_start && !reference_input_) start_reference(false, false);
  reference_input_ = inputs.reference_start;
  follower_.tick(inputs.master);
  if (!inputs.possible || !inputs.following) {
    rest();
    // Should the drive be enabled within this millisecond, it keeps the speed it has.
    return {inputs.possible, inputs.speed, halt_};
  }
  if (!following_) resume();
  if (reference_.active())
    run_reference();
  else if (!follow_master())
    run_travel();
  return {true, lead(), halt_};
}

// Nothing that tick() asks before it leads the axis has another answer.
bool Positioner::goes_on() const {
  const bool alone = !reference_.active() && !inputs_.master.follow && follower_.silent() &&
                     follow_state_ == FollowState::Free;
  const bool sensed =
      inputs_.limit_cw || inputs_.limit_ccw || touch_probes_.probe(0).fresh || touch_probes_.probe(1).fresh;
  return following_ && alone && !sensed && !modulo_.on() && modulo_.possible() && target_allowed() &&
         plan_holds(target_) && !has_events();
}

}  // namespace ipos::runtime
