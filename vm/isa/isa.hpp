// The instruction set as tables with texts, for everything that shows or reads commands: assembler,
// disassembler, documentation. Built from opcodes.def and keywords.def at compile time; no heap, no OS. What
// the machine needs of them is in coding.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "vm/isa/coding.hpp"

namespace ipos::vm {

// One operand of a command; keyword_set is the name of the set in keywords.def.
struct OperandInfo {
  OperandKind kind = OperandKind::None;
  std::string_view keyword_set;
};

struct OpcodeInfo {
  Opcode opcode;
  std::string_view name;  // C++ name
  std::string_view text;  // assembler template, see opcodes.def
  Flow flow;
  std::string_view meaning;
  std::array<OperandInfo, kMaxOperands> operands;
  int operand_count;
  int words;  // length of the command in code words, 1..4

  constexpr std::string_view mnemonic() const { return text.substr(0, text.find(' ')); }
};

struct KeywordInfo {
  std::string_view set;
  int32_t value;
  std::string_view text;      // assembler
  std::string_view constant;  // compiler, defined in stdlib/include/const.h
};

// All rows, in the order of the table.
std::span<const OpcodeInfo> opcode_table();
std::span<const KeywordInfo> keyword_table();

// The row of an opcode byte, or nullptr when no command has this code.
const OpcodeInfo* find_opcode(uint32_t code);

// The row of a valid opcode.
const OpcodeInfo& info(Opcode opcode);

// A row of a keyword set by value or by assembler text, or nullptr.
const KeywordInfo* find_keyword(std::string_view set, int32_t value);
const KeywordInfo* find_keyword(std::string_view set, std::string_view text);

}  // namespace ipos::vm
