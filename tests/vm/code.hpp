// Writes programs for VM tests as lists of commands.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vm/isa/isa.hpp"

namespace ipos::tests {

// One command: I(Opcode::AddHK, 0, 1) is ADD H0 + 1. Labels are word addresses.
inline vm::Instruction I(vm::Opcode opcode, int32_t a = 0, int32_t b = 0, int32_t c = 0, int32_t d = 0) {
  return {opcode, {a, b, c, d}};
}

inline std::vector<uint32_t> code_of(const std::vector<vm::Instruction>& commands) {
  std::vector<uint32_t> code;
  for (const vm::Instruction& command : commands) {
    std::array<uint32_t, vm::kMaxWords> words{};
    const uint32_t count = vm::encode(command, words);
    code.insert(code.end(), words.begin(), words.begin() + count);
  }
  return code;
}

}  // namespace ipos::tests
