// System variables from their table.
#include "stdlib/system_variables.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

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

// Every plant asks for each name of its programs.
const SystemVariable* find_system_variable(std::string_view name) {
  using Named = std::pair<std::string_view, const SystemVariable*>;
  static const std::array<Named, 2 * std::size(kVariables)> names = [] {
    std::array<Named, 2 * std::size(kVariables)> all;
    auto at = all.begin();
    for (const SystemVariable& variable : kVariables) {
      *at++ = {variable.compiler_name, &variable};
      *at++ = {variable.assembler_name, &variable};
    }
    std::sort(all.begin(), all.end());
    return all;
  }();
  const auto at = std::lower_bound(names.begin(), names.end(), name, [](const Named& row, std::string_view wanted) { return row.first < wanted; });
  return at != names.end() && at->first == name ? at->second : nullptr;
}

}  // namespace ipos::stdlib
