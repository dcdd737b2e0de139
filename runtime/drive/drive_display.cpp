// What the drive shows: unit condition, status words, process input data and display values.
#include "runtime/drive/drive.hpp"

#include <algorithm>

#include "runtime/drive/indices.hpp"

namespace ipos::runtime {

using stdlib::Trait;

namespace {

// Part number of P076, as in the example of both lists (1053 1610 p. 69, MOVITRAC 07 chapter 10.3); that it
// is the one of every unit is ours.
constexpr int32_t kFirmwarePart = 822'609'700;
constexpr int32_t kIn = 100'000;  // 100 % of IN

}  // namespace

std::string_view condition_text(UnitCondition condition) {
  switch (condition) {
#define UNIT_CONDITION(code, name, text) \
  case UnitCondition::name: return text;
#include "stdlib/unit_conditions.def"
  }
  return {};
}

// Operating modes of P700 (1053 1610 p. 80): VFC drives show 4, a speed control 5, a torque control 6.
UnitCondition Drive::enabled_condition() const {
  if (!traits_.has(Trait::ShowsOperatingMode)) return UnitCondition::Enable;
  const int32_t mode = set().operating_mode;
  constexpr int32_t kVfcSpeedControl = 5;
  if (is_torque_control(mode)) return UnitCondition::TorqueControl;
  return mode >= kVfcSpeedControl && !now_->second_set ? UnitCondition::SpeedControl : UnitCondition::Enable;
}

UnitCondition Drive::read_condition() const {
  if (starting_up() || now_->link_is_low) return UnitCondition::NotReady;
  if (parameters_.factory_setting_running()) return UnitCondition::FactorySetting;
  if (now_->faults.error()) return UnitCondition::NotReady;
  const Verdict now = verdict();
  switch (now.command) {
    case Command::Inhibit: return UnitCondition::ControllerInhibit;
    case Command::Enable: return enabled_condition();
    case Command::HoldControl: return UnitCondition::HoldControl;
    case Command::EmergencyStop:
    case Command::RapidStop:
    case Command::Stop: break;
  }
  if (now.reason == Block::LimitCw || now.reason == Block::LimitCcw) return UnitCondition::LimitSwitch;
  if (decided().waiting && traits_.has(Trait::ShowsWaiting) && decided().enabled_locally) return UnitCondition::Waiting;
  if (standing() && output_stage() && set().standstill_current > 0)
    return UnitCondition::StandstillCurrent;
  return UnitCondition::NoEnable;
}

char Drive::display() const {
  if (now_->faults.shown() != 0) return 'F';
  const UnitCondition now = condition();
  return now == UnitCondition::Waiting ? 't' : static_cast<char>('0' + static_cast<int>(now));
}

uint8_t Drive::status_block() const {
  const Terminals& t = terminals();
  unsigned block = 0;
  if (output_stage_on()) block |= 1U << 0;
  if (ready()) block |= 1U << 1;
  if (po_data_enabled()) block |= 1U << 2;
  if (now_->faults.shown() != 0) block |= 1U << 5;
  if (traits_.has(Trait::RampSets) &&
      (function_on(t, InputFunction::RampSwitch) ||
       (control_order().control_word.value_or(0) & control_bits::kRampSet) != 0))
    block |= 1U << 3;
  if (now_->second_set) block |= 1U << 4;
  if (!traits_.has(Trait::LimitSwitches)) return static_cast<uint8_t>(block);
  if (t.off(InputFunction::LimitCw)) block |= 1U << 6;  // low-active
  if (t.off(InputFunction::LimitCcw)) block |= 1U << 7;
  return static_cast<uint8_t>(block);
}

void Drive::tell_anew() const {
  const UnitCondition now = told_.condition = read_condition();
  uint8_t high = static_cast<uint8_t>(now);
  if (now == UnitCondition::FactorySetting && traits_.has(Trait::FactorySettingIs5)) high = 5;
  if (now_->faults.shown() != 0) high = now_->faults.shown();
  told_.status_word_1 = static_cast<uint16_t>((high << 8) | status_block());
}

uint16_t Drive::status_word_2() const {
  return static_cast<uint16_t>((state_.outputs.levels() & 0xFF00U) | status_word_3());
}

Drive::Words Drive::pi() const {
  Words words{};
  for (size_t n = 0; n < kProcessWords; ++n) words[n] = pi_word(n);
  return words;
}

uint16_t Drive::find_counting_words() const {
  const bool noisy = state_.axis.machine().noise != 0;
  unsigned words = 0;
  for (size_t n = 0; n < kProcessWords; ++n) {
    const auto assignment = static_cast<PiAssignment>(settings_.pi[n]);
    const bool position = assignment == PiAssignment::PositionLow || assignment == PiAssignment::PositionHigh;
    const bool measured = assignment == PiAssignment::Speed || assignment == PiAssignment::RelativeSpeed ||
                          assignment == PiAssignment::OutputCurrent || assignment == PiAssignment::ActiveCurrent;
    if (position || (noisy && measured)) words |= 1U << n;
  }
  return static_cast<uint16_t>(words);
}

// Only a current needs axis(), which is computed when somebody asks.
uint16_t Drive::pi_word(size_t n) const {
  switch (static_cast<PiAssignment>(settings().pi[n])) {
    case PiAssignment::None: return 0;
    case PiAssignment::Speed: return word_of_speed(shown_speed());
    case PiAssignment::RelativeSpeed: return relative_of_speed(shown_speed(), set().maximum_speed);
    case PiAssignment::OutputCurrent: return word_of_current(noisy(axis().output_current, kIn, Noise::Current));
    case PiAssignment::ActiveCurrent: return word_of_current(noisy(axis().active_current, kIn, Noise::ActiveCurrent));
    case PiAssignment::PositionLow: return static_cast<uint16_t>(position() & 0xFFFF);
    case PiAssignment::PositionHigh: return static_cast<uint16_t>(static_cast<uint32_t>(position()) >> 16);
    case PiAssignment::StatusWord1: return status_word_1();
    case PiAssignment::StatusWord2: return status_word_2();
    case PiAssignment::StatusWord3: return status_word_3();
    case PiAssignment::IposData: return state_.ipos_pi[n];
    case PiAssignment::PiActual:  // 10 is RESERVED on MOVIDRIVE
      return traits_.has(Trait::PiController) ? relative_of_speed(state_.pi_actual, 100'000) : 0;
  }
  return 0;
}

// That the program of the master fills PO3 by _SetSys(SS_PIDATA, ...) is ours: MDX60B/61B p. 29 only leaves
// the word to IPOS.
// Of torque and load share no manual read says more than the names (ours): TORQUE is the current that a master in
// M-CONTROL is told, of any other master the active current that it needs; LOAD SHARE is always the latter, so that
// with P751 a slave bears its part of what the master bears.
Drive::Words Drive::master_words(SlaveSetpoint what) const {
  const Command command = verdict().command;
  const uint16_t control = command == Command::Enable      ? control_bits::kEnable
                           : command == Command::Inhibit   ? control_bits::kInhibit
                           : command == Command::RapidStop ? control_bits::kStop
                                                           : control_bits::kRapidStop;
  const AxisState& axis = state_.axis.state();
  const bool told = what == SlaveSetpoint::Torque && order_.command == AxisCommand::Torque;
  const uint16_t setpoint = what == SlaveSetpoint::Speed ? word_of_speed(axis.setpoint)
                                                         : word_of_current(told ? order_.current : axis.active_current);
  return {control, setpoint, state_.ipos_pi[2]};
}

AnalogLevel Drive::analog_output(size_t output, int32_t ipos) const {
  const Settings& s = settings();
  const AnalogOutputSettings chosen = output == 0 ? AnalogOutputSettings{s.ao1_function, s.ao1_scaling, s.ao1_mode}
                                                  : AnalogOutputSettings{s.ao2_function, s.ao2_scaling, s.ao2_mode};
  return analog_level(chosen, state_.axis.state(), order_.target, ipos);
}

// Evenly spread, a hash of the seed, the millisecond and the kind.
int32_t Drive::with_noise(int32_t value, int32_t whole, Noise kind) const {
  const MachineData& machine = state_.axis.machine();
  uint64_t hash = (uint64_t{machine.noise_seed} << 32 | state_.mains_ms << 2 | static_cast<uint32_t>(kind)) +
                  static_cast<uint64_t>(parameters_.value(index::kMainsOnTime)) * 0x9E3779B97F4A7C15U;
  for (const int shift : {30, 27, 31}) hash = (hash ^ hash >> shift) * 0xBF58476D1CE4E5B9U;
  const auto share = static_cast<int64_t>(hash >> 44) - (1 << 19);  // of 2^19
  const int64_t most = int64_t{whole} * machine.noise / 100'000;
  return static_cast<int32_t>(std::clamp<int64_t>(value + (most * share >> 19), INT32_MIN, INT32_MAX));
}

// P000 x P850 / P851 (1053 1610 p. 68, 81), as far as 32 bits go.
int32_t Drive::user_display() const {
  const int64_t value = int64_t{shown_speed()} * settings().user_numerator / settings().user_denominator;
  return static_cast<int32_t>(std::clamp<int64_t>(value, INT32_MIN, INT32_MAX));
}

std::optional<int32_t> Drive::scope_value(uint16_t index) const {
  switch (index) {
    case index::kScopeControl: return scope_.runs() ? 1 : 0;
    case index::kScopeState: return static_cast<int32_t>(scope_.state());
    case index::kScopeRecorded: return static_cast<int32_t>(scope_.recorded());
    case index::kScopeValue: {
      const auto position = static_cast<uint32_t>(parameters_.stored(index::kScopePosition));
      const uint32_t sample = position % Scope::kMostSamples;
      return sample < scope_.recorded() ? scope_.value(position / Scope::kMostSamples, sample) : 0;
    }
    default: return std::nullopt;
  }
}

std::optional<int32_t> Drive::live_value(uint16_t index) const {
  if (traits_.has(Trait::OwnParameterNumbers))
    return index == index::kM31Position ? std::optional(state_.axis.state().position) : std::nullopt;
  if (index >= index::kScopeControl && index <= index::kScopeValue) return scope_value(index);
  if (index >= index::kPoShown && index < index::kPoShown + kProcessWords)
    return now_->shown_po[index - index::kPoShown];
  if (index >= index::kPiShown && index < index::kPiShown + kProcessWords)
    return pi_word(index - index::kPiShown);
  // The firmware of a slave sets the assignments (MDX60B/61B p. 29).
  if (is_master_slave(settings())) {
    if (index >= index::kPo1Description && index < index::kPo1Description + kProcessWords)
      return settings().po[index - index::kPo1Description];
    if (index >= index::kPi1Description && index < index::kPi1Description + kProcessWords)
      return settings().pi[index - index::kPi1Description];
  }
  // Those of every trace come first: what warms and counts is not computed for them.
  if (index == index::kSpeed) return shown_speed();
  if (index == index::kStatus) return status_word_1();
  const AxisState& axis = state_.axis.state();
  switch (index) {
    case index::kFrequency: return axis.frequency;
    case index::kActualPosition: return axis.position;
    case index::kOutputCurrent: return noisy(axis.output_current, kIn, Noise::Current);
    case index::kOutputCurrentAmpere:
      return static_cast<int32_t>(int64_t{noisy(axis.output_current, kIn, Noise::Current)} * state_.axis.machine().unit_current / 100'000);
    case index::kRatedCurrent: return state_.axis.machine().unit_current;
    case index::kUnitType: return parameters_.options().type_code;
    case index::kFirmware: return kFirmwarePart + parameters_.options().firmware;
    case index::kActiveCurrent: return noisy(axis.active_current, kIn, Noise::ActiveCurrent);
    case index::kMotorUtilization1: return now_->second_set ? 0 : axis.motor_utilization;
    case index::kMotorUtilization2: return now_->second_set ? axis.motor_utilization : 0;
    case index::kDcLink: return axis.dc_link;
    case index::kHeatSink: return axis.heat_sink;
    case index::kAnalogInput1: return now_->analog.ai1.millivolt;
    case index::kAnalogInput2: return now_->analog.ai2.millivolt;
    case index::kExternalLimit: return share_of_ai2(set().current_limit);
    case index::kUserDisplay: return user_display();
    case index::kInputs: return now_->inputs & (traits_.has(Trait::InhibitTerminal) ? 0x3F : 0x3E);  // else no DI00
    case index::kOptionInputs: return now_->inputs >> 8;
    case index::kOutputs: return state_.outputs.levels() & (traits_.has(Trait::BrakeOutput) ? 0x07 : 0x06);
    case index::kOptionOutputs: return state_.outputs.levels() >> 8;
    default: return std::nullopt;
  }
}

}  // namespace ipos::runtime
