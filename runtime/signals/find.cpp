// What a station has, group by group, and which of it a name means.
#include "runtime/signals/find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "runtime/signals/collector.hpp"
#include "runtime/signals/drive_values.hpp"
#include "runtime/signals/states.hpp"
#include "runtime/signals/variables.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

void add_unit(Collector& out) {
  add_drive_values(out);
  add_states_beside_drive(out);
  add_inputs(out);
  add_outputs(out);
  add_analog(out);
  add_words(out);
  add_tasks(out);
  add_system_variables(out);
}

void add_all(Collector& out) {
  add_symbols(out);
  add_unit(out);
}

// What the program calls so: a variable, a member, or all that a structure or an array has.
std::vector<NamedVariable> own_variables(const Station& station, std::string_view name) {
  std::vector<NamedVariable> found = named_variables(station.symbols(), *station.config().unit, name);
  if (!found.empty() && found.front().symbol.empty()) found.clear();  // by number or a system variable
  return found;
}

// Whether a pattern can mean what begins with the letter and a number.
bool can_mean(std::string_view pattern, char letter) {
  if (pattern.empty() || pattern[0] != letter) return false;
  return pattern.size() > 1 && (is_pattern(pattern.substr(1, 1)) || (pattern[1] >= '0' && pattern[1] <= '9'));
}

// "PO1", "PI3": one of so many words.
bool is_word(std::string_view name, size_t most) {
  size_t number = 0;
  const auto [end, error] = std::from_chars(name.data() + std::min<size_t>(2, name.size()), name.data() + name.size(), number);
  return (name.starts_with("PO") || name.starts_with("PI")) && error == std::errc() && end == name.data() + name.size() &&
         number >= 1 && number <= most && name[2] != '0';
}

// In the order of the groups; a bus is no station's.
constexpr void (*kAdders[])(Collector&) = {add_drive_values, add_states, add_inputs,  add_outputs,          add_analog,    add_words,
                                           add_tasks,        add_symbols, add_system_variables, add_parameters};

}  // namespace

std::vector<Signal> station_signals(Owner owner) {
  Collector all(owner);
  add_all(all);
  return std::move(all.found);
}

std::vector<Signal> find_station_signals(Owner owner, std::string_view name) {
  const Station& station = owner.station;
  Collector own(owner);
  for (const NamedVariable& variable : own_variables(station, name))
    own.add_variable(Group::Variable, variable.name, variable.number,
                     fmt::format("H{}", variable.number));
  if (!own.found.empty() && !name.starts_with(kUnitPrefix)) return std::move(own.found);
  Collector unit(owner);
  add_unit(unit);
  const std::string_view of_unit = name.starts_with(kUnitPrefix) ? name.substr(kUnitPrefix.size()) : name;
  const std::string full = fmt::format("{}.{}", station.config().name, of_unit);
  for (Signal& signal : unit.found)
    if (signal.name == full) {
      signal.name = fmt::format("{}.{}", station.config().name, name);
      return {std::move(signal)};
    }
  if (!own.found.empty()) return std::move(own.found);  // a structure of the program that is called "drive"
  Collector more(owner);
  const bool may_be_parameter =
      name.starts_with('P') || name.find_first_not_of("0123456789") == std::string_view::npos;
  if (const auto* row = may_be_parameter ? find_parameter(*station.config().unit, name) : nullptr) {
    more.add_parameter(*row, Group::Parameter, name);
    return std::move(more.found);
  }
  for (const NamedVariable& variable : named_variables(station.symbols(), *station.config().unit, name))
    more.add_variable(Group::Variable, variable.name, variable.number,
                      fmt::format("H{}", variable.number));
  if (!more.found.empty()) return std::move(more.found);
  const size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  size_t bit = 0;
  const auto [end, status] = std::from_chars(name.data() + dot + 1, name.data() + name.size(), bit);
  if (status != std::errc() || end != name.data() + name.size()) return {};
  const auto whole = find_station_signals(owner, name.substr(0, dot));
  if (whole.size() != 1 || bit >= bit_count(whole[0])) return {};
  return {bit_of(whole[0], bit)};
}

std::vector<Signal> default_signals(Owner owner) {
  std::vector<Signal> found;
  for (const std::string_view name : {"speed", "setpoint", "status"}) {
    const bool hidden = !own_variables(owner.station, name).empty();
    for (Signal& signal :
         find_station_signals(owner, hidden ? std::string(kUnitPrefix).append(name) : std::string(name)))
      found.push_back(std::move(signal));
  }
  return found;
}

