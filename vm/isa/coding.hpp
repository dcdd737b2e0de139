// What the machine needs to know of a command: its operands, its length, what it does to the program, and how
// it is packed into code words. Built from opcodes.def and keywords.def like the tables of isa.hpp, but
// without their texts, which a microcontroller has no use for.
//
// Coding (ours): word 0 holds the opcode in bits 0..7 and the first two small operands (variable, bit, count,
// keyword) in bits 8..19 and 20..31. A third and fourth small operand stand in an extension word, bits 0..15
// and 16..31. Then constants and labels follow, a word each. Unused bits are 0.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace ipos::vm {

enum class Opcode : uint8_t {
#define OPCODE(code, name, text, flow, reads, writes, faults, meaning) name = code,
#include "vm/isa/opcodes.def"
};

enum class Flow : uint8_t { Next, Jump, Branch, Call, Return, End, System, SystemCall };

// See opcodes.def; vm/isa/effects.hpp applies them to a command.
enum class Reads : uint8_t { Named, Block, Indexed };
enum class Writes : uint8_t { None, First, Block, Indexed };
enum class Faults : uint8_t { Never, Zero, Index, Depth, Host };

enum class OperandKind : uint8_t { None, Variable, Bit, Count, Keyword, Constant, Label };

inline constexpr int kMaxOperands = 4;

struct Coding {
  std::array<OperandKind, kMaxOperands> kinds{};
  uint32_t keywords = 0;  // bit n: n is a word of the command's keyword set
  Flow flow = Flow::Next;
  Reads reads = Reads::Named;
  Writes writes = Writes::None;
  Faults faults = Faults::Never;
  uint8_t operand_count = 0;
  uint8_t words = 1;  // length of the command in code words, 1..4

  constexpr bool has_keyword(int32_t value) const {
    return value >= 0 && value < 32 && (keywords >> static_cast<uint32_t>(value) & 1U) != 0;
  }
};

// The row of an opcode byte, or nullptr when no command has this code.
const Coding* find_coding(uint32_t code);

// The row of a valid opcode.
const Coding& coding(Opcode opcode);

// The branch that jumps when this one does not; other commands as they are.
Opcode inverse(Opcode opcode);

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
