// What the drive tells its axis: the setpoint from the cascade, ramps, stops, brake and limits.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "runtime/drive/drive.hpp"

namespace ipos::runtime {

using stdlib::Trait;

// Filter, motor potentiometer and PI controller go on every millisecond; the choice is made again when one of
// them gives something else.
Setpoint Drive::next_setpoint(const Decisions& d) {
  if (d.setpoint_held) return state_.setpoint;
  const ParameterSet& active = set();
  SetpointMemory memory;
  memory.ai1_speed = state_.ai1_filter.tick(d.ai1_speed, settings_.setpoint_filter);
  if (d.motor_pot_falls_back) state_.motor_pot.set(active.minimum_speed);
  state_.motor_pot.tick(d.motor_pot);
  memory.motor_pot = state_.motor_pot.value();
  if (d.pi) {
    state_.pi_actual = d.pi->actual;
    if (d.pi_resets) state_.pi_controller.reset();
    memory.pi_output = state_.pi_controller.tick(*d.pi);
  }
  if (selected_for_ != memory) {
    selected_for_ = memory;
    SetpointInputs in = d.setpoint;
    in.ai1_speed = memory.ai1_speed;
    in.motor_pot = memory.motor_pot;
    if (d.pi) in.pi_output = memory.pi_output;
    selected_ = select_setpoint(settings_, active, other_set(), in);
  }
  // The stop function is of speeds (ours).
  if (active.stop_function == 1 && !d.setpoint.torque_control) {
    const int64_t magnitude = std::abs(int64_t{selected_.requested});
    if (magnitude < active.stop_setpoint) state_.stopped_by_setpoint = true;
    if (magnitude > int64_t{active.stop_setpoint} + active.start_offset) state_.stopped_by_setpoint = false;
  } else {
    state_.stopped_by_setpoint = false;
  }
  return selected_;
}

// All but the target.
AxisOrder Drive::axis_order(Command command) const {
  const Settings& s = settings();
  const ParameterSet& p = set();
  const BusOrder& control = control_order();
  const BusOrder& bus = setpoint_order();
  const std::optional<int32_t> process_ramp = bus.ramp ? bus.ramp : control.ramp;
  const bool reversed = p.change_direction == 1;
  const auto ms = [](int32_t time) { return static_cast<uint32_t>(std::max(time, 0)); };

  AxisOrder order;
  order_load(order);
  order.ramp = {ms(p.ramp_up_cw), ms(p.ramp_down_cw), ms(p.ramp_up_ccw), ms(p.ramp_down_ccw), 0};
  const bool second_ramp = function_on(decisions_.terminals, InputFunction::RampSwitch) ||
                           (traits_.has(Trait::RampSets) && (control.control_word.value_or(0) & control_bits::kRampSet) != 0);
  if (second_ramp) {
    const uint32_t t = ms(p.ramp_second);
    order.ramp = {t, t, t, t, static_cast<uint8_t>(p.s_pattern)};
  }
  if (process_ramp && !(*process_ramp == 0 && traits_.has(Trait::ZeroRampIgnored))) {
    const uint32_t t = ms(*process_ramp);
    order.ramp = {t, t, t, t, 0};
  }
  if (reversed) {
    std::swap(order.ramp.up_cw_ms, order.ramp.up_ccw_ms);
    std::swap(order.ramp.down_cw_ms, order.ramp.down_ccw_ms);
  }
  // A stop, and hold control (ours), go down on the ramp that is chosen.
  order.stop_ramp_ms = now_->reversing ? order.ramp.down_ccw_ms : order.ramp.down_cw_ms;

  switch (command) {
    case Command::Inhibit: order.command = AxisCommand::Inhibit; break;
    case Command::EmergencyStop:
      order.command = AxisCommand::Stop;
      order.stop_ramp_ms = ms(p.emergency_ramp);
      break;
    case Command::RapidStop:
      order.command = AxisCommand::Stop;
      order.stop_ramp_ms = ms(p.stop_ramp);
      break;
    case Command::Stop: order.command = AxisCommand::Stop; break;
    case Command::HoldControl: order.command = AxisCommand::HoldZero; break;
    case Command::Enable:
      order.command = now_->positioning              ? AxisCommand::Follow
                      : decisions_.setpoint.torque_control ? AxisCommand::Torque
                                                     : AxisCommand::Run;
      break;
  }
  // The motor potentiometer is a ramp itself; a process ramp has no influence (MOVITRAC 07 chapter 6.3).
  if (static_cast<SetpointSource>(s.setpoint_source) == SetpointSource::MotorPot) {
    order.ramp.up_cw_ms = order.ramp.up_ccw_ms = ms(std::min(s.motor_pot_up, p.ramp_up_cw));
    order.ramp.down_cw_ms = order.ramp.down_ccw_ms = ms(std::min(s.motor_pot_down, p.ramp_down_cw));
  }
  // With a standstill current the output stage stays on after any stop (P710); a fault or inhibit ends it.
  order.standstill_current = now_->faults.error() ? 0 : p.standstill_current;
  order.brake_function = p.brake_function == 1;
  order.brake_release_ms = static_cast<uint16_t>(p.brake_release);
  order.brake_apply_ms = static_cast<uint16_t>(p.brake_application);
  order.premagnetize_ms = static_cast<uint16_t>(p.premagnetizing);
  order.speed_limit = std::clamp(decisions_.setpoint.maximum_speed.value_or(p.maximum_speed), 0, p.maximum_speed);
  order.current_limit = p.current_limit;
  const std::optional<int32_t> limit = bus.maximum_current ? bus.maximum_current : control.maximum_current;
  if (limit) order.current_limit = std::clamp(*limit, 0, order.current_limit);
  constexpr int32_t kAi2IsLimit = 2;
  if (s.ai2_mode == kAi2IsLimit) order.current_limit = share_of_ai2(order.current_limit);
  if (s.torque_limit != 0 && is_field_oriented(p.operating_mode)) order.current_limit = with_torque_limit(order.current_limit);
  order.control.encoder = has_encoder(p.operating_mode);
  order.control.hoist = is_hoist(p.operating_mode);
  order.control.dc_braking = has_dc_braking(p.operating_mode);
  order.control.flying_start = has_flying_start(p.operating_mode);
  order.control.adjusted = p.adjusted == 1;
  order.control.start_stop = p.start_stop_speed;
  order.control.slip_compensation = p.slip_compensation;
  order.control.boost = p.boost;
  order.control.ixr = p.ixr_compensation;
  order.control.gain = s.speed_gain;
  order.control.time_us = s.speed_time;
  order.control.precontrol = s.precontrol;
  order.control.precontrol_us = s.precontrol_filter;
  order.control.filter_us = s.speed_filter;
  order.control.load_precontrol = is_field_oriented(p.operating_mode) ? s.load_precontrol : 0;
  return order;
}

// P304 bounds the active current, which is what makes torque; 0, the factory setting, does not (ours). Beside it the motor
// has its magnetizing current.
int32_t Drive::with_torque_limit(int32_t current_limit) const {
  const auto square = [](int32_t current) { return static_cast<double>(current) * current; };
  const double output = std::sqrt(square(settings().torque_limit) + square(state_.axis.machine().magnetizing_current));
  return std::min(current_limit, static_cast<int32_t>(std::lround(output)));
}

// P120 = 2: 0..10 V at AI2 are 0..100 % of the current limit. P022 shows it of P303, whatever P120 is (ours).
int32_t Drive::share_of_ai2(int32_t limit) const {
  constexpr int32_t kFullVoltage = 10'000;
  return static_cast<int32_t>(int64_t{limit} * std::clamp(now_->analog.ai2.millivolt, 0, kFullVoltage) / kFullVoltage);
}

}  // namespace ipos::runtime
