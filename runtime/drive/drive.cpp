// What the drive does in a millisecond, and what it shows of it.
#include "runtime/drive/drive.hpp"

#include <algorithm>
#include <cstdlib>

#include "runtime/drive/error_memory.hpp"
#include "runtime/drive/indices.hpp"

namespace ipos::runtime {
namespace {

// How long installing the factory setting takes; ours.
constexpr uint32_t kFactorySettingMs = 2000;
// More automatic resets than this without a manual one are not made (ours).
constexpr int kAutoResets = 3;
constexpr int32_t kOvervoltage = 900'000;  // mV, where the unit protects itself; ours
// P017 counts in 1E5 Ws (quantity 8, conversion index 5).
constexpr int64_t kEnergyDigit = 100'000;

constexpr uint32_t kIposFault = 1U << 11;  // of H484, MOVITRAC 07 figure 19

namespace faults {
constexpr uint8_t kDcLink = 7, kSpeedMonitoring = 8, kHeatSink = 11, kExternal = 26, kLimitSwitches = 27,
                  kFieldbus = 28, kTemperatureSensor = 31, kRs485 = 43, kSbus = 47, kMotorOverload = 84;
}  // namespace faults

constexpr uint8_t fault_of(PoSource source) {
  switch (source) {
    case PoSource::Rs485: return faults::kRs485;
    case PoSource::Fieldbus: return faults::kFieldbus;
    case PoSource::Sbus: break;
  }
  return faults::kSbus;
}

// A ramp time is the time for this change of speed: 3000 rpm on MOVIDRIVE (ours), 50 Hz on MOVITRAC 07 (its
// manual, chapter 6.1).
MachineData machine_of(MachineData machine, bool is_m07) {
  if (is_m07) machine.ramp_reference = machine.rated_speed;
  return machine;
}

// For output function /IPOS ERROR.
bool is_ipos_fault(uint8_t number) {
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  return row != nullptr && row->name.starts_with("IPOS");
}

constexpr PoSource kAllSources[] = {PoSource::Rs485, PoSource::Fieldbus, PoSource::Sbus};

}  // namespace

Drive::Drive(ParameterStore& parameters, const MachineData& machine)
    : parameters_(parameters),
      is_m07_(parameters.unit().generation == stdlib::Generation::M07),
      reader_(parameters),
      settings_(reader_.read(parameters)),
      settings_version_(parameters.changes()),
      axis_(machine_of(machine, is_m07_)) {
  parameters.connect(*this);
}

void Drive::read_settings() const {
  settings_version_ = parameters_.changes();
  settings_ = reader_.read(parameters_);
}

// --- process data ---

void Drive::take_po(PoSource source, std::span<const uint16_t> words, bool cyclic) {
  const size_t count = std::min(words.size(), kProcessWords);
  std::copy_n(words.begin(), count, shown_po_.begin());
  const auto s = static_cast<size_t>(source);
  if (settings().po_enable != 1) {
    if (cyclic) take_request(source);  // the bus speaks, though nothing is taken over
    return;
  }
  std::copy_n(words.begin(), count, po_[s].begin());
  if (watches_[s].on_process_data(cyclic)) faults_.clear_cause(fault_of(source));
  if (settings().control_bus != source) return;
  const uint16_t word = order_of(source).control_word.value_or(0);
  const bool reset_edge = (word & ~last_control_word_ & control_bits::kReset) != 0;
  last_control_word_ = word;
  if (reset_edge) reset_fault();
}

void Drive::take_request(PoSource source) {
  if (watches_[static_cast<size_t>(source)].on_request()) faults_.clear_cause(fault_of(source));
}

// Asked several times a millisecond, so what was decoded is kept until words or settings change.
const BusOrder& Drive::order_of(PoSource source) const {
  const Settings& s = settings();
  const Words& words = po_[static_cast<size_t>(source)];
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

// P876 and a source that is a bus (MDX60B/61B p. 93).
bool Drive::po_data_enabled() const {
  return settings().po_enable == 1 && (settings().setpoint_bus || settings().control_bus);
}

uint16_t Drive::reserved_control_bits() const {
  using namespace control_bits;
  const BusOrder& order = control_order();
  const unsigned reserved =
      kReserved | (order.is_control_word_1 ? kReservedWord1 : 0U) | (is_m07_ ? kReservedM07 : 0U);
  return static_cast<uint16_t>(order.control_word.value_or(0) & reserved);
}

// --- who controls ---

// Control word 2 of MOVIDRIVE carries eight virtual inputs in its high byte; they act like DI10..DI17 (common
// knowledge, in no manual read). On MOVITRAC 07 those bits are free for the program.
const Terminals& Drive::terminals() const {
  uint16_t levels = inputs_;
  const Settings& s = settings();
  if (!is_m07_) {
    const BusOrder& order = control_order();
    if (order.control_word && !order.is_control_word_1)
      levels = static_cast<uint16_t>(levels | (*order.control_word & 0xFF00U));
  }
  if (known_terminals_version_ != settings_version_ || known_levels_ != levels) {
    known_terminals_ = {levels, s.inputs};
    known_terminals_version_ = settings_version_;
    known_levels_ = levels;
  }
  return known_terminals_;
}

// Silence of a bus that nobody has heard yet: the drive waits (1053 1610 p. 27, 64). On MOVITRAC 07 the same
// silence on the SBus is a fault (its manual, chapter 7.1). Over RS-485 the drive waits even with the
// monitoring off (TIME-04), over the others it does not (DIAG-12).
bool Drive::waits_for(PoSource bus) const {
  if (bus == PoSource::Rs485) return true;
  if (bus == PoSource::Sbus && is_m07_) return false;
  return monitored(bus == PoSource::Sbus ? settings().sbus_timeout : settings().fieldbus_timeout) != 0;
}

bool Drive::is_waiting() const {
  const Settings& s = settings();
  if (s.po_enable != 1) return false;
  for (const auto bus : {s.setpoint_bus, s.control_bus})
    if (bus && !watch(*bus).seen() && waits_for(*bus)) return true;
  return false;
}

ControlInputs Drive::control_inputs() const {
  const Settings& s = settings();
  ControlInputs in;
  in.terminals = terminals();
  in.m07 = is_m07_;
  constexpr int32_t kThreeWire = 4;
  const bool three_wire = is_m07_ && s.control_source == kThreeWire;
  in.cw = three_wire ? three_wire_cw_ : in.terminals.on(InputFunction::Cw) || ipos_bit(InputFunction::Cw);
  in.ccw = three_wire ? three_wire_ccw_ : in.terminals.on(InputFunction::Ccw) || ipos_bit(InputFunction::Ccw);
  in.sign_decides = sign_decides(s, in.terminals.on(InputFunction::SlaveFreeRun));
  in.ipos_word = ipos_word_;
  in.positioning = position_.controls;
  in.axis_stop = position_.halt;
  in.fault_stop = faults_.stop();
  in.fault_is_warning = faults_.warning();
  in.factory_setting = parameters_.factory_setting_running();
  in.starting_up = starting_up();
  in.waiting = is_waiting();
  if (const auto bus = s.control_bus) {
    in.bus_word = 0;
    if (s.po_enable != 1)
      in.bus_word_missing = Block::PoDisabled;
    else if (const BusOrder& order = order_of(*bus); !order.control_word)
      in.bus_word = control_bits::kEnable;  // no PO word is a control word: as if enabled (unit profile)
    else if (!watch(*bus).seen() && !is_m07_ && !waits_for(*bus))
      in.bus_word = control_bits::kEnable;  // without monitoring the enable takes effect (1053 1610 p. 64)
    else if (!watch(*bus).seen())
      in.bus_word_missing = Block::NoControlWord;
    else
      in.bus_word = order.control_word;
  }
  return in;
}

Verdict Drive::verdict() const {
  Verdict verdict = decide(control_inputs());
  if (stopped_by_setpoint_) verdict.restrict_to(Command::Stop, Block::StopFunction);
  // Positioning looks after the limit switches itself: a reference travel has to reach them.
  if (verdict.command != Command::Enable || position_.controls) return verdict;
  const Terminals& t = terminals();
  if (t.off(InputFunction::LimitCw) && setpoint_.speed > 0)
    verdict.restrict_to(Command::EmergencyStop, Block::LimitCw);
  if (t.off(InputFunction::LimitCcw) && setpoint_.speed < 0)
    verdict.restrict_to(Command::EmergencyStop, Block::LimitCcw);
  return verdict;
}

// MOVITRAC 07 need not have an inhibit terminal, so there a standing drive is enough for R parameters (ours).
bool Drive::controller_inhibited() const {
  ControlInputs in = control_inputs();
  in.fault_stop = FaultStop::None;
  return decide(in).command == Command::Inhibit || (is_m07_ && !output_stage_on());
}

bool Drive::can_position() const {
  if (is_m07_ || second_set_) return false;
  constexpr int32_t kVfcIpos = 9, kCfcIpos = 13, kServoIpos = 18;
  const int32_t mode = set().operating_mode;
  return mode == kVfcIpos || mode == kCfcIpos || mode == kServoIpos;
}

bool Drive::follows() const {
  return axis_.state().phase == AxisPhase::Moving && verdict().command == Command::Enable;
}

void Drive::set_position(int32_t counter) {
  counter_shift_ += static_cast<uint32_t>(counter) - static_cast<uint32_t>(axis_.state().position);
  axis_.set_position(counter);
}

int32_t Drive::shaft_position() const {
  return static_cast<int32_t>(static_cast<uint32_t>(axis_.state().position) - counter_shift_);
}

std::optional<int32_t> Drive::bus_position() const {
  for (const auto bus : {settings().setpoint_bus, settings().control_bus})
    if (bus && settings().po_enable == 1 && watch(*bus).seen())
      if (const auto position = order_of(*bus).position) return position;
  return std::nullopt;
}

// --- faults ---

FaultResponse Drive::response_of(uint8_t number) const {
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  if (row == nullptr) return FaultResponse::ImmediateError;
  if (row->parameter.empty() || row->parameter == stdlib::kByCommand)
    return responses_[number].value_or(row->response);
  const stdlib::Parameter* parameter = parameters_.table().find(row->parameter);
  if (parameter != nullptr) return static_cast<FaultResponse>(parameters_.value(parameter->index));
  return is_m07_ ? FaultResponse::RapidError : row->response;  // fixed there (M07-MON-03)
}

bool Drive::set_fault_response(uint8_t number, FaultResponse response) {
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  if (row == nullptr || row->parameter != stdlib::kByCommand) return false;
  responses_[number] = response;
  return true;
}

void Drive::raise_fault(uint8_t number) { raise_fault(number, response_of(number)); }

// Warnings pass by themselves and do not fill the error memory (ours).
void Drive::raise_fault(uint8_t number, FaultResponse response) {
  if (faults_.raise(number, response) && is_error(response))
    remember_fault(parameters_, number, axis_.state().utilization);
}

void Drive::reset_fault() {
  auto_resets_ = 0;
  clear_faults();
}

// After a reset the drive is safe until its bus speaks again (1053 1610 p. 27).
void Drive::clear_faults() {
  if (faults_.error())
    for (LinkWatch& link : watches_) link.forget();
  faults_.reset();
  ++resets_;
  auto_reset_ms_ = 0;
}

void Drive::on_parameter_written(uint16_t index, int32_t value) {
  if (index == index::kManualReset && value == 1) reset_fault();
}

// --- the millisecond ---

void Drive::tick(const PositionControl& position) {
  position_ = position;
  count_time();
  latch_three_wire();
  watch_resets();
  watch_links();
  watch_machine();
  select_parameter_set();
  setpoint_ = next_setpoint();
  const AxisOrder order = axis_order(verdict());
  axis_.tick(order);
  show_outputs(order);
}

void Drive::count_time() {
  if (starting_up()) ++up_ms_;
  const auto count = [&](uint32_t& ms, uint16_t minutes) {
    if (++ms < kMinuteMs) return;
    ms = 0;
    parameters_.set_display(minutes, parameters_.value(minutes) + 1);
  };
  count(mains_ms_, index::kMainsOnTime);
  if (output_stage_on()) count(enabled_ms_, index::kEnabledTime);
  if (axis_.state().energy - counted_energy_ >= kEnergyDigit) {
    counted_energy_ += kEnergyDigit;
    parameters_.set_display(index::kEnergy, parameters_.value(index::kEnergy) + 1);
  }
  if (parameters_.factory_setting_running() && ++factory_setting_ms_ >= kFactorySettingMs) {
    factory_setting_ms_ = 0;
    parameters_.finish_factory_setting();
  }
}

// P101 = 3-WIRE-CONTROL: a pulse on a direction input starts, ENABLE/STOP at 0 ends (ours; the list only
// names it).
void Drive::latch_three_wire() {
  const Terminals& t = terminals();
  const bool cw = t.on(InputFunction::Cw);
  const bool ccw = t.on(InputFunction::Ccw);
  if (cw && !cw_input_) three_wire_cw_ = true, three_wire_ccw_ = false;
  if (ccw && !ccw_input_) three_wire_ccw_ = true, three_wire_cw_ = false;
  if (t.off(InputFunction::Enable)) three_wire_cw_ = three_wire_ccw_ = false;
  cw_input_ = cw;
  ccw_input_ = ccw;
}

void Drive::watch_resets() {
  const bool reset = function_on(InputFunction::Reset);
  if (reset && !reset_input_) reset_fault();
  reset_input_ = reset;
  if (!faults_.error()) return;
  if (settings().auto_reset != 1 || auto_resets_ >= kAutoResets) return;
  if (++auto_reset_ms_ < settings().auto_reset_time) return;
  ++auto_resets_;
  clear_faults();
}

// 0 switches the monitoring off, on MOVIDRIVE 650 s does, too (1053 1610 p. 41; of MOVITRAC 07 chapter 4.1
// names 0 only).
int32_t Drive::monitored(int32_t delay_ms) const {
  constexpr int32_t kOff = 650'000;
  return !is_m07_ && delay_ms == kOff ? 0 : delay_ms;
}

// Nothing is supervised that is not taken over (P876).
void Drive::watch_links() {
  const Settings& s = settings();
  const auto setpoint = s.setpoint_bus;
  const auto control = s.control_bus;
  const bool enabled = !starting_up() && decide_locally(control_inputs()).command == Command::Enable;
  const bool over_rs485 = is_master_slave(s) && setpoint == PoSource::Rs485;
  for (const PoSource source : kAllSources) {
    const bool used = s.po_enable == 1 && (setpoint == source || control == source);
    LinkWatch::Rules rules;
    switch (source) {
      case PoSource::Rs485:
        // A master/slave link watches itself, whatever P812 says (bus/movilink/serial_slave.hpp).
        rules = {over_rs485 ? 0 : monitored(s.rs485_timeout), true, false};
        break;
      case PoSource::Fieldbus: rules = {monitored(s.fieldbus_timeout), used && enabled, false}; break;
      case PoSource::Sbus: rules = {monitored(s.sbus_timeout), used && enabled, is_m07_}; break;
    }
    if (watches_[static_cast<size_t>(source)].tick(rules)) raise_fault(fault_of(source));
  }
}

void Drive::watch_machine() {
  const Terminals& t = terminals();
  const auto follow = [&](bool cause, uint8_t number) {
    if (cause)
      raise_fault(number);
    else
      faults_.clear_cause(number);
  };
  follow(t.off(InputFunction::ExternalFault) || (ipos_word_ & kIposFault) != 0, faults::kExternal);
  follow(t.off(InputFunction::TemperatureSensor), faults::kTemperatureSensor);
  if (t.off(InputFunction::LimitCw) && t.off(InputFunction::LimitCcw)) raise_fault(faults::kLimitSwitches);

  const AxisState& axis = axis_.state();
  if (axis.dc_link > kOvervoltage) raise_fault(faults::kDcLink);
  if (axis.heat_sink > kOvertemperature) raise_fault(faults::kHeatSink);
  follow(set().motor_protection == 1 && axis.motor_utilization >= kFullUtilization, faults::kMotorOverload);

  // P500: 1 motor mode, 2 regenerative, 3 both (1053 1610 p. 77).
  const int32_t mode = set().speed_monitoring;
  const bool regenerative = (axis.torque < 0) != (axis.speed < 0);
  const bool counts =
      axis.current_limited && (mode == 3 || (mode == 1 && !regenerative) || (mode == 2 && regenerative));
  limited_ms_ = counts ? limited_ms_ + 1 : 0;
  if (counts && limited_ms_ > set().speed_monitoring_delay) raise_fault(faults::kSpeedMonitoring);
}

// The set changes only while the output stage is off (ours).
void Drive::select_parameter_set() {
  if (output_stage_on() || is_m07_) return;
  const BusOrder& order = control_order();
  second_set_ = function_on(InputFunction::ParameterSwitch) ||
                (order.control_word.value_or(0) & control_bits::kParameterSet) != 0;
}

void Drive::show_outputs(const AxisOrder& order) {
  const AxisState& axis = axis_.state();
  OutputInputs in;
  in.fault = faults_.error();
  in.ipos_fault = is_ipos_fault(faults_.error_number());
  in.ready = ready();
  in.output_stage = axis.output_stage;
  in.brake_released = axis.brake_released;
  in.standstill = axis.standing;
  in.second_set = second_set_;
  in.motor_1_overloaded = !second_set_ && axis.motor_utilization >= kFullUtilization;
  in.motor_2_overloaded = second_set_ && axis.motor_utilization >= kFullUtilization;
  in.speed = axis.speed;
  // Compared with the setpoint before the ramp, so that P420 tells when it is reached (ours).
  in.setpoint = order.command == AxisCommand::Run ? order.target : 0;
  in.current = axis.output_current;
  in.current_limit = order.current_limit;
  in.in_position = position_.in_position;
  in.referenced = position_.referenced;
  in.ipos_outputs = ipos_outputs_;
  outputs_.tick(settings(), in);
}

void Drive::power_cycle() {
  up_ms_ = 0;
  shown_po_ = {};
  po_ = {};
  for (LinkWatch& link : watches_) link.forget();
  last_control_word_ = 0;
  ipos_word_ = 0;
  ipos_pi_ = {};
  ipos_outputs_ = 0;

  faults_ = {};
  responses_ = {};
  reset_input_ = false;
  auto_reset_ms_ = auto_resets_ = limited_ms_ = 0;

  second_set_ = three_wire_cw_ = three_wire_ccw_ = cw_input_ = ccw_input_ = stopped_by_setpoint_ = false;
  if (settings().keep_motor_pot != 1) motor_pot_ = {};
  pi_controller_ = {};
  pi_actual_ = 0;
  ai1_filter_ = {};
  setpoint_ = {};

  position_ = {};
  counter_shift_ = 0U - static_cast<uint32_t>(shaft_position());  // the shaft stays where it is
  axis_.reset();
  outputs_ = {};
  factory_setting_ms_ = mains_ms_ = enabled_ms_ = 0;
  counted_energy_ = 0;
}

}  // namespace ipos::runtime
