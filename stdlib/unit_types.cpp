// Unit types from their table.
#include "stdlib/unit_types.hpp"

#include <algorithm>

namespace ipos::stdlib {
namespace {

constexpr UnitType kUnits[] = {
#define UNIT(code, name, title, variables, parameter_words, program_words, tasks, call_depth, fast, slow, \
             receive, generation)                                                                         \
  {code,  #name,      title, variables, parameter_words, program_words,                                   \
   tasks, call_depth, fast,  slow,      receive,         Generation::generation},
#include "stdlib/unit_types.def"
};

}  // namespace

std::span<const UnitType> unit_types() { return kUnits; }

const UnitType* find_unit(std::string_view name) {
  for (const UnitType& unit : kUnits)
    if (unit.name == name) return &unit;
  return nullptr;
}

const UnitType* find_unit(uint8_t code) {
  for (const UnitType& unit : kUnits)
    if (unit.code == code) return &unit;
  return nullptr;
}

bool among_units(std::string_view names, const UnitType& unit) {
  if (names.empty()) return true;
  while (!names.empty()) {
    const size_t end = std::min(names.find(' '), names.size());
    if (names.substr(0, end) == unit.name) return true;
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return false;
}

}  // namespace ipos::stdlib
