// What the drive tells its axis: the setpoint from the cascade, ramps, stops, brake and limits.
#include <algorithm>
#include <cstdlib>

#include "runtime/drive/drive.hpp"

namespace ipos::runtime {

Setpoint Drive::next_setpoint() {
  if (position_.controls) {
    stopped_by_setpoint_ = false;
    return {position_.speed, position_.speed, SetpointNote::None};
  }
  const Settings& s = settings();
  const ParameterSet& active = set();
  const Terminals& t = terminals();
  if (t.on(InputFunction::SetpointHold) || ipos_bit(InputFunction::SetpointHold)) return setpoint_;

  const BusOrder& control = control_order();
  const BusOrder& bus = setpoint_order();
  const uint16_t word = control.is_control_word_1 ? control.control_word.value_or(0) : 0;
  const ControlInputs controls = control_inputs();

  SetpointInputs in;
  in.m07 = is_m07_;
  in.fixed_plus_potentiometer = parameters_.options().firmware_from(13, 12);
  in.slave_free_run = t.on(InputFunction::SlaveFreeRun);
  const bool low = function_on(InputFunction::FixedLow);
  const bool high = function_on(InputFunction::FixedHigh);
  in.fixed = (low ? 1 : 0) | (high ? 2 : 0) | ((word >> control_bits::kFixedShift) & 3);
  in.other_set = function_on(InputFunction::FixedSwitch) || (word & control_bits::kFixedSwitch) != 0;
  in.ccw = controls.ccw && !controls.cw;
  in.analog = analog_;
  in.ai1_speed = ai1_filter_.tick(ai1_speed(s, active, analog_), s.setpoint_filter);
  in.po_enabled = s.po_enable == 1;
  in.bus_speed = bus.speed;
  in.sent_speed = decode_order(shown_po_, s.po, active.maximum_speed).speed.value_or(0);
  const auto setpoint_from = s.setpoint_bus;
  in.bus_accepted = setpoint_from && watch(*setpoint_from).seen();
  in.maximum_speed = bus.maximum_speed ? bus.maximum_speed : control.maximum_speed;

  const bool running = decide(controls).command == Command::Enable;
  if (!running && s.keep_motor_pot != 1) motor_pot_.set(active.minimum_speed);
  MotorPotentiometer::Order pot;
  pot.up = running && (function_on(InputFunction::PotUp) || (word & control_bits::kPotUp) != 0);
  pot.down = running && (function_on(InputFunction::PotDown) || (word & control_bits::kPotDown) != 0);
  pot.minimum = active.minimum_speed;
  pot.maximum = active.maximum_speed;
  pot.up_ms = s.motor_pot_up;
  pot.down_ms = s.motor_pot_down;
  pot.span = axis_.machine().ramp_reference;
  motor_pot_.tick(pot);
  in.motor_pot = motor_pot_.value();
  in.motor_pot_ccw = (word & control_bits::kPotCcw) != 0;

  if (s.pi_controller != 0) {
    const auto percent = [&](int32_t whole) { return whole * 1000; };
    PiController::Order order;
    const ParameterSet& fixed = in.other_set ? s.sets[second_set_ ? 0 : 1] : active;
    if (in.fixed != 0)
      order.setpoint = percent(in.fixed == 1 ? fixed.pi_n1 : in.fixed == 2 ? fixed.pi_n2 : fixed.pi_n3);
    else  // the built-in potentiometer is always part of it (MOVITRAC 07 chapter 6.4)
      order.setpoint = bus.pi_setpoint.value_or(0) + analog_.potentiometer * 100;
    pi_actual_ = percent(s.pi_offset) + pi_actual_value(s, analog_);
    order.actual = pi_actual_;
    order.inverted = s.pi_controller == 2;
    order.gain = s.pi_gain;
    order.time_s = s.pi_time;
    if (!running) pi_controller_.reset();
    in.pi_output = pi_controller_.tick(order);
  }

  const Setpoint next = select_setpoint(s, active, other_set(), in);
  if (active.stop_function == 1) {
    const int64_t magnitude = std::abs(int64_t{next.requested});
    if (magnitude < active.stop_setpoint) stopped_by_setpoint_ = true;
    if (magnitude > int64_t{active.stop_setpoint} + active.start_offset) stopped_by_setpoint_ = false;
  } else {
    stopped_by_setpoint_ = false;
  }
  return next;
}

AxisOrder Drive::axis_order(const Verdict& verdict) const {
  const Settings& s = settings();
  const ParameterSet& p = set();
  const BusOrder& control = control_order();
  const BusOrder& bus = setpoint_order();
  const std::optional<int32_t> process_ramp = bus.ramp ? bus.ramp : control.ramp;
  const bool reversed = p.change_direction == 1;
  const auto ms = [](int32_t time) { return static_cast<uint32_t>(std::max(time, 0)); };

  AxisOrder order;
  order.target = reversed ? -setpoint_.speed : setpoint_.speed;
  order.ramp = {ms(p.ramp_up_cw), ms(p.ramp_down_cw), ms(p.ramp_up_ccw), ms(p.ramp_down_ccw), 0};
  const bool second_ramp = function_on(InputFunction::RampSwitch) ||
                           (!is_m07_ && (control.control_word.value_or(0) & control_bits::kRampSet) != 0);
  if (second_ramp) {
    const uint32_t t = ms(p.ramp_second);
    order.ramp = {t, t, t, t, static_cast<uint8_t>(p.s_pattern)};
  }
  if (process_ramp) {
    const uint32_t t = ms(*process_ramp);
    order.ramp = {t, t, t, t, 0};
  }
  if (reversed) {
    std::swap(order.ramp.up_cw_ms, order.ramp.up_ccw_ms);
    std::swap(order.ramp.down_cw_ms, order.ramp.down_ccw_ms);
  }
  // A stop, and hold control (ours), go down on the ramp that is chosen.
  order.stop_ramp_ms = axis_.state().setpoint < 0 ? order.ramp.down_ccw_ms : order.ramp.down_cw_ms;

  switch (verdict.command) {
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
      order.command = position_.controls ? AxisCommand::Follow : AxisCommand::Run;
      if (position_.controls) order.target = position_.speed;  // P350 does not turn positions round (ours)
      break;
  }
  // The motor potentiometer is a ramp itself; a process ramp has no influence (MOVITRAC 07 chapter 6.3).
  if (static_cast<SetpointSource>(s.setpoint_source) == SetpointSource::MotorPot) {
    order.ramp.up_cw_ms = order.ramp.up_ccw_ms = ms(std::min(s.motor_pot_up, p.ramp_up_cw));
    order.ramp.down_cw_ms = order.ramp.down_ccw_ms = ms(std::min(s.motor_pot_down, p.ramp_down_cw));
  }
  // With a standstill current the output stage stays on after any stop (P710); a fault or inhibit ends it.
  order.standstill_current = faults_.error() ? 0 : p.standstill_current;
  order.brake_function = p.brake_function == 1;
  order.brake_release_ms = static_cast<uint16_t>(p.brake_release);
  order.brake_apply_ms = static_cast<uint16_t>(p.brake_application);
  order.premagnetize_ms = static_cast<uint16_t>(p.premagnetizing);
  order.current_limit = p.current_limit;
  const std::optional<int32_t> limit = bus.maximum_current ? bus.maximum_current : control.maximum_current;
  if (limit) order.current_limit = std::clamp(*limit, 0, order.current_limit);
  constexpr int32_t kAi2IsLimit = 2;
  if (s.ai2_mode == kAi2IsLimit)
    order.current_limit = static_cast<int32_t>(int64_t{order.current_limit} *
                                               std::clamp(analog_.ai2.millivolt, 0, 10'000) / 10'000);
  return order;
}

}  // namespace ipos::runtime
