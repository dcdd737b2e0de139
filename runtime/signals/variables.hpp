// The one reading of names of variables: what the tools print is what they take. A name is a symbol
// ("lCount"), a member or an element ("TrCycl.ObjectNo", "y[0].b[1]"), a whole of several variables
// ("TrCycl", "y", "y[0].b"), a number ("H420") or a system variable ("ActPos_Mot").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/station/station.hpp"
#include "stdlib/unit_types.hpp"
#include "vm/image/image.hpp"

namespace ipos::signals {

struct NamedVariable {
  std::string name;    // of this one: "y[0].b[1]"
  std::string symbol;  // it is (an element of); empty for numbers and system variables
  uint32_t number = 0;
};

// All variables a name stands for, in rising order of symbols; none when the unit has no such name.
std::vector<NamedVariable> named_variables(std::span<const vm::Symbol> symbols, const stdlib::UnitType& unit,
                                           std::string_view name);

// The number of the first of them.
std::optional<uint32_t> find_variable(const runtime::Station& station, std::string_view name);

// Those of one symbol: itself, or the elements of an array.
std::vector<NamedVariable> elements_of(const vm::Symbol& symbol);

}  // namespace ipos::signals
