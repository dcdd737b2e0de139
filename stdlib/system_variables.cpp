// System variables from their table.
#include "stdlib/system_variables.hpp"

#include <algorithm>
#include <iterator>

namespace ipos::stdlib {
namespace {

constexpr SystemVariable kVariables[] = {
#define SYSTEM_VARIABLE(number, compiler_name, assembler_name, access, units, use, source, meaning) \
  {number,           compiler_name, assembler_name, VariableAccess::access, VariableUnits::units,   \
   VariableUse::use, source,        meaning},
#include "stdlib/system_variables.def"
};

constexpr bool in_front(const SystemVariable& a, const SystemVariable& b) { return a.number < b.number; }
static_assert(std::is_sorted(std::begin(kVariables), std::end(kVariables), in_front));

}  // namespace

std::span<const SystemVariable> system_variables() { return kVariables; }

const SystemVariable* find_system_variable(uint16_t number) {
  const auto* const at =
      std::lower_bound(std::begin(kVariables), std::end(kVariables), number,
                       [](const SystemVariable& row, uint16_t wanted) { return row.number < wanted; });
  return at != std::end(kVariables) && at->number == number ? at : nullptr;
}

const SystemVariable* find_system_variable(std::string_view name) {
  for (const SystemVariable& variable : kVariables)
    if (variable.compiler_name == name || variable.assembler_name == name) return &variable;
  return nullptr;
}

}  // namespace ipos::stdlib
