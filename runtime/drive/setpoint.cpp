// Sources, sums and limits of the speed setpoint.
#include "runtime/drive/setpoint.hpp"

#include <algorithm>
#include <cstdlib>

#include "stdlib/unit_text.hpp"

namespace ipos::runtime {
namespace {

constexpr std::string_view kNoteTexts[] = {
#define SETPOINT_NOTE(name, text) text,
#include "runtime/drive/setpoint_notes.def"
};

constexpr int32_t kFullVoltage = 10'000;        // mV
constexpr int32_t kFullCurrent = 20'000;        // uA
constexpr int32_t kLiveZero = 4'000;            // uA
constexpr int32_t kReferenceSpeed = 3'000'000;  // P112 = 0: 10 V mean 3000 rpm
constexpr int32_t kPercent = 100'000;           // 100 % in 1/1000 %
constexpr int32_t kThousand = 1000;

int32_t scale(int64_t value, int64_t by, int64_t whole) {
  return static_cast<int32_t>(std::clamp<int64_t>(whole == 0 ? 0 : value * by / whole, INT32_MIN, INT32_MAX));
}

int32_t add(int32_t a, int32_t b) {
  return static_cast<int32_t>(std::clamp<int64_t>(int64_t{a} + b, INT32_MIN, INT32_MAX));
}

SetpointSource source_of(const Settings& settings, bool slave_free_run) {
  const auto source = static_cast<SetpointSource>(settings.setpoint_source);
  const bool master = source == SetpointSource::MasterSbus || source == SetpointSource::MasterRs485;
  return master && slave_free_run ? SetpointSource::Bipolar : source;
}

bool is_bus(SetpointSource source) {
  switch (source) {
    case SetpointSource::Rs485:
    case SetpointSource::Fieldbus:
    case SetpointSource::MasterSbus:
    case SetpointSource::MasterRs485:
    case SetpointSource::Sbus: return true;
    default: return false;
  }
}

int32_t fixed_setpoint(const ParameterSet& set, int which) {
  return which == 1 ? set.n1 : which == 2 ? set.n2 : which == 3 ? set.n3 : 0;
}

// Table 3 of the MOVITRAC 07 manual: which setpoints get the built-in potentiometer added.
bool adds_potentiometer(const Settings& settings, const SetpointInputs& in, SetpointSource source,
                        bool fixed) {
  constexpr int32_t kOff = 0;
  constexpr int32_t kExceptFixed = 2;
  if (settings.potentiometer_added == kOff) return false;
  if (source == SetpointSource::FixedPlusAi1 || source == SetpointSource::FixedTimesAi1) return false;
  if (fixed) return in.fixed_plus_potentiometer && settings.potentiometer_added != kExceptFixed;
  return source != SetpointSource::MotorPot;
}

// What is wrong with the word of a bus that is the source; None where it counts.
SetpointNote bus_note(const SetpointInputs& in, bool word, SetpointNote missing) {
  if (!in.po_enabled) return SetpointNote::PoDisabled;
  if (!word) return missing;
  return in.bus_accepted ? SetpointNote::None : SetpointNote::NoBusData;
}

// M-CONTROL. A source that is no bus gives a speed, whose share of the maximum speed is the share of the current
// limit (ours: no manual read has a scale for it). P301 and the skip window are of speeds.
Setpoint select_current(const Settings& settings, const ParameterSet& set, const ParameterSet& other,
                        SetpointInputs in) {
  Setpoint setpoint;
  int32_t current = 0;
  if (is_bus(source_of(settings, in.slave_free_run))) {
    setpoint.note = bus_note(in, in.bus_current.has_value(), SetpointNote::NoCurrentWord);
    if (setpoint.note == SetpointNote::None) current = *in.bus_current;
  } else {
    in.torque_control = false;
    const Setpoint speed = select_setpoint(settings, set, other, in);
    current = scale(speed.requested, set.current_limit, set.maximum_speed);
  }
  setpoint.current = std::clamp(current, -set.current_limit, set.current_limit);
  return setpoint;
}

}  // namespace

std::string setpoint_note_text(SetpointNote note, const stdlib::UnitType& unit) {
  return stdlib::unit_text(unit, kNoteTexts[static_cast<size_t>(note)]);
}

bool sign_decides(const Settings& settings, bool slave_free_run) {
  return is_bus(source_of(settings, slave_free_run));
}

// Modes 2 to 4 of MOVIDRIVE are only named in the list; the characteristic is ours: a straight line from
// (P113, P114) to (10 V, maximum speed), of which mode 2 has the voltage offset, mode 3 the speed offset and
// mode 4 both.
int32_t ai1_speed(const Settings& settings, const ParameterSet& set, const AnalogInputs& analog) {
  const int32_t maximum = set.maximum_speed;
  const int32_t voltage = analog.ai1.millivolt + settings.ai1_offset;
  const int32_t current = analog.ai1.microampere;
  const auto line = [&](int32_t from_voltage, int32_t from_speed) {
    return add(from_speed, scale(voltage - from_voltage, maximum - from_speed, kFullVoltage - from_voltage));
  };
  int32_t speed = 0;
  switch (settings.ai1_mode) {
    case 0: speed = scale(voltage, kReferenceSpeed, kFullVoltage); break;
    case 2: speed = line(settings.ai1_voltage_offset, 0); break;
    case 3: speed = line(0, settings.ai1_speed_offset); break;
    case 4: speed = line(settings.ai1_voltage_offset, settings.ai1_speed_offset); break;
    case 5: speed = scale(current, maximum, kFullCurrent); break;
    case 6: speed = scale(std::max(current - kLiveZero, 0), maximum, kFullCurrent - kLiveZero); break;
    default: speed = scale(voltage, maximum, kFullVoltage); break;
  }
  return scale(speed, settings.ai1_scale, kThousand);
}

// P253 and P254 share their indices with P112 and P110.
int32_t pi_actual_value(const Settings& settings, const AnalogInputs& analog) {
  int32_t value = 0;
  switch (settings.ai1_mode) {
    case 5: value = scale(analog.ai1.microampere, kPercent, kFullCurrent); break;
    case 6:
      value = scale(std::max(analog.ai1.microampere - kLiveZero, 0), kPercent, kFullCurrent - kLiveZero);
      break;
    default: value = scale(analog.ai1.millivolt, kPercent, kFullVoltage); break;
  }
  return scale(value, settings.ai1_scale, kThousand);
}

int32_t potentiometer_speed(const Settings& settings, const ParameterSet& set, int32_t position) {
  constexpr int32_t kCcw = 1;
  constexpr int32_t kBipolar = 2;
  if (settings.potentiometer_mode == kBipolar)
    return scale(2 * int64_t{position} - kThousand, set.maximum_speed, kThousand);
  const int32_t speed = scale(position, set.maximum_speed, kThousand);
  return settings.potentiometer_mode == kCcw ? -speed : speed;
}

int32_t limit_setpoint(const ParameterSet& set, int32_t speed, int32_t maximum) {
  const int64_t magnitude =
      std::clamp<int64_t>(std::abs(int64_t{speed}), std::min(set.minimum_speed, maximum), maximum);
  return static_cast<int32_t>(speed < 0 ? -magnitude : magnitude);
}

int32_t leave_skip_window(const ParameterSet& set, int32_t speed, int32_t maximum) {
  const int64_t magnitude = std::abs(int64_t{speed});
  const int64_t low = set.skip_center - set.skip_width / 2;
  const int64_t high = set.skip_center + set.skip_width / 2;
  if (magnitude <= low || magnitude >= high) return speed;
  const bool upwards = high <= maximum && (magnitude >= set.skip_center || low < set.minimum_speed);
  const auto edge = static_cast<int32_t>(std::max<int64_t>(upwards ? high : low, 0));
  return speed < 0 ? -edge : edge;
}

Setpoint select_setpoint(const Settings& settings, const ParameterSet& set, const ParameterSet& other,
                         const SetpointInputs& in) {
  if (in.torque_control) return select_current(settings, set, other, in);
  const SetpointSource source = source_of(settings, in.slave_free_run);
  const int32_t fixed = fixed_setpoint(in.other_set ? other : set, in.fixed);
  bool fixed_used = false;
  bool ccw = !is_bus(source) && in.ccw;
  Setpoint setpoint;

  if (in.pi_output) {
    setpoint.speed = scale(*in.pi_output, set.maximum_speed, kPercent);
  } else if (is_bus(source)) {
    setpoint.note = bus_note(in, in.bus_speed.has_value(), SetpointNote::NoBusWord);
    if (setpoint.note == SetpointNote::None) setpoint.speed = *in.bus_speed;
    if (in.fixed != 0 && setpoint.note == SetpointNote::None) setpoint.note = SetpointNote::FixedIgnored;
  } else if (source == SetpointSource::FixedPlusAi1) {
    setpoint.speed = add(fixed, in.ai1_speed);
  } else if (source == SetpointSource::FixedTimesAi1) {
    // 10 V are 100 %, whatever speed P112 makes of them.
    setpoint.speed = scale(fixed, in.ai1_speed, settings.ai1_mode == 0 ? kReferenceSpeed : set.maximum_speed);
  } else if (in.fixed != 0) {
    setpoint.speed = fixed;
    fixed_used = true;
  } else if (source == SetpointSource::MotorPot || source == SetpointSource::MotorPotPlusAi1) {
    setpoint.speed = in.motor_pot;
    ccw = ccw || in.motor_pot_ccw;
    if (source == SetpointSource::MotorPotPlusAi1) setpoint.speed = add(setpoint.speed, in.ai1_speed);
  } else if (source == SetpointSource::Frequency) {
    setpoint.speed = scale(in.analog.frequency, set.maximum_speed, int64_t{settings.frequency_scale} * 10);
  } else {
    setpoint.speed = in.ai1_speed;
    constexpr int32_t kAi2IsSetpoint = 1;
    if (settings.ai2_mode == kAi2IsSetpoint)
      setpoint.speed = add(setpoint.speed, scale(in.analog.ai2.millivolt, set.maximum_speed, kFullVoltage));
    if (source == SetpointSource::Unipolar && in.unipolar_is_amount) setpoint.speed = std::abs(setpoint.speed);
  }
  if (!in.pi_output && adds_potentiometer(settings, in, source, fixed_used))
    setpoint.speed = add(setpoint.speed, potentiometer_speed(settings, set, in.analog.potentiometer));
  if (!is_bus(source) && in.sent_speed != 0 && setpoint.note == SetpointNote::None)
    setpoint.note = SetpointNote::BusWordIgnored;

  const int32_t maximum =
      in.maximum_speed ? std::clamp(*in.maximum_speed, 0, set.maximum_speed) : set.maximum_speed;
  // The limits are for the amount; the direction comes after them, so that P301 acts in it, too.
  const int direction = ccw ? -1 : 1;
  const int32_t limited = limit_setpoint(set, setpoint.speed, maximum);
  setpoint.requested = direction * setpoint.speed;
  if (setpoint.note == SetpointNote::None && limited != setpoint.speed)
    setpoint.note = std::abs(int64_t{limited}) < std::abs(int64_t{setpoint.speed}) ? SetpointNote::Maximum
                                                                                   : SetpointNote::Minimum;
  const int32_t passed = leave_skip_window(set, limited, maximum);
  if (passed != limited) setpoint.note = SetpointNote::Skipped;
  setpoint.speed = direction * passed;
  return setpoint;
}

}  // namespace ipos::runtime
