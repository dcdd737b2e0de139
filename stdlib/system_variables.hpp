// System variables as data, from system_variables.def.
#pragma once

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

}  // namespace ipos::stdlib
