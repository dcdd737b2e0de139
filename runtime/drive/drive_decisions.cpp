// What a drive decides from its settings and its situation (decisions.hpp): control sources, monitoring and
// the order for the setpoint. Called when one of both has changed; nothing here may depend on anything else.
#include "runtime/drive/drive.hpp"

namespace ipos::runtime {

using stdlib::Trait;

namespace {

constexpr uint32_t kIposFault = 1U << 11;  // of H484, MOVITRAC 07 figure 19

// For output function /IPOS ERROR.
bool is_ipos_fault(uint8_t number) {
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  return row != nullptr && row->name.starts_with("IPOS");
}

}  // namespace

void Drive::decide_anew() const {
  decided_for_ = *now_;
  decisions_known_ = true;
  applied_ = false;
  order_for_.reset();
  selected_for_.reset();

  using F = InputFunction;
  Decisions& d = decisions_;
  d = {};
  const Terminals t = d.terminals = read_terminals();
  const bool free_run = runs_free(t);
  const ControlInputs in = control_inputs(t);
  d.controls = decide(in);
  d.enabled_locally = decide_locally(in).command == Command::Enable;
  d.waiting = in.waiting;
  d.can_position = mode_can_position();
  d.can_synchronize = !now_->second_set && is_synchronous(set().operating_mode);
  d.ready = !now_->faults.error() && !now_->factory_setting && !now_->starting_up && !now_->link_is_low;
  const auto flag = [](bool on, uint32_t bit) { return on ? bit : 0; };
  d.output_flags = flag(now_->faults.error(), output_flags::kFault) |
                   flag(is_ipos_fault(now_->faults.error_number()), output_flags::kIposFault) |
                   flag(d.ready, output_flags::kReady) | flag(now_->second_set, output_flags::kSecondSet);
  d.overload_flag = now_->second_set ? output_flags::kMotor2Overloaded : output_flags::kMotor1Overloaded;
  d.reserved_control_bits = read_reserved_bits();
  d.bus_position = read_bus_position();

  d.links = link_rules(!now_->starting_up && d.enabled_locally, free_run);
  d.reset = function_on(t, F::Reset);
  d.external_fault = t.off(F::ExternalFault) || (now_->ipos_word & kIposFault) != 0;
  d.temperature_sensor = t.off(F::TemperatureSensor);
  d.both_limit_switches = t.off(F::LimitCw) && t.off(F::LimitCcw);
  // The contact of a mains relay; it hangs on the same mains (ours).
  d.mains_gone = t.off(F::MainsOn) || (!now_->mains && t.assigned(F::MainsOn));
  d.parameter_switch = function_on(t, F::ParameterSwitch) ||
                       (control_order().control_word.value_or(0) & control_bits::kParameterSet) != 0;
  decide_setpoint(d);
}

// Asked for each telegram and by many decisions, so what was decoded is kept until words or settings change.
const BusOrder& Drive::order_of(PoSource source) const {
  const Settings& s = settings();
  const Words& words = now_->po[static_cast<size_t>(source)];
  const int32_t maximum_speed = set().maximum_speed;
  KnownOrder& known = known_orders_[static_cast<size_t>(source)];
  if (known.version != settings_version_ || known.words != words || known.maximum_speed != maximum_speed)
    known = {words, settings_version_, maximum_speed, decode_order(words, s.po, maximum_speed)};
  return known.order;
}

const BusOrder& Drive::control_order() const {
  static constexpr BusOrder kNone{};
  const auto bus = settings().control_bus;
  return bus && settings().po_enable == 1 ? order_of(*bus) : kNone;
}

const BusOrder& Drive::setpoint_order() const {
  static constexpr BusOrder kNone{};
  const auto bus = settings().setpoint_bus;
  return bus && settings().po_enable == 1 ? order_of(*bus) : kNone;
}

uint16_t Drive::read_reserved_bits() const {
  using namespace control_bits;
  const BusOrder& order = control_order();
  unsigned reserved = kReserved | (order.is_control_word_1 ? kReservedWord1 : 0U);
  if (!traits_.has(Trait::HoldControl)) reserved |= kHold;
  if (!traits_.has(Trait::RampSets)) reserved |= kRampSet;
  if (!traits_.has(Trait::ParameterSets)) reserved |= kParameterSet;
  return static_cast<uint16_t>(order.control_word.value_or(0) & reserved);
}

// --- who controls ---

// Control word 2 of MOVIDRIVE carries eight virtual inputs in its high byte; they act like DI10..DI17 (common
// knowledge, in no manual read).
Terminals Drive::read_terminals() const {
  uint16_t levels = now_->inputs;
  if (traits_.has(Trait::VirtualInputs)) {
    const BusOrder& order = control_order();
    if (order.control_word && !order.is_control_word_1)
      levels = static_cast<uint16_t>(levels | (*order.control_word & 0xFF00U));
  }
  return {levels, settings().inputs};
}

// Silence of a bus that nobody has heard yet: the drive waits (1053 1610 p. 27, 64). On MOVITRAC 07 the same
// silence on the SBus is a fault (its manual, chapter 7.1). Over RS-485 the drive waits even with the
// monitoring off (TIME-04), over the others it does not (DIAG-12): then terminals enable it, or a control word that
// has come.
bool Drive::waits_for(PoSource bus) const {
  if (bus == PoSource::Rs485 || traits_.has(Trait::WaitsForEveryBus)) return true;
  if (bus == PoSource::Sbus && traits_.has(Trait::SbusFaultFromStart)) return false;
  if (bus == PoSource::Fieldbus) return monitored(settings().fieldbus_timeout) != 0;
  return monitored(settings().sbus_timeout) != 0 || monitored(settings().sbus2_timeout) != 0;
}

bool Drive::is_waiting() const {
  const Settings& s = settings();
  if (s.po_enable != 1) return false;
  for (const auto bus : {s.setpoint_bus, s.control_bus})
    if (bus && !heard(*bus) && waits_for(*bus)) return true;
  return false;
}

// The input function SLAVE FREE RUNN. takes a follower from its master: setpoint and enable are local, and nobody
// waits for telegrams or misses them (that it takes the control word, too, is ours).
bool Drive::runs_free(const Terminals& t) const {
  return is_master_slave(settings()) && t.on(InputFunction::SlaveFreeRun);
}

ControlInputs Drive::control_inputs(const Terminals& t) const {
  const Settings& s = settings();
  ControlInputs in;
  in.terminals = t;
  in.traits = traits_;
  const bool three_wire = traits_.has(Trait::ThreeWireControl) && s.control_source == stdlib::code(stdlib::ControlSource::ThreeWire);
  in.cw = three_wire ? now_->three_wire_cw : t.on(InputFunction::Cw) || ipos_bit(InputFunction::Cw);
  in.ccw = three_wire ? now_->three_wire_ccw : t.on(InputFunction::Ccw) || ipos_bit(InputFunction::Ccw);
  in.sign_decides = sign_decides(s, t.on(InputFunction::SlaveFreeRun));
  in.ipos_word = now_->ipos_word;
  in.positioning = now_->positioning;
  in.axis_stop = now_->halt;
  in.fault_stop = now_->faults.stop();
  in.fault_is_warning = now_->faults.warning();
  in.factory_setting = now_->factory_setting;
  in.starting_up = now_->starting_up;
  in.link_is_low = now_->link_is_low;
  if (now_->mains_stop) in.mains_response = mains_off_response();
  const bool free_run = runs_free(t);
  in.waiting = !free_run && is_waiting();
  in.follows_master = is_master_slave(s);
  if (const auto bus = s.control_bus; bus && !free_run) {
    in.bus_word = 0;
    if (s.po_enable != 1)
      in.bus_word_missing = Block::PoDisabled;
    else if (!heard(*bus))
      in.bus_word_missing = Block::NoControlWord;
    else if (const BusOrder& order = order_of(*bus); !order.control_word)
      in.bus_word = control_bits::kEnable;  // no PO word is a control word: as if enabled (unit profile)
    else
      in.bus_word = order.control_word;
  }
  return in;
}

// P521: 0 controller inhibit, 1 emergency stop (1053 1610 p. 77).
Command Drive::mains_off_response() const {
  return settings().mains_off_response == 1 ? Command::EmergencyStop : Command::Inhibit;
}

bool Drive::mode_can_position() const {
  if (!traits_.has(Trait::Positioning) || now_->second_set) return false;
  constexpr int32_t kVfcIpos = 9, kCfcIpos = 13, kServoIpos = 18;
  const int32_t mode = set().operating_mode;
  return mode == kVfcIpos || mode == kCfcIpos || mode == kServoIpos;
}

std::optional<int32_t> Drive::read_bus_position() const {
  for (const auto bus : {settings().setpoint_bus, settings().control_bus})
    if (bus && settings().po_enable == 1 && heard(*bus))
      if (const auto position = order_of(*bus).position) return position;
  return std::nullopt;
}

// --- monitoring ---

// 0 switches the monitoring off.
int32_t Drive::monitored(int32_t delay_ms) const {
  constexpr int32_t kOff = 650'000;
  return delay_ms == kOff && traits_.has(Trait::LongTimeoutIsOff) ? 0 : delay_ms;
}

// Nothing is supervised that is not taken over (P876).
std::array<LinkWatch::Rules, kPoLinks> Drive::link_rules(bool enabled_locally, bool free_run) const {
  std::array<LinkWatch::Rules, kPoLinks> rules;
  const Settings& s = settings();
  const auto setpoint = s.setpoint_bus;
  const auto control = s.control_bus;
  const bool over_rs485 = is_master_slave(s) && setpoint == PoSource::Rs485;
  for (const PoSource source : {PoSource::Rs485, PoSource::Fieldbus, PoSource::Sbus, PoSource::Sbus2}) {
    const PoSource words = source == PoSource::Sbus2 ? PoSource::Sbus : source;
    const bool used = !free_run && s.po_enable == 1 && (setpoint == words || control == words);
    LinkWatch::Rules& rule = rules[static_cast<size_t>(source)];
    switch (source) {
      case PoSource::Rs485:
        // A master/slave link watches itself, whatever P812 says (bus/movilink/serial_slave.hpp).
        rule = {over_rs485 ? 0 : monitored(s.rs485_timeout), true, false};
        break;
      case PoSource::Fieldbus: rule = {monitored(s.fieldbus_timeout), used && enabled_locally, false}; break;
      case PoSource::Sbus:
        rule = {monitored(s.sbus_timeout), used && enabled_locally, traits_.has(Trait::SbusFaultFromStart)};
        break;
      case PoSource::Sbus2: rule = {monitored(s.sbus2_timeout), used && enabled_locally, false}; break;
    }
  }
  return rules;
}

// --- the setpoint ---

void Drive::decide_setpoint(Decisions& d) const {
  const Settings& s = settings();
  const ParameterSet& active = set();
  const Terminals& t = d.terminals;
  const BusOrder& control = control_order();
  const BusOrder& bus = setpoint_order();
  const uint16_t word = control.is_control_word_1 ? control.control_word.value_or(0) : 0;
  const ControlInputs controls = control_inputs(t);
  const bool running = d.controls.command == Command::Enable;
  d.setpoint_held = function_on(t, InputFunction::SetpointHold);
  d.ai1_speed = ai1_speed(s, active, now_->analog);

  SetpointInputs& in = d.setpoint;
  in.unipolar_is_amount = traits_.has(Trait::UnipolarIsAmount);
  in.fixed_plus_potentiometer = parameters_.options().firmware_from(13, 12);
  in.torque_control = is_torque_control(active.operating_mode);
  in.slave_free_run = t.on(InputFunction::SlaveFreeRun);
  const bool low = function_on(t, InputFunction::FixedLow);
  const bool high = function_on(t, InputFunction::FixedHigh);
  in.fixed = (low ? 1 : 0) | (high ? 2 : 0) | ((word >> control_bits::kFixedShift) & 3);
  in.other_set = function_on(t, InputFunction::FixedSwitch) || (word & control_bits::kFixedSwitch) != 0;
  in.ccw = controls.ccw && !controls.cw;
  in.analog = now_->analog;
  in.po_enabled = s.po_enable == 1;
  in.bus_speed = bus.speed;
  in.bus_current = bus.current;
  in.sent_speed = decode_order(now_->shown_po, s.po, active.maximum_speed).speed.value_or(0);
  const auto setpoint_from = s.setpoint_bus;
  in.bus_accepted = setpoint_from && heard(*setpoint_from);
  in.maximum_speed = bus.maximum_speed ? bus.maximum_speed : control.maximum_speed;
  in.motor_pot_ccw = (word & control_bits::kPotCcw) != 0;

  d.motor_pot_falls_back = !running && s.keep_motor_pot != 1;
  MotorPotentiometer::Order& pot = d.motor_pot;
  pot.up = running && (function_on(t, InputFunction::PotUp) || (word & control_bits::kPotUp) != 0);
  pot.down = running && (function_on(t, InputFunction::PotDown) || (word & control_bits::kPotDown) != 0);
  pot.minimum = active.minimum_speed;
  pot.maximum = active.maximum_speed;
  pot.up_ms = s.motor_pot_up;
  pot.down_ms = s.motor_pot_down;
  pot.span = state_.axis.machine().ramp_reference;

  if (s.pi_controller == 0) return;
  const auto percent = [](int32_t whole) { return whole * 1000; };
  PiController::Order order;
  const ParameterSet& fixed = in.other_set ? other_set() : active;
  if (in.fixed != 0)
    order.setpoint = percent(in.fixed == 1 ? fixed.pi_n1 : in.fixed == 2 ? fixed.pi_n2 : fixed.pi_n3);
  else  // the built-in potentiometer is always part of it (MOVITRAC 07 chapter 6.4)
    order.setpoint = bus.pi_setpoint.value_or(0) + now_->analog.potentiometer * 100;
  order.actual = percent(s.pi_offset) + pi_actual_value(s, now_->analog);
  order.inverted = s.pi_controller == 2;
  order.gain = s.pi_gain;
  order.time_s = s.pi_time;
  d.pi = order;
  d.pi_resets = !running;
}

}  // namespace ipos::runtime
