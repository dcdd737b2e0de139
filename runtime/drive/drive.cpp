// What the drive does in a millisecond, and what it shows of it.
#include "runtime/drive/drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "runtime/drive/error_memory.hpp"
#include "runtime/drive/indices.hpp"
#include "runtime/motion/axis_following.hpp"

namespace ipos::runtime {

using stdlib::Trait;

namespace {

// How long installing the factory setting takes; ours.
constexpr uint32_t kFactorySettingMs = 2000;
// More automatic resets than this without a manual one are not made (ours).
constexpr int kAutoResets = 3;

namespace faults {
constexpr uint8_t kOvercurrent = 1, kDcLink = 7, kSpeedMonitoring = 8, kHeatSink = 11, kExternal = 26, kLimitSwitches = 27,
                  kFieldbus = 28, kTemperatureSensor = 31, kRs485 = 43, kSbus2 = 46, kSbus = 47,
                  kMotorOverload = 84;
}  // namespace faults

constexpr uint8_t fault_of(PoSource source) {
  switch (source) {
    case PoSource::Rs485: return faults::kRs485;
    case PoSource::Fieldbus: return faults::kFieldbus;
    case PoSource::Sbus2: return faults::kSbus2;
    case PoSource::Sbus: break;
  }
  return faults::kSbus;
}

// A ramp time is the time for a change of speed: by 3000 rpm on MOVIDRIVE (ours), by 50 Hz on MOVITRAC 07 (its manual,
// chapter 6.1) and the other MOVITRAC (ours).
MachineData machine_of(MachineData machine, const ParameterStore& parameters) {
  constexpr int32_t kOf50Hz = 3'000'000;
  if (parameters.unit().traits.has(Trait::RampsOf50Hz)) machine.ramp_reference = kOf50Hz / std::max(1, machine.pole_pairs);
  machine.real |= parameters.options().real_control;
  return machine;
}

bool is_reversing(int32_t setpoint) { return setpoint < 0; }

constexpr PoSource kAllSources[] = {PoSource::Rs485, PoSource::Fieldbus, PoSource::Sbus, PoSource::Sbus2};

// Whose words they are.
constexpr PoSource words_of(PoSource source) { return source == PoSource::Sbus2 ? PoSource::Sbus : source; }

}  // namespace

Drive::Drive(ParameterStore& parameters, const MachineData& machine)
    : parameters_(parameters),
      traits_(parameters.unit().traits),
      reader_(parameters),
      settings_(reader_.read(parameters)),
      settings_version_(parameters.changes()),
      state_(Axis(machine_of(machine, parameters))),
      least_dc_link_(state_.axis.machine().dc_link / 100 * kLowLinkPercent),
      shown_for_(settings_version_ - 1) {
  counting_words_ = find_counting_words();
  now_.set(&Situation::starting_up, starting_up());
  if (!parameters.options().mains) begin_without_mains();
  parameters.connect(*this);
}

void Drive::read_settings() const {
  settings_version_ = parameters_.changes();
  settings_ = reader_.read(parameters_);
  counting_words_ = find_counting_words();
}

// --- process data ---

void Drive::take_po(PoSource link, std::span<const uint16_t> words, bool cyclic) {
  const PoSource source = words_of(link);
  const auto with_words = [&](Words known) {
    std::copy_n(words.begin(), std::min(words.size(), kProcessWords), known.begin());
    return known;
  };
  now_.set(&Situation::shown_po, with_words(now_->shown_po));
  for (size_t n = kProcessWords; n < std::min(words.size(), kProcessWords + kFurtherWords); ++n)
    further_po_[n - kProcessWords] = words[n];
  const auto s = static_cast<size_t>(source);
  if (settings().po_enable != 1) {
    if (cyclic) take_request(link);  // the bus speaks, though nothing is taken over
    return;
  }
  if (const Words po = with_words(now_->po[s]); po != now_->po[s]) now_.change().po[s] = po;
  if (touched_watch(link).on_process_data(cyclic)) now_.change().faults.clear_cause(fault_of(link));
  note_heard();
  if (settings().control_bus != source) return;
  const uint16_t word = order_of(source).control_word.value_or(0);
  const bool reset_edge = (word & ~state_.last_control_word & control_bits::kReset) != 0;
  state_.last_control_word = word;
  if (reset_edge) reset_fault();
}

bool Drive::hear_again(PoSource link, std::span<const uint16_t> words) {
  LinkWatch& watch = state_.watches[static_cast<size_t>(link)];
  if (!watch.alert() || settings().po_enable != 1) return false;
  const PoSource source = words_of(link);
  const size_t first = std::min(words.size(), kProcessWords);
  const Words& known = now_->po[static_cast<size_t>(source)];
  for (size_t n = 0; n < first; ++n)
    if (words[n] != known[n] || words[n] != now_->shown_po[n]) return false;
  for (size_t n = kProcessWords; n < std::min(words.size(), kProcessWords + kFurtherWords); ++n)
    if (words[n] != further_po_[n - kProcessWords]) return false;
  if (settings().control_bus == source && order_of(source).control_word.value_or(0) != state_.last_control_word) return false;
  watch.on_request();
  return true;
}

void Drive::take_request(PoSource source) {
  if (touched_watch(source).on_request()) now_.change().faults.clear_cause(fault_of(source));
}

// As with the other monitoring, only of a bus that controls the drive.
void Drive::lose(PoSource source) {
  if (settings().control_bus != source && settings().setpoint_bus != source) return;
  touched_watch(source).report();
  raise_fault(fault_of(source));
}

// A telegram changes what is decided unless it only restarts the time of silence.
LinkWatch& Drive::touched_watch(PoSource source) {
  LinkWatch& watch = state_.watches[static_cast<size_t>(source)];
  if (!watch.alert()) now_.change();
  return watch;
}

void Drive::note_heard() {
  std::array<bool, kPoSources> heard{};
  for (size_t n = 0; n < kPoSources; ++n) heard[n] = state_.watches[n].seen();
  heard[static_cast<size_t>(PoSource::Sbus)] |= state_.watches[static_cast<size_t>(PoSource::Sbus2)].seen();
  now_.set(&Situation::heard, heard);
}

// --- who controls ---

// Decides again when anything has changed.
void Drive::look_around() const {
  now_.set(&Situation::settings, parameters_.changes());
  now_.set(&Situation::factory_setting, parameters_.factory_setting_running());
  now_.looked();
  if (!decisions_known_ || !(*now_ == decided_for_)) decide_anew();
}

// P876 and a source that is a bus (MDX60B/61B p. 93).
bool Drive::po_data_enabled() const {
  return settings().po_enable == 1 && (settings().setpoint_bus || settings().control_bus);
}

// Not asked while positioning controls: that looks after the limit switches itself, as a reference travel has to reach
// them.
Verdict Drive::verdict_with_setpoint(const Decisions& d) const {
  Verdict verdict = d.controls;
  if (state_.stopped_by_setpoint) verdict.restrict_to(Command::Stop, Block::StopFunction);
  if (verdict.command != Command::Enable) return verdict;
  if (d.terminals.off(InputFunction::LimitCw) && state_.setpoint.speed > 0)
    verdict.restrict_to(Command::EmergencyStop, Block::LimitCw);
  if (d.terminals.off(InputFunction::LimitCcw) && state_.setpoint.speed < 0)
    verdict.restrict_to(Command::EmergencyStop, Block::LimitCcw);
  return verdict;
}

// Without an inhibit terminal a standing drive is enough for R parameters (ours).
bool Drive::controller_inhibited() const {
  ControlInputs in = control_inputs(terminals());
  in.fault_stop = FaultStop::None;
  return decide(in).command == Command::Inhibit || (!traits_.has(Trait::InhibitTerminal) && !output_stage_on());
}

void Drive::set_position(int32_t counter) {
  state_.counter_shift +=
      static_cast<uint32_t>(counter) - static_cast<uint32_t>(state_.axis.state().position);
  state_.axis.set_position(counter);
}

int32_t Drive::shaft_position() const {
  return static_cast<int32_t>(static_cast<uint32_t>(state_.axis.position()) - state_.counter_shift);
}

// --- the shaft ---

void Drive::set_load_torque(int32_t torque) {
  if (torque == state_.load_torque) return;
  steady_left_ = 0;
  state_.load_torque = torque;
  order_load(order_);
}

void Drive::set_shaft_speed(int32_t speed) {
  if (speed == state_.shaft_speed) return;
  steady_left_ = 0;
  state_.shaft_speed = speed;
  order_load(order_);
}

void Drive::order_load(AxisOrder& order) const {
  constexpr double kNewtonMetre = 1e-4, kShare = 100'000;
  const double share = state_.load_torque * kNewtonMetre / rated_torque(state_.axis.machine()) * kShare;
  order.load_torque = static_cast<int32_t>(std::lround(std::clamp<double>(share, -kTopTorque, kTopTorque)));
  order.shaft_speed = state_.shaft_speed;
}

void Drive::set_mains(bool on) {
  if (on == now_->mains) return;
  steady_left_ = 0;
  now_.set(&Situation::mains, on);
  state_.axis.set_mains(on);
}

// A unit that is switched on by its 24 V alone.
void Drive::begin_without_mains() {
  now_.set(&Situation::mains, false);
  now_.set(&Situation::link_is_low, true);
  state_.axis.set_mains(false);
  state_.axis.empty_dc_link();
}

// The count of increments and what it has of the next one; like them it wraps after 2^31 increments.
int64_t Drive::shaft_angle() const {
  const double increments = shaft_position() + state_.axis.part_of_increment();
  return std::llround(increments * (2 * std::numbers::pi / 4096 * 1e6));
}

// --- faults ---

FaultResponse Drive::response_of(uint8_t number) const {
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  if (row == nullptr) return FaultResponse::ImmediateError;
  if (const stdlib::Parameter* parameter = stdlib::response_parameter(parameters_.table(), *row))
    return static_cast<FaultResponse>(parameters_.value(parameter->index));
  return responses_[number].value_or(stdlib::fixed_response(parameters_.unit(), *row));
}

bool Drive::set_fault_response(uint8_t number, FaultResponse response) {
  const stdlib::FaultRow* row = stdlib::find_fault(number);
  if (row == nullptr || row->parameter != stdlib::kByCommand) return false;
  responses_[number] = response;
  return true;
}

void Drive::raise_fault(uint8_t number) {
  if (!now_->faults.pending(number)) raise_fault(number, response_of(number));
}

// Warnings pass by themselves and do not fill the error memory (ours).
void Drive::raise_fault(uint8_t number, FaultResponse response) {
  if (now_.change().faults.raise(number, response) && is_error(response))
    remember_fault(parameters_, number, state_.axis.state().utilization);
}

void Drive::reset_fault() {
  state_.auto_resets = 0;
  clear_faults();
}

// After a reset the drive is safe until its bus speaks again (1053 1610 p. 27).
void Drive::clear_faults() {
  if (now_->faults.error()) {
    for (LinkWatch& link : state_.watches) link.forget();
    note_heard();
  }
  now_.change().faults.reset();
  ++state_.resets;
  state_.auto_reset_ms = 0;
}

void Drive::on_parameter_written(uint16_t index, int32_t value) {
  if (index == index::kManualReset && value == 1) reset_fault();
  if (index == index::kScopeControl && parameters_.table().find(index::kScopeControl) != nullptr)
    order_scope(value == 1);
}

// --- the millisecond ---

inline void Drive::take(const PositionControl& position) {
  state_.position = position;
  now_.set(&Situation::positioning, position.controls);
  now_.set(&Situation::halt, position.halt);
}

// --- the scope ---

void Drive::order_scope(bool start) {
  if (!start) return scope_.stop();
  const auto setting = [&](uint16_t index) { return static_cast<uint32_t>(parameters_.stored(index)); };
  Scope::Order order;
  order.every = setting(index::kScopeTime);
  order.edge = static_cast<Scope::Edge>(setting(index::kScopeTrigger));
  order.level = parameters_.stored(index::kScopeLevel);
  order.samples = setting(index::kScopeSamples);
  order.before = setting(index::kScopeBefore);
  scope_.start(order);
}

// What the last tick has left. A channel whose index shows nothing of the drive records 0.
void Drive::record() {
  if (!scope_.tick()) return;
  Scope::Sample sample{};
  for (uint16_t n = 0; n < Scope::kChannels; ++n)
    sample[n] = live_value(static_cast<uint16_t>(parameters_.stored(index::kScopeChannel + n))).value_or(0);
  scope_.take(sample);
}

// What follows from decisions is done once; faults, links and what the machine suffers need watching on.
void Drive::decide_and_watch() {
  if (scope_.runs()) record();
  decided();
  const bool anew = !applied_ || now_->faults.shown() != 0;
  if (anew) apply();
  if (watch_links() || anew || machine_suffers() || now_->link_is_low) {
    watch_machine();
    select_parameter_set();
  }
  if (counts_mains()) watch_mains();
  decided();
  const bool quiet = applied_ && now_->faults.shown() == 0 && !links_run() && !scope_.runs() && !now_->link_is_low && !counts_mains();
  quiet_for_ = quiet ? now_.changes() : now_.changes() - 1;
}

// Latches and edges; what that leads to is decided at once.
void Drive::apply() {
  applied_ = true;
  latch_three_wire();
  watch_resets();
  decided();
}

// The order of the axis, all but a speed that positioning gives it.
void Drive::choose_order() {
  if (state_.position.controls) {
    state_.stopped_by_setpoint = false;
    state_.setpoint.note = SetpointNote::None;
  } else {
    const SetpointNote note = state_.setpoint.note;
    state_.setpoint = next_setpoint(decisions_);
    if (state_.setpoint.note != note) now_.change();
  }
  const Verdict verdict = verdict_of(decisions_);
  if (verdict.reason != blocked_by_) now_.change();
  blocked_by_ = verdict.reason;
  if (order_for_ != verdict.command) {
    order_for_ = verdict.command;
    order_ = axis_order(verdict.command);
  }
  order_.target = set().change_direction == 1 ? -state_.setpoint.speed : state_.setpoint.speed;
  if (order_.command == AxisCommand::Torque)
    order_.current = set().change_direction == 1 ? -state_.setpoint.current : state_.setpoint.current;
}

inline void Drive::move() {
  // P350 does not turn positions round (ours).
  if (state_.position.controls)
    order_.target = state_.setpoint.speed = state_.setpoint.requested = state_.position.speed;
  state_.axis.step(order_);
  now_.set(&Situation::output_stage, state_.axis.output_stage());
  now_.set(&Situation::reversing, is_reversing(state_.axis.setpoint()));
}

bool Drive::links_run() const {
  return std::any_of(state_.watches.begin(), state_.watches.end(),
                     [](const LinkWatch& link) { return link.runs(); });
}

// Something of the axis is beyond where watch_machine() lets it be.
inline bool Drive::machine_suffers() const {
  const PowerSection& power = state_.axis.power();
  return power.dc_link() > kOvervoltage || power.dc_link() < least_dc_link_ || power.heat_sink() > kOvertemperature ||
         power.motor_utilization() >= kFullUtilization ||
         (state_.limited_ms != 0 && state_.limited_ms > set().speed_monitoring_delay);
}

void Drive::advance(Ticks ticks) {
  steady_left_ -= ticks;
  state_.advance(ticks);
}

void Drive::State::advance(Ticks ticks) {
  mains_ms += ticks;
  if (axis.phase() != AxisPhase::Off) enabled_ms += ticks;
  axis.advance(ticks);
  for (LinkWatch& link : watches) link.advance(ticks);
  outputs.advance(ticks);
}

// Up to a digit of P015, P016, P017, a telegram that is missed, and the end of a delay of the outputs. A limit
// that is, or will be, exceeded shows when it is.
Ticks Drive::State::bound() const {
  if (axis.heat_sink_ahead() > kOvertemperature || axis.motor_utilization_ahead() >= kFullUtilization)
    return 0;
  Ticks ticks = std::min({kMinuteMs - 1 - std::max(mains_ms, enabled_ms), axis.bound(), outputs.bound()});
  const int64_t energy = kEnergyDigit - 1 - (axis.state().energy - counted_energy);
  ticks = static_cast<Ticks>(std::min<int64_t>(ticks, std::max<int64_t>(energy, 0) / axis.energy_ahead()));
  for (const LinkWatch& link : watches) ticks = std::min(ticks, link.bound());
  return ticks;
}

// A position that is ordered again every millisecond is not steady: that is seen first.
Ticks Drive::steady_since(const Moment& before) const {
  if (!(before.state.position == state_.position) || !applied_ || scope_.runs() || now_.changed() ||
      now_->settings != parameters_.changes())
    return 0;
  return before.situation == *now_ ? steady_ticks(before.state, state_) : 0;
}

void Drive::count_minute(uint32_t& ms, uint16_t minutes) {
  ms = 0;
  parameters_.set_display(minutes, parameters_.value(minutes) + 1);
}

inline void Drive::count() {
  if (now_->starting_up) {
    ++state_.up_ms;
    now_.set(&Situation::starting_up, starting_up());
  }
  if (++state_.mains_ms >= kMinuteMs) count_minute(state_.mains_ms, index::kMainsOnTime);
  if (state_.axis.phase() != AxisPhase::Off && ++state_.enabled_ms >= kMinuteMs)
    count_minute(state_.enabled_ms, index::kEnabledTime);
  if (state_.axis.power().energy() - state_.counted_energy >= kEnergyDigit) {
    state_.counted_energy += kEnergyDigit;
    parameters_.set_display(index::kEnergy, parameters_.value(index::kEnergy) + 1);
  }
  if (counts_limited()) count_limited();
  if (parameters_.factory_setting_running() && ++state_.factory_setting_ms >= kFactorySettingMs) {
    state_.factory_setting_ms = 0;
    parameters_.finish_factory_setting();
  }
}

// P101 = 3-WIRE-CONTROL: a pulse on a direction input starts, ENABLE/STOP at 0 ends (ours; the list only
// names it).
void Drive::latch_three_wire() {
  const Terminals t = terminals();
  const bool cw = t.on(InputFunction::Cw);
  const bool ccw = t.on(InputFunction::Ccw);
  if (cw && !state_.cw_input) now_.change().three_wire_cw = true, now_.change().three_wire_ccw = false;
  if (ccw && !state_.ccw_input) now_.change().three_wire_ccw = true, now_.change().three_wire_cw = false;
  if (t.off(InputFunction::Enable)) now_.change().three_wire_cw = now_.change().three_wire_ccw = false;
  state_.cw_input = cw;
  state_.ccw_input = ccw;
}

void Drive::watch_resets() {
  const bool reset = decided().reset;
  if (reset && !state_.reset_input) reset_fault();
  state_.reset_input = reset;
  if (!now_->faults.error()) return;
  if (settings().auto_reset != 1 || state_.auto_resets >= kAutoResets) return;
  if (++state_.auto_reset_ms < settings().auto_reset_time) return;
  ++state_.auto_resets;
  clear_faults();
}

// True when a telegram was missed just now.
bool Drive::watch_links() {
  const auto& rules = decisions_.links;
  bool missed = false;
  for (const PoSource source : kAllSources) {
    const auto n = static_cast<size_t>(source);
    if (!state_.watches[n].tick(rules[n])) continue;
    if (source == PoSource::Rs485) ++state_.rs485_timeouts;
    raise_fault(fault_of(source));
    missed = true;
  }
  note_heard();
  return missed;
}

void Drive::watch_machine() {
  const Decisions& d = decided();
  const auto follow = [&](bool cause, uint8_t number) {
    if (cause)
      raise_fault(number);
    else if (now_->faults.pending(number))
      now_.change().faults.clear_cause(number);
  };
  follow(d.external_fault, faults::kExternal);
  follow(d.temperature_sensor, faults::kTemperatureSensor);
  if (d.both_limit_switches) raise_fault(faults::kLimitSwitches);

  const AxisState& axis = state_.axis.state();
  if (axis.dc_link > kOvervoltage) raise_fault(faults::kDcLink);
  now_.set(&Situation::link_is_low, axis.dc_link < least_dc_link_);
  if (axis.heat_sink > kOvertemperature) raise_fault(faults::kHeatSink);
  follow(set().motor_protection == 1 && axis.motor_utilization >= kFullUtilization, faults::kMotorOverload);
  if (state_.limited_ms > set().speed_monitoring_delay) raise_fault(faults::kSpeedMonitoring);
}

// P520 counts from where the input says that the mains are off; what P521 orders ends when it says that they are back.
void Drive::watch_mains() {
  const bool gone = decisions_.mains_gone;
  const bool stop = gone && ++state_.mains_off_ms > settings().mains_off_time;
  if (!gone || stop) state_.mains_off_ms = 0;
  now_.set(&Situation::mains_stop, stop);
}

// P500: 1 motor mode, 2 regenerative, 3 both (1053 1610 p. 77).
void Drive::count_limited() {
  if (state_.axis.overcurrent()) raise_fault(faults::kOvercurrent);
  const AxisState& axis = state_.axis.state();
  const int32_t mode = set().speed_monitoring;
  const bool regenerative = (axis.torque < 0) != (axis.speed < 0);
  const bool counts =
      axis.current_limited && (mode == 3 || (mode == 1 && !regenerative) || (mode == 2 && regenerative));
  state_.limited_ms = counts ? state_.limited_ms + 1 : 0;
}

// The set changes only while the output stage is off (ours).
void Drive::select_parameter_set() {
  if (output_stage_on() || !traits_.has(Trait::ParameterSets)) return;
  now_.set(&Situation::second_set, decided().parameter_switch);
}

[[gnu::always_inline]] inline OutputInputs Drive::shown() const {
  const Axis& axis = state_.axis;
  const auto flag = [](bool on, uint32_t bit) { return on ? bit : 0; };
  OutputInputs in;
  in.flags = decisions_.output_flags | flag(axis.output_stage(), output_flags::kOutputStage) |
             flag(axis.brake_released(), output_flags::kBrakeReleased) |
             flag(axis.standing(), output_flags::kStandstill) |
             flag(axis.power().motor_utilization() >= kFullUtilization, decisions_.overload_flag) |
             flag(state_.position.in_position, output_flags::kInPosition) |
             flag(state_.position.referenced, output_flags::kReferenced) | state_.position.output_flags;
  in.speed = axis.speed();
  // Compared with the setpoint before the ramp, so that P420 tells when it is reached (ours); positioning orders one
  // without a ramp.
  const bool has_setpoint = order_.command == AxisCommand::Run || order_.command == AxisCommand::Follow;
  in.setpoint = has_setpoint ? order_.target : 0;
  in.current = axis.output_current();
  in.current_limit = order_.current_limit;
  in.limited = axis.power().gives_all();
  in.ipos_outputs = state_.ipos_outputs;
  return in;
}

inline void Drive::show() {
  if (shown_for_ != settings_version_ || !state_.outputs.go_on(shown())) show_anew();
}

void Drive::show_anew() {
  shown_for_ = settings_version_;
  state_.outputs.tick(settings_, shown());
}

void Drive::tick(const PositionControl& position) {
  steady_left_ = 0;
  take(position);
  count();
  const bool same =
      quiet_for_ == now_.changes() && now_->settings == parameters_.changes() && !machine_suffers();
  if (!same) decide_and_watch();
  if (!same || !position.controls) choose_order();
  move();
  show();
}

// tick() would find nothing to decide, to count or to watch but what Following asks in each millisecond. What the last one has shown
// holds: of all that it shows only orders of the program can have changed since.
bool Drive::can_follow(const PositionControl& position) const {
  const Axis& axis = state_.axis;
  const bool quiet = quiet_for_ == now_.changes() && now_->settings == parameters_.changes() &&
                     shown_for_ == settings_version_ && !now_->starting_up && !parameters_.factory_setting_running();
  if (!quiet || !position.controls || axis.standing() || now_->output_stage != axis.output_stage() ||
      !Axis::Following::possible(axis, order_))
    return false;
  PositionControl last = state_.position;
  last.speed = position.speed;
  return last == position && state_.outputs.holds_ipos_outputs(state_.ipos_outputs) && state_.outputs.holds_deviation(0) &&
         axis.power().energy() - state_.counted_energy < kEnergyDigit && (!counts_limited() || may_count_limited());
}

Ticks Drive::following_ticks(const PositionControl& position, Ticks most) const {
  if (!can_follow(position)) return 0;
  const Ticks ticks = std::min({most, kMinuteMs - 1 - std::max(state_.mains_ms, state_.enabled_ms), state_.outputs.bound()});
  const PowerSection& power = state_.axis.power();
  const bool healthy = power.dc_link() <= kOvervoltage && power.dc_link() >= least_dc_link_;
  const bool cool = power.heat_sink_within(ticks) <= kOvertemperature && power.motor_utilization_within(ticks) < kFullUtilization;
  return healthy && cool ? ticks : 0;
}

void Drive::power_cycle() {
  state_.up_ms = 0;
  const bool mains = now_->mains;
  Situation first;
  first.inputs = now_->inputs;
  first.analog = now_->analog;
  first.starting_up = starting_up();
  now_.change() = first;
  forget_decisions();
  for (LinkWatch& link : state_.watches) link.forget();
  state_.last_control_word = 0;
  state_.ipos_pi = {};
  further_po_ = further_pi_ = {};
  state_.ipos_outputs = 0;

  responses_ = {};
  state_.reset_input = false;
  state_.auto_reset_ms = state_.auto_resets = state_.limited_ms = state_.mains_off_ms = 0;

  state_.cw_input = state_.ccw_input = state_.stopped_by_setpoint = false;
  if (settings().keep_motor_pot != 1) state_.motor_pot = {};
  state_.pi_controller = {};
  state_.pi_actual = 0;
  state_.ai1_filter = {};
  state_.setpoint = {};

  state_.position = {};
  state_.counter_shift = 0U - static_cast<uint32_t>(shaft_position());  // the shaft stays where it is
  state_.axis.reset();
  if (!mains) begin_without_mains();
  state_.outputs = {};
  shown_for_ = settings_version_ - 1;
  state_.factory_setting_ms = state_.mains_ms = state_.enabled_ms = 0;
  state_.counted_energy = 0;
  scope_ = {};
}

}  // namespace ipos::runtime
