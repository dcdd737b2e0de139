// Reference travels of the positioner: from the search to the new count.
#include "runtime/positioning/positioner.hpp"

namespace ipos::runtime {

void Positioner::start_reference(bool conditional, bool zero_pulse) {
  if (conditional && referenced()) return;
  ordered_target_.reset();
  if (!inputs_.possible) report(PositioningEvent::NoReferencing);
  referenced_ = false;
  pending_ = Pending::None;
  reference_.start(settings_.reference_type, zero_pulse);
  reference_order_ = {};
  reference_failed_ = false;
  // Type 5 moves nothing and needs no enable.
  ReferenceInputs in;
  in.position = actual();
  if (!reference_.moves() && reference_.tick(in) == ReferenceTravel::Outcome::Found)
    finish_reference(reference_.found());
}

void Positioner::end_reference() {
  referenced_ = false;
  if (reference_.active()) stop_here();
}

void Positioner::run_reference() {
  const auto fail = [this](PositioningEvent why) {
    report(why);
    reference_failed_ = true;
    profile_.stop(rules_);
  };
  ReferenceInputs in;
  in.cam = inputs_.cam;
  in.limit_cw = inputs_.limit_cw;
  in.limit_ccw = inputs_.limit_ccw;
  in.has_cam = inputs_.has_cam;
  in.has_limits = inputs_.has_limits;
  in.position = actual();
  in.way = sign(profile_.speed());
  in.zero_pulse_cw = encoders_.zero_pulse(source(), 1);
  in.zero_pulse_ccw = encoders_.zero_pulse(source(), -1);
  if (!reference_failed_ && settings_.reference_type != reference_.type())
    fail(PositioningEvent::ReferenceTypeChanged);
  if (!reference_failed_) switch (reference_.tick(in)) {
      case ReferenceTravel::Outcome::Moving:
        if (!(reference_.order() == reference_order_)) {
          reference_order_ = reference_.order();
          profile_.run(reference_order_.way, settings_.reference_rules(reference_order_.fast));
        }
        break;
      case ReferenceTravel::Outcome::Found: return finish_reference(reference_.found());
      case ReferenceTravel::Outcome::CamMissing: fail(PositioningEvent::CamMissing); break;
      case ReferenceTravel::Outcome::LimitsMissing: fail(PositioningEvent::LimitsMissing); break;
    }
  target_ = setpoint();
}

// The reference point gets the number P900; the axis stops after it.
void Positioner::finish_reference(int32_t reference_point) {
  const int32_t before = actual();
  const int32_t now = wrapped(int64_t{before} - reference_point + settings_.reference_offset);
  encoders_.set_position(source(), now);
  if (source() == PositionSource::Motor) {
    motor_counter_ = now;
    encoders_.recount(now);
  }
  modulo_.set(now);
  referenced_ = true;
  profile_.shift(int64_t{now} - before);
  const int64_t position = whole(profile_.position());
  profile_.shift(wrapped(position) - position);
  if (following_)
    brake_here();
  else
    drop_target();
  take_pending();
}

void Positioner::take_pending() {
  const Pending pending = pending_;
  pending_ = Pending::None;
  switch (pending) {
    case Pending::None: break;
    case Pending::Absolute: write_target(wrapped(pending_value_)); break;
    case Pending::Relative: move_target(pending_value_); break;
    case Pending::Modulo: write_modulo_target(wrapped(pending_value_)); break;
  }
}

}  // namespace ipos::runtime
