// System variables as data, from system_variables.def.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace ipos::stdlib {

enum class VariableAccess : uint8_t { R, RW };
enum class VariableUnits : uint8_t { A, B };  // A: all units with IPOS, B: MOVIDRIVE B only

struct SystemVariable {
  uint16_t number;
  std::string_view compiler_name;
  std::string_view assembler_name;
  VariableAccess access;
  VariableUnits units;
  std::string_view source;
  std::string_view meaning;
};

// In rising order of the numbers.
std::span<const SystemVariable> system_variables();

// By number, or by compiler or assembler name as written; nullptr when there is none.
const SystemVariable* find_system_variable(uint16_t number);
const SystemVariable* find_system_variable(std::string_view name);

// The number of a compiler name, for code that serves one variable; a name that does not exist does not
// compile.
consteval size_t system_variable(std::string_view compiler_name) {
  struct Row {
    size_t number;
    std::string_view name;
  };
  constexpr Row kRows[] = {
#define SYSTEM_VARIABLE(number, compiler_name, assembler_name, access, units, source, meaning) \
  {number, compiler_name},
#include "stdlib/system_variables.def"
  };
  for (const Row& row : kRows)
    if (row.name == compiler_name) return row.number;
  throw "no such system variable";  // not reached at run time: this function runs in the compiler only
}

}  // namespace ipos::stdlib
