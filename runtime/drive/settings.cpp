// Settings from the parameter table; what a unit lacks is taken from a neighbour.
#include "runtime/drive/settings.hpp"

#include <map>
#include <mutex>
#include <span>

#include "runtime/drive/indices.hpp"
#include "runtime/drive/process_data.hpp"
#include "runtime/drive/terminals.hpp"

namespace ipos::runtime {
namespace {

using stdlib::Trait;

// The input without a parameter: DI00, or DI01 (MOVITRAC 07, chapter 10.3 begins with P601).
constexpr size_t kInhibitInput = 0, kCwInput = 1;

// The firmware of a slave in master/slave operation sets the assignments (MDX60B/61B p. 29). On the older
// units the order of the words in the group telegram is the same (MS-07).
constexpr std::array<uint8_t, kProcessWords> kSlavePo = {static_cast<uint8_t>(PoAssignment::ControlWord1),
                                                         static_cast<uint8_t>(PoAssignment::Speed),
                                                         static_cast<uint8_t>(PoAssignment::IposData)};
constexpr std::array<uint8_t, kProcessWords> kSlavePi = {static_cast<uint8_t>(PiAssignment::StatusWord1),
                                                         static_cast<uint8_t>(PiAssignment::Speed),
                                                         static_cast<uint8_t>(PiAssignment::IposData)};

void fill(int32_t& value, int32_t neighbour) {
  if (value == kAbsent) value = neighbour;
}

void fill_set(ParameterSet& set) {
  fill(set.ramp_up_ccw, set.ramp_up_cw);
  fill(set.ramp_down_ccw, set.ramp_down_cw);
  fill(set.ramp_second, set.ramp_up_cw);
  fill(set.emergency_ramp, set.stop_ramp);
}

// MOVITRAC 31: either the terminals control it or the fieldbus does, control word and setpoints together (MOVITRAC 31
// PROFIBUS, 2.9). The three words are those of its chapter 3.1.4. T11 up is also the ramp down, and there is no
// minimum speed (ours).
Settings read_m31(const ParameterStore& parameters) {
  constexpr int32_t kMsADigit = 10;
  constexpr std::array<InputFunction, 4> kFunctions = {InputFunction::None, InputFunction::Enable,
                                                       InputFunction::Ccw, InputFunction::Reset};
  Settings settings;
  if (parameters.stored(index::kM31ControlMode) == 1) {
    settings.setpoint_source = stdlib::code(stdlib::SetpointSource::Fieldbus);
    settings.control_source = stdlib::code(stdlib::ControlSource::Fieldbus);
  }
  settings.setpoint_bus = setpoint_bus(settings);
  settings.control_bus = control_bus(settings);
  fill(settings.motor_pot_down, settings.motor_pot_up);
  const int32_t ramp = kMsADigit * parameters.stored(index::kM31RampUp);
  for (ParameterSet& set : settings.sets) {
    set.ramp_up_cw = set.ramp_down_cw = set.ramp_up_ccw = set.ramp_down_ccw = ramp;
    set.minimum_speed = 0;
    fill_set(set);
    fill(set.brake_application, settings.braking_time);
  }
  settings.po = {static_cast<uint8_t>(PoAssignment::ControlWord1), static_cast<uint8_t>(PoAssignment::Speed),
                 static_cast<uint8_t>(PoAssignment::Ramp)};
  settings.pi = {static_cast<uint8_t>(PiAssignment::StatusWord1), static_cast<uint8_t>(PiAssignment::Speed),
                 static_cast<uint8_t>(PiAssignment::OutputCurrent)};
  settings.inputs[0] = static_cast<uint8_t>(InputFunction::Cw);  // terminal 41
  const auto function = [&](uint16_t index) {
    return static_cast<uint8_t>(kFunctions[static_cast<size_t>(parameters.stored(index))]);
  };
  settings.inputs[1] = function(index::kM31Terminal42);
  settings.inputs[2] = function(index::kM31Terminal43);
  return settings;
}

}  // namespace

// Where each setting stands is looked up once a list of parameters: a plant has many drives, and a campaign many plants.
SettingsReader::SettingsReader(const ParameterStore& parameters)
    : traits_(parameters.unit().traits) {
  if (traits_.has(Trait::OwnParameterNumbers)) return;
  struct Known {
    std::vector<Cell> cells;
    std::vector<SetCell> set_cells;
  };
  static std::mutex mutex;
  static std::map<const stdlib::ParameterTable*, Known> all;
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = all.try_emplace(&parameters.table());
  Known& known = entry->second;
  const auto slot_of = [&](std::string_view number) -> std::optional<size_t> {
    const stdlib::Parameter* row = parameters.table().find(number);
    return row == nullptr || row->index == 0 ? std::nullopt : parameters.slot_of(row->index);
  };
  if (is_new) {
#define SETTING(name, number, absent) \
  if (const auto slot = slot_of(number)) known.cells.push_back({&Settings::name, *slot});
#define SET_SETTING(name, first, second, absent) \
  if (const auto slot = slot_of(first))          \
    known.set_cells.push_back({&ParameterSet::name, {*slot, slot_of(second).value_or(*slot)}});
#include "runtime/drive/settings.def"
  }
  cells_ = known.cells;
  set_cells_ = known.set_cells;
}

Settings SettingsReader::read(const ParameterStore& parameters) const {
  if (traits_.has(Trait::OwnParameterNumbers)) return read_m31(parameters);
  Settings settings;
  for (const Cell& cell : cells_) settings.*cell.member = parameters.stored_in(cell.slot);
  for (const SetCell& cell : set_cells_)
    for (size_t n = 0; n < 2; ++n) settings.sets[n].*cell.member = parameters.stored_in(cell.slots[n]);
  for (ParameterSet& set : settings.sets) {
    fill_set(set);
    fill(set.brake_application, settings.braking_time);
  }
  fill(settings.motor_pot_down, settings.motor_pot_up);

  const auto function = [&](uint32_t index) {
    return static_cast<uint8_t>(parameters.stored(static_cast<uint16_t>(index)));
  };
  for (uint32_t n = 0; n < kProcessWords; ++n) {
    settings.po[n] = function(index::kPo1Description + n);
    settings.pi[n] = function(index::kPi1Description + n);
  }
  settings.setpoint_bus = setpoint_bus(settings);
  settings.control_bus = control_bus(settings);
  if (is_master_slave(settings)) {
    settings.po = kSlavePo;
    if (is_torque_control(settings.sets[0].operating_mode))
      settings.po[1] = static_cast<uint8_t>(PoAssignment::Current);
    settings.pi = kSlavePi;
  }
  const auto read_terminals = [&](std::span<uint8_t> terminals, uint32_t first) {
    for (uint8_t& terminal : terminals) terminal = function(first++);
  };
  read_terminals(std::span(settings.inputs).subspan(1, 5), index::kInputFunction + 1);
  read_terminals(std::span(settings.inputs).last(8), index::kOptionInputFunction);
  read_terminals(std::span(settings.outputs).subspan(1, 2), index::kOutputFunction);
  read_terminals(std::span(settings.outputs).last(8), index::kOptionOutputFunction);
  if (traits_.has(Trait::InhibitTerminal))
    settings.inputs[kInhibitInput] = static_cast<uint8_t>(InputFunction::ControllerInhibit);
  else
    settings.inputs[kCwInput] = static_cast<uint8_t>(InputFunction::Cw);
  return settings;
}

}  // namespace ipos::runtime
