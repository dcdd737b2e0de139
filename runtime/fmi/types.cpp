// Types by the form in which a signal is shown.
#include "runtime/fmi/types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/fmi/names.hpp"
#include "runtime/signals/shape.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::fmi {
namespace {

using signals::Group;
using signals::Signal;

constexpr int32_t kFaults = 256;  // of one byte

// These displays are no units of measure.
bool has_unit(const Signal& signal) {
  return !signal.unit.empty() && signal.unit != "ascii" && signal.unit != "firmware";
}

bool is_fault(const Signal& signal) {
  return (signal.group == Group::Drive || signal.group == Group::State) &&
         (signal.own_name() == "fault" || signal.own_name() == "drive.fault");
}

bool is_task_state(const Signal& signal) {
  return signal.group == Group::Task && signal.own_name().ends_with(".state");
}

// What changes in small steps, and may be interpolated by who connects it.
bool is_continuous(const Signal& signal) {
  if (signal.group == Group::Analog) return true;
  if (signal.group != Group::Drive) return false;
  std::string_view name = signal.own_name();
  if (name.starts_with("drive.")) name.remove_prefix(6);
  return name == "torque" || name == "load_torque" || name == "shaft_speed" || name == "shaft_angle";
}

std::optional<std::pair<int64_t, int64_t>> range_of(const Signal& signal) {
  if (signal.group == Group::Analog)
    for (const runtime::AnalogKind& kind : runtime::analog_kinds())
      if (runtime::line_of(kind) == signal.number)
        return std::pair(std::llround(kind.minimum * kind.factor), std::llround(kind.maximum * kind.factor));
  if (signal.parameter == nullptr) return std::nullopt;
  const std::pair range(signal.parameter->minimum(), signal.parameter->maximum());
  if (range.first <= INT32_MIN && range.second >= INT32_MAX) return std::nullopt;
  return range;
}

// What all values are called; a text that several values have gets the number behind it.
std::vector<std::pair<int32_t, std::string>> items_of(const Signal& signal) {
  std::map<int32_t, std::string> texts;
  if (is_fault(signal))
    for (int32_t number = 0; number < kFaults; ++number) texts[number] = fmt::format("F{:02}", number);
  for (const auto& [value, text] : signals::shape_of(signal).texts) texts[static_cast<int32_t>(value)] = text;
  std::set<std::string> known;
  std::vector<std::pair<int32_t, std::string>> items;
  for (const auto& [value, text] : texts) {
    const bool is_new = !text.empty() && known.insert(text).second;
    items.emplace_back(value, is_new ? text : fmt::format("{} ({})", text, value));
  }
  return items;
}

}  // namespace

void Types::use_unit(Variable& variable, const runtime::PhysicalUnit& unit) {
  variable.unit = unit.name;
  if (units_.insert(unit.name).second) out_.units.push_back(unit);
}

void Types::make_real(Variable& variable) {
  variable.type = Type::Real;
  const signals::OwnNumber own = signals::own_number(variable.signal);
  variable.per_sample = own.per_sample;
  use_unit(variable, own.unit.value_or(*signals::find_physical_unit("1")));
}

bool Types::make_enumeration(Variable& variable) {
  const Signal& signal = variable.signal;
  std::string name;
  if (is_fault(signal)) {
    name = "Fault";
  } else if (is_task_state(signal)) {
    name = "TaskState";
  } else if (signal.parameter != nullptr && signal.parameter->ranges.empty() && !signal.parameter->texts.empty()) {
    name = fmt::format("{}_P{}", signal.owner->config().unit->name, signal.parameter->number);
  } else {
    return false;
  }
  const auto known = enumerations_.find(name);
  const bool is_new = known == enumerations_.end();
  std::vector<std::pair<int32_t, std::string>> made;
  if (is_new) made = items_of(signal);
  const auto& items = is_new ? made : out_.enumerations[known->second].items;
  const int64_t now = signal.read();
  if (std::none_of(items.begin(), items.end(), [now](const auto& item) { return item.first == now; })) return false;
  variable.type = Type::Enumeration;
  variable.enumeration = is_new ? out_.enumerations.size() : known->second;
  if (is_new) {
    enumerations_.emplace(name, out_.enumerations.size());
    out_.enumerations.push_back({name, std::move(made)});
  }
  return true;
}

void Types::add(const Signal& signal, Causality causality) {
  Variable variable;
  variable.name = structured_name(signal.station, signal.name);
  variable.description = signal.meaning;
  variable.causality = causality;
  variable.signal = signal;
  if (signal.bits == 1) {
    variable.type = Type::Boolean;
  } else if (!make_enumeration(variable)) {
    const bool is_long = signal.parameter != nullptr && signal.parameter->is_unsigned();
    if (has_unit(signal) || signal.factor != 1 || is_long)
      make_real(variable);
    else
      variable.type = Type::Integer;
    variable.range = range_of(signal);
    const int64_t now = signal.read();
    if (variable.range && (now < variable.range->first || now > variable.range->second)) variable.range.reset();
  }
  variable.is_continuous = variable.type == Type::Real && is_continuous(signal);
  out_.all.push_back(std::move(variable));
}

}  // namespace ipos::fmi
