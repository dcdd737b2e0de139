// What assembler and disassembler share of the text form: which operand is the label, and quoted names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "vm/isa/isa.hpp"

namespace ipos::compiler {

// Number of the label operand of a command; -1 when it has none.
int label_position(vm::Opcode opcode);

// The address in the label operand.
std::optional<uint32_t> label_operand(const vm::Instruction& command);

// A name as a directive takes it: bare when it has only letters, digits and _ . [ ] @, else in quotes. Inside
// quotes a backslash stands before a quote or backslash, and begins \xNN for a byte that is no printable
// ASCII.
std::string in_quotes(std::string_view name);
bool is_bare(char c);

}  // namespace ipos::compiler
