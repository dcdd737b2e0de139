// The instruction set as data: opcodes, their text forms and operands, and the coding of a command in 32-bit
// code words. Built from opcodes.def and keywords.def at compile time; no heap, no OS.
//
// Coding (ours): word 0 holds the opcode in bits 0..7 and the first two small operands (variable, bit, count,
// keyword) in bits 8..19 and 20..31. A third and fourth small operand stand in an extension word, bits 0..15
// and 16..31. Then constants and labels follow, a word each. Unused bits are 0.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace ipos::vm {

enum class Opcode : uint8_t {
#define OPCODE(code, name, text, flow, meaning) name = code,
#include "vm/isa/opcodes.def"
};

enum class Flow : uint8_t { Next, Jump, Branch, Call, Return, End, System, SystemCall };

enum class OperandKind : uint8_t { None, Variable, Bit, Count, Keyword, Constant, Label };

// One operand of a command; keyword_set is the name of the set in keywords.def.
struct OperandInfo {
  OperandKind kind = OperandKind::None;
  std::string_view keyword_set;
};

inline constexpr int kMaxOperands = 4;

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

// One decoded command. operands stand in the order of the text form; labels are word addresses.
struct Instruction {
  Opcode opcode = Opcode::Nop;
  std::array<int32_t, kMaxOperands> operands{};

  bool operator==(const Instruction&) const = default;
};

enum class DecodeStatus : uint8_t { Ok, UnknownOpcode, Truncated, ReservedBits };

struct Decoded {
  DecodeStatus status;
  Instruction instruction;
  uint32_t words;  // length when status is Ok
};

// Decodes the command at word address. Checks the coding only; what operands may be is the verifier's part.
Decoded decode(std::span<const uint32_t> code, uint32_t address);

// Writes the command and returns the number of words used (1..4). Small operands must fit: 0..4095 for the
// first two, 0..65535 for the others.
inline constexpr int kMaxWords = 4;
uint32_t encode(const Instruction& instruction, std::span<uint32_t, kMaxWords> out);

}  // namespace ipos::vm
