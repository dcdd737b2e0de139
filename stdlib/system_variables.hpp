// System variables as data, from system_variables.def.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>

namespace ipos::stdlib {

enum class VariableAccess : uint8_t { R, RW };
enum class VariableUnits : uint8_t { A, B };  // A: all units with IPOS, B: those with Trait::NewVariables

enum class VariableUse : uint8_t { Nothing, Follows, Shows, Moves, Counts };  // see the table

struct SystemVariable {
  uint16_t number;
  std::string_view compiler_name;
  std::string_view assembler_name;
  VariableAccess access;
  VariableUnits units;
  VariableUse use;
  std::string_view source;
  std::string_view meaning;
};

// In rising order of the numbers.
std::span<const SystemVariable> system_variables();

// By number, or by compiler or assembler name as written; nullptr when there is none.
const SystemVariable* find_system_variable(uint16_t number);
const SystemVariable* find_system_variable(std::string_view name);

// Number and use alone, for what is chosen when the program is compiled.
struct UsedVariable {
  uint16_t number;
  VariableUse use;
};
inline constexpr UsedVariable kUsedVariables[] = {
#define SYSTEM_VARIABLE(number, compiler_name, assembler_name, access, units, use, source, meaning) \
  {number, VariableUse::use},
#include "stdlib/system_variables.def"
};
inline constexpr size_t kFirstSystemVariable = std::begin(kUsedVariables)->number;
inline constexpr size_t kLastSystemVariable = std::rbegin(kUsedVariables)->number;

// Is never defined: a constant that calls it does not compile.
size_t no_such_system_variable();

// The number of a compiler name, for code that serves one variable; a name that does not exist does not
// compile.
consteval size_t system_variable(std::string_view compiler_name) {
  struct Row {
    size_t number;
    std::string_view name;
  };
  constexpr Row kRows[] = {
#define SYSTEM_VARIABLE(number, compiler_name, assembler_name, access, units, use, source, meaning) \
  {number, compiler_name},
#include "stdlib/system_variables.def"
  };
  for (const Row& row : kRows)
    if (row.name == compiler_name) return row.number;
  return no_such_system_variable();
}

}  // namespace ipos::stdlib
