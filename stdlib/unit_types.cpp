// Unit types from their table.
#include "stdlib/unit_types.hpp"

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

}  // namespace ipos::stdlib