bool is_unit_value(const stdlib::UnitType& unit, std::string_view name) {
  // Of the switches every unit has one.
  if (const StationSwitchType* turned = find_switch(name); turned != nullptr && turned->which == StationSwitch::Mains) return true;
  const auto is_called = [name](const AnalogKind& kind) { return kind.signal == name; };
  return is_word(name, kProcessWords) || has_drive_value(unit, name) || find_state(name) >= 0 || parse_input(name) >= 0 ||
         parse_output(name) >= 0 || std::any_of(analog_kinds().begin(), analog_kinds().end(), is_called) ||
         (unit.variables != 0 && stdlib::find_system_variable(name) != nullptr);
}

std::vector<std::string> hidden_names(const Station& station) {
  const size_t words = station.has_further_words() ? kProcessWords + kFurtherWords : kProcessWords;
  std::vector<std::string> hidden;
  for (const vm::Symbol& symbol : station.symbols())
    if (is_unit_value(*station.config().unit, symbol.name) || is_word(symbol.name, words)) hidden.push_back(symbol.name);
  return hidden;
}

std::vector<Signal> signals_of(Owner owner, Group group) {
  Collector out(owner);
  if (group != Group::Bus) kAdders[static_cast<size_t>(group)](out);
  return std::move(out.found);
}

std::optional<Signal> find_in_group(Owner owner, Group group, std::string_view name) {
  if (group == Group::Variable || group == Group::SystemVariable) {
    const auto number = find_variable(owner.station, name);
    if (!number) return std::nullopt;
    Collector out(owner);
    return out.add_variable(Group::Variable, name, *number, fmt::format("H{}", *number));
  }
  if (group == Group::Parameter) {
    const bool may_be = name.starts_with('P') || name.find_first_not_of("0123456789") == std::string_view::npos;
    const auto* row = may_be ? find_parameter(*owner.station.config().unit, name) : nullptr;
    if (row == nullptr) return std::nullopt;
    Collector out(owner);
    return out.add_parameter(*row, Group::Parameter, name);
  }
  if (group == Group::State) return state_signal(owner, name);
  for (Signal& signal : signals_of(owner, group))
    if (signal.own_name() == name) return std::move(signal);
  return std::nullopt;
}

std::optional<Signal> signal_at(Owner owner, Group group, uint32_t number) {
  const stdlib::UnitType& unit = *owner.station.config().unit;
  if (group == Group::Variable)
    return number < unit.variables ? find_in_group(owner, group, fmt::format("H{}", number)) : std::nullopt;
  if (group == Group::Parameter) {
    const auto* row = number == 0 || number > UINT16_MAX
                          ? nullptr
                          : stdlib::parameter_table(unit).find(static_cast<uint16_t>(number));
    if (row == nullptr) return std::nullopt;
    Collector out(owner);
    return out.add_parameter(*row, group, fmt::format("P{}", row->number));
  }
  for (Signal& signal : signals_of(owner, group))
    if (signal.number == number) return std::move(signal);
  return std::nullopt;
}

std::vector<Signal> match_station_signals(Owner owner, std::string_view pattern) {
  const Station& station = owner.station;
  Collector all(owner);
  add_all(all);
  if (can_mean(pattern, 'P'))
    for (const stdlib::Parameter& row : stdlib::parameter_table(*station.config().unit).rows())
      if (row.index != 0 && !row.number.empty())
        all.add_parameter(row, Group::Parameter, fmt::format("P{}", row.number));
  if (can_mean(pattern, 'H'))
    for (uint32_t n = 0; n < station.config().unit->variables; ++n)
      all.add_variable(Group::Variable, fmt::format("H{}", n), n, "");
  const size_t own = station.config().name.size() + 1;
  const size_t dot = pattern.rfind('.');
  std::vector<Signal> found;
  for (Signal& signal : all.found) {
    const std::string_view name = std::string_view(signal.name).substr(own);
    if (dot != std::string_view::npos && matches(pattern.substr(0, dot), name))
      for (size_t bit = 0; bit < bit_count(signal); ++bit)
        if (matches(pattern.substr(dot + 1), fmt::format("{}", bit))) found.push_back(bit_of(signal, bit));
    if (matches(pattern, name)) found.push_back(std::move(signal));
  }
  return found;
}

std::string station_signal_names(const Station& station) {
  std::vector<std::string> names = drive_value_names(station);
  if (find_parameter(*station.config().unit, "000") != nullptr) names.emplace_back("parameters as P000");
  names.emplace_back("inputs as DI00 and AI1");
  names.emplace_back("outputs as DO01");
  names.emplace_back("process data as PO1 and PI1");
  names.emplace_back("bits as PO1.6");
  names.push_back("states as " + state_names());
  if (station.image() != nullptr) names.emplace_back("tasks as task1.line");
  if (station.has_variables())
    names.push_back(fmt::format("variables H0 to H{}", station.config().unit->variables - 1));
  for (const vm::Symbol& symbol : station.symbols()) names.push_back(symbol.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace ipos::signals
