// The tick of an axis whose machine has more than the plainest shaft: a real control, a load by speed or place, a brake that
// takes its time, a second mass. Each of them is a file of its own; here is in which order they act.
#include <algorithm>
#include <cstdlib>

#include "runtime/motion/axis_steps.hpp"
#include "runtime/motion/load_torque.hpp"

namespace ipos::runtime {

namespace {

// 1/1000, of a motor with encoder at this speed.
int32_t flux_at(int64_t speed, int64_t rated) {
  return static_cast<int32_t>(speed > rated ? std::max<int64_t>(rated * 1'000 / speed, 50) : 1'000);
}

}  // namespace

// Smaller speeds than P300 the motor is not given, neither at the start nor at a stop.
void Axis::leap_to_start(const AxisOrder& order) {
  const FineSpeed start = fine_speed(order.control.start_stop);
  if (order.control.encoder || std::abs(ramp_.output()) >= start) return;
  const FineSpeed target = target_of(order);
  ramp_.set(std::abs(target) < start ? 0 : sign_of(target) * start);
}

// P700 = .. & DC BRAK.: instead of a ramp.
bool Axis::brakes_by_current(const AxisOrder& order) const {
  return order.control.dc_braking && order.command == AxisCommand::Stop && sequence_.phase() == AxisPhase::Moving;
}

void Axis::advance_real_setpoint(const AxisOrder& order) {
  const ControlOrder& control = order.control;
  if (!has_torque(state_.phase)) ramp_.set(control.encoder || control.flying_start ? speed_ : 0);
  const AxisPhase phase = sequence_.phase();
  if (phase == AxisPhase::Releasing) return leap_to_start(order);
  if (phase != AxisPhase::Moving) return;
  if (brakes_by_current(order)) return ramp_.set(0);
  if (order.command >= AxisCommand::Follow)
    return ramp_.set(order.command == AxisCommand::Follow ? target_of(order) : speed_);
  const FineSpeed before = ramp_.output();
  const uint32_t ms = order.stop_ramp_ms;
  if (order.command == AxisCommand::Run)
    ramp_.step(target_of(order), order.ramp);
  else
    ramp_.step(0, {ms, ms, ms, ms, 0});
  // At the current limit the ramp does not go further away from the shaft (ours).
  if (state_.current_limited && std::abs(ramp_.output() - speed_) > std::abs(before - speed_)) ramp_.wait_at(before);
  leap_to_start(order);
}

Motion Axis::drive_really(const AxisOrder& order, int64_t torque_limit, const Resistance& resistance) {
  AxisDetails& is = details_;
  if (order.control.encoder) {
    const int64_t flux = flux_at(std::abs(state_.speed), machine_.rated_speed);
    const int64_t most = int64_t{machine_.breakdown_torque} * flux / 1'000 * flux / 1'000;
    return is.control.step(shaft_, speed_, ramp_.output(), std::min(torque_limit, most), order.control, resistance);
  }
  return brakes_by_current(order)
             ? is.voltage.stand(shaft_, speed_, resistance)
             : is.voltage.step(shaft_, speed_, ramp_.output(), torque_limit, order.control, resistance);
}

Motion Axis::drive_in_detail(const AxisOrder& order, const Resistance& resistance) {
  if (!has_torque(sequence_.phase())) {
    details_.voltage.rest(order.control.hoist);
    details_.control.rest(order.control.hoist, power_.torque_of(order.control.load_precontrol));
    power_.set_flux(1'000);
    return {shaft_.free(speed_, 0, resistance), 0, false};
  }
  // Without encoder the flux is what the last millisecond left.
  if (machine_.real)
    power_.set_flux(order.control.encoder ? flux_at(std::abs(state_.speed), machine_.rated_speed) : details_.voltage.flux());
  const int64_t torque_limit = power_.torque_limit(order.current_limit);
  if (order.command == AxisCommand::Torque && sequence_.phase() == AxisPhase::Moving) {
    const FineSpeed most = std::max<FineSpeed>(fine_speed(order.speed_limit), 0);
    return shaft_.turned(speed_, power_.torque_of(order.current), most, torque_limit, resistance);
  }
  if (machine_.real) return drive_really(order, torque_limit, resistance);
  return shaft_.driven(speed_, ramp_.output(), torque_limit, resistance);
}

// The control took the spring's torque as it was; now both masses move. Ideal control holds the motor at its speed.
void Axis::move_second(const AxisOrder& order, const Resistance& resistance, int64_t load, Motion& motion) {
  const bool held = !machine_.real && has_torque(sequence_.phase()) && !motion.limited &&
                    order.command != AxisCommand::Torque;
  const auto friction = static_cast<double>(resistance.friction), pull = static_cast<double>(load);
  const FineSpeed from = held ? (speed_ + motion.speed) / 2 : speed_;
  const FineSpeed reached =
      details_.second.step(from, static_cast<double>(motion.torque), friction, pull, held ? 0 : shaft_.gain());
  if (!held) motion.speed = reached;
}

void Axis::go_in_detail(const AxisOrder& order) {
  advance_sequence(order);
  if (machine_.real)
    advance_real_setpoint(order);
  else
    advance_setpoint(order);
  const AxisPhase phase = sequence_.phase();
  details_.has_encoder = order.control.encoder;
  details_.brake.step(brake_open(), machine_.brake_release_ms, machine_.brake_apply_ms);

  const bool has_second = details_.second.fitted();
  const auto place = static_cast<int32_t>(position_ - details_.zero);
  const int64_t load = load_torque(machine_, has_second ? details_.second.speed() : speed_, place);
  Resistance against = resistance(order, machine_.brake && order.brake_function && !details_.brake.open());
  against.load += (has_second ? static_cast<int64_t>(details_.second.torque(speed_)) : load) - machine_.load_torque;
  Motion motion = drive_in_detail(order, against);
  if (has_second) move_second(order, against, load, motion);

  if (machine_.real && brakes_by_current(order)) {
    AxisOrder direct = order;
    direct.standstill_current = order.current_limit;
    move(direct, Supply::DirectCurrent, motion);
  } else {
    move(order, axis_steps::supply_of(phase), motion);
  }
  if (order.command == AxisCommand::Torque && phase == AxisPhase::Moving) ramp_.set(speed_);

  state_.phase = phase;
  state_.output_stage = phase != AxisPhase::Off;
  state_.brake_released = brake_open();
  state_.ramping = phase == AxisPhase::Moving && ramp_.output() != target_of(order);
  state_.setpoint = has_torque(phase) ? whole_speed(ramp_.output()) : 0;
}

// The field turns as it is told, not as torque and slip of the rated point say.
void Axis::show_detail() const {
  if (!machine_.real || details_.has_encoder || !has_torque(state_.phase)) return;
  state_.frequency = static_cast<int32_t>(int64_t{whole_speed(fine_of(details_.voltage.field()))} * machine_.pole_pairs / 60);
}

}  // namespace ipos::runtime
