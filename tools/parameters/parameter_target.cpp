// Names to indices, and values to text.
#include "tools/parameters/parameter_target.hpp"

#include <fmt/format.h>

#include "tools/cli/failure.hpp"

namespace ipos::tools {

Target find_target(const stdlib::UnitType& unit, const std::string& name) {
  if (const stdlib::Parameter* parameter = stdlib::parameter_table(unit).find(name)) {
    if (parameter->index == 0)
      throw Failure(kBadInput, fmt::format("P{} {} is a keypad setting without index", parameter->number,
                                           parameter->name));
    return {parameter->index, parameter};
  }
  if (name.starts_with('H'))
    if (const auto variable = whole_number<uint16_t>(std::string_view(name).substr(1));
        variable && *variable < unit.variables)
      return {static_cast<uint16_t>(stdlib::kFirstVariables + *variable), nullptr};
  if (const auto index = whole_number<uint16_t>(name); index && *index > 999) return {*index, nullptr};
  throw Failure(kBadInput,
                fmt::format("unit {} has no parameter '{}'; write P130, an index such as 8470, or H20",
                            unit.name, name));
}

std::string access_text(const stdlib::Parameter& p) {
  std::string text;
  for (const auto& [has, word] :
       {std::pair{p.nonvolatile, "N/"}, {p.writable_locked, "S/"}, {p.needs_inhibit, "R/"}})
    if (has) text += word;
  return text + (p.writable ? "RW" : "RO");
}

std::string text_of(const Target& target, int32_t value) {
  return target.parameter ? stdlib::parameter_text(*target.parameter, value) : std::to_string(value);
}

std::string name_of(const stdlib::ParameterTable& table, const Target& target) {
  if (target.parameter == nullptr || target.parameter->number.empty())
    return stdlib::index_name(table, target.index);
  return fmt::format("P{} {}", target.parameter->number, target.parameter->name);
}

}  // namespace ipos::tools
