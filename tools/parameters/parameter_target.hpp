// What a name on the command line means in a unit: a parameter, a variable or an index.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "stdlib/index_areas.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::tools {

struct Target {
  uint16_t index;
  const stdlib::Parameter* parameter;  // nullptr for variables, program words and curve points
};

// "P130", "130", an index such as 8470, or "H20"; anything else is a Failure.
Target find_target(const stdlib::UnitType& unit, const std::string& name);

// Digits alone, with a sign where the type has one.
template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Access as in the manuals: "N/R/RW", "RO".
std::string access_text(const stdlib::Parameter& parameter);

std::string text_of(const Target& target, int32_t value);
// "P130 Ramp t11 UP CW"; a view has its own name.
std::string name_of(const stdlib::ParameterTable& table, const Target& target);

}  // namespace ipos::tools
