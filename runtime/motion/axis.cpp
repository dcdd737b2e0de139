// The tick: sequence, setpoint, shaft, position, power section.
#include "runtime/motion/axis.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "runtime/motion/axis_steps.hpp"

namespace ipos::runtime {

Axis::Axis(const MachineData& machine) : AxisParts(machine) { show_power(); }

void Axis::set_position(int32_t position) {
  details_.zero += static_cast<uint32_t>(position) - position_;
  position_ = static_cast<uint32_t>(position);
  position_rest_ = 0;
  state_.position = position;
}

double Axis::part_of_increment() const {
  return static_cast<double>(position_rest_) / static_cast<double>(axis_steps::kIncrement);
}

inline Motion Axis::drive_to(FineSpeed setpoint, const AxisOrder& order, bool brake_acts) {
  const int64_t torque_limit = power_.torque_limit(order.current_limit);
  if (machine_.driven) return shaft_.controlled(fine_speed(order.shaft_speed), setpoint, torque_limit);
  return shaft_.driven(speed_, setpoint, torque_limit, resistance(order, brake_acts));
}

inline Motion Axis::advance_shaft(const AxisOrder& order) {
  const bool brake_acts = machine_.brake && order.brake_function && !brake_open();
  if (has_torque(sequence_.phase())) return drive_to(ramp_.output(), order, brake_acts);
  if (!machine_.driven) return {shaft_.free(speed_, 0, resistance(order, brake_acts)), 0, false};
  shaft_.forget_control();
  return {fine_speed(order.shaft_speed), 0, false};
}

void Axis::show_power() const {
  power_shown_ = true;
  state_.active_current = power_.active_current();
  state_.frequency = power_.frequency();
  state_.dc_link = power_.dc_link();
  state_.energy = power_.energy();
  state_.heat_sink = power_.heat_sink();
  state_.utilization = power_.utilization();
  state_.motor_utilization = power_.motor_utilization();
  if (detailed_) show_detail();
}

// Sequence, setpoint and shaft, each of which may have something to do.
void Axis::go_through(const AxisOrder& order) {
  advance_sequence(order);
  advance_setpoint(order);
  const AxisPhase phase = sequence_.phase();
  move(order, axis_steps::supply_of(phase), advance_shaft(order));

  state_.phase = phase;
  state_.output_stage = phase != AxisPhase::Off;
  state_.brake_released = brake_open();
  state_.ramping = phase == AxisPhase::Moving && ramp_.output() != target_of(order);
  // Most of the time the shaft is where the ramp is.
  const bool same = ramp_.output() == speed_;
  state_.setpoint = !has_torque(phase) ? 0 : same ? state_.speed : whole_speed(ramp_.output());
}

// An axis that moves already goes as it is told: only the shaft has something to do.
void Axis::go_directly(const AxisOrder& order) {
  if (order.command == AxisCommand::Torque) return turn(order);
  ramp_.set(fine_speed(order.target));
  move(order, Supply::Driving, drive_to(ramp_.output(), order, false));
  state_.ramping = false;
  state_.setpoint = whole_speed(ramp_.output());
}

// A stop begins from the speed that there is.
void Axis::turn(const AxisOrder& order) {
  const int64_t torque = power_.torque_of(order.current);
  const int64_t torque_limit = power_.torque_limit(order.current_limit);
  const FineSpeed most = std::max<FineSpeed>(fine_speed(order.speed_limit), 0);
  const FineSpeed speed = fine_speed(order.shaft_speed);
  if (!machine_.driven) {
    move(order, Supply::Driving, shaft_.turned(speed_, torque, most, torque_limit, resistance(order, false)));
  } else if (-most <= speed && speed <= most) {
    shaft_.forget_control();
    move(order, Supply::Driving, {speed, std::clamp(torque, -torque_limit, torque_limit), false});
  } else {
    move(order, Supply::Driving, drive_to(speed > 0 ? most : -most, order, false));
  }
  ramp_.set(speed_);
  state_.ramping = false;
  state_.setpoint = state_.speed;
}

void Axis::advance(Ticks ticks) {
  behind_ += ticks;
  power_shown_ = false;
  if (speed_ == 0) return;
  // The whole increments of a tick and what is left, so that no product overflows.
  using axis_steps::kIncrement;
  const int64_t way = 2 * speed_ * axis_steps::kIncrementShare;
  position_ += static_cast<uint32_t>(way / kIncrement * ticks);
  constexpr uint32_t kMost = 1 << 12;
  for (; ticks > kMost; ticks -= kMost) count_position(way % kIncrement * kMost);
  count_position(way % kIncrement * ticks);
  state_.position = static_cast<int32_t>(position_);
}

void Axis::draw_and_warm() const { power_.advance(std::exchange(behind_, 0)); }

}  // namespace ipos::runtime
