// System variables from their table.
#include "stdlib/system_variables.hpp"

namespace ipos::stdlib {
namespace {

constexpr SystemVariable kVariables[] = {
#define SYSTEM_VARIABLE(number, compiler_name, assembler_name, access, units, source, meaning) \
  {number, compiler_name, assembler_name, VariableAccess::access, VariableUnits::units, source, meaning},
#include "stdlib/system_variables.def"
};

}  // namespace

std::span<const SystemVariable> system_variables() { return kVariables; }

const SystemVariable* find_system_variable(uint16_t number) {
  for (const SystemVariable& variable : kVariables)
    if (variable.number == number) return &variable;
  return nullptr;
}

const SystemVariable* find_system_variable(std::string_view name) {
  for (const SystemVariable& variable : kVariables)
    if (variable.compiler_name == name || variable.assembler_name == name) return &variable;
  return nullptr;
}

}  // namespace ipos::stdlib
