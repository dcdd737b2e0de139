// What a command does with variables, and whether it can fault, from the columns of the opcode table. What
// the host does for a system command is left aside.
#pragma once

#include <cstdint>

#include "vm/isa/coding.hpp"

namespace ipos::vm {

struct VariableRange {
  uint32_t first = 0;
  uint32_t count = 0;

  uint32_t end() const { return first + count; }
  bool has(uint32_t variable) const { return variable >= first && variable < end(); }
};

// What it writes by name; nothing where it finds the variable when it runs (Writes::Indexed).
inline VariableRange named_target(const Instruction& command) {
  const auto operand = [&](size_t n) { return static_cast<uint32_t>(command.operands[n]); };
  switch (coding(command.opcode).writes) {
    case Writes::First: return {operand(0), 1};
    case Writes::Block: return {operand(0), operand(2)};
    case Writes::None:
    case Writes::Indexed: break;
  }
  return {};
}

// use(range) for all variables it reads or writes by name.
template <class Use>
void each_named(const Instruction& command, Use use) {
  const Coding& row = coding(command.opcode);
  const bool block = row.reads == Reads::Block;
  for (size_t n = 0; n < row.operand_count; ++n)
    if (row.kinds[n] == OperandKind::Variable)
      use(VariableRange{static_cast<uint32_t>(command.operands[n]),
                        block ? static_cast<uint32_t>(command.operands[2]) : 1U});
}

// Its second operand is a constant.
inline bool has_constant(const Instruction& command) {
  return coding(command.opcode).kinds[1] == OperandKind::Constant;
}

// Whatever the variables are.
inline bool always_faults(const Instruction& command) {
  return coding(command.opcode).faults == Faults::Zero && has_constant(command) && command.operands[1] == 0;
}

// With some values of the variables; Host included.
inline bool can_fault(const Instruction& command) {
  const Faults faults = coding(command.opcode).faults;
  if (faults == Faults::Zero && has_constant(command)) return command.operands[1] == 0;
  return faults != Faults::Never;
}

}  // namespace ipos::vm
