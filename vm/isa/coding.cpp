// The coding of commands. Operand lists are read out of the text forms at compile time; what remains is a
// dozen bytes a command.
#include "vm/isa/coding.hpp"

#include <string_view>

#include "vm/isa/operand_text.hpp"

namespace ipos::vm {
namespace {

constexpr uint32_t keyword_mask(std::string_view set) {
  uint32_t mask = 0;
#define KEYWORD(name, value, text, constant)                \
  static_assert((value) < 32, "keywords are a 32-bit set"); \
  if (set == #name) mask |= 1U << (value);
#include "vm/isa/keywords.def"
  return mask;
}

constexpr Coding make_coding(std::string_view text, Flow flow, Reads reads, Writes writes, Faults faults) {
  Coding row;
  row.flow = flow;
  row.reads = reads;
  row.writes = writes;
  row.faults = faults;
  row.words = words_of(text);
  for_each_operand(text, [&](OperandKind kind, std::string_view keyword_set) {
    row.kinds[row.operand_count++] = kind;
    if (kind == OperandKind::Keyword) row.keywords = keyword_mask(keyword_set);
  });
  return row;
}

constexpr Coding kCodings[] = {
#define OPCODE(code, name, text, flow, reads, writes, faults, meaning) \
  make_coding(text, Flow::flow, Reads::reads, Writes::writes, Faults::faults),
#include "vm/isa/opcodes.def"
};

// Row number by opcode byte, -1 where there is no command.
constexpr auto kIndex = [] {
  constexpr Opcode opcodes[] = {
#define OPCODE(code, name, text, flow, reads, writes, faults, meaning) Opcode::name,
#include "vm/isa/opcodes.def"
  };
  static_assert(std::size(opcodes) <= INT8_MAX);
  std::array<int8_t, 128> index{};
  index.fill(-1);
  for (size_t row = 0; row < std::size(opcodes); ++row)
    index[static_cast<uint8_t>(opcodes[row])] = static_cast<int8_t>(row);
  return index;
}();

// Where the small operand number n stands: word, shift and mask.
struct Field {
  uint8_t word;
  uint8_t shift;
  uint16_t mask;
};
constexpr std::array<Field, kMaxOperands> kFields{
    {{0, 8, 0xFFF}, {0, 20, 0xFFF}, {1, 0, 0xFFFF}, {1, 16, 0xFFFF}}};

}  // namespace

const Coding* find_coding(uint32_t code) {
  if (code >= kIndex.size() || kIndex[code] < 0) return nullptr;
  return &kCodings[kIndex[code]];
}

const Coding& coding(Opcode opcode) { return kCodings[kIndex[static_cast<uint8_t>(opcode)]]; }

Decoded decode(std::span<const uint32_t> code, uint32_t address) {
  if (address >= code.size()) return {DecodeStatus::Truncated, {}, 0};
  const Coding* row = find_coding(code[address] & 0xFF);
  if (row == nullptr) return {DecodeStatus::UnknownOpcode, {}, 0};
  const uint32_t words = row->words;
  if (code.size() - address < words) return {DecodeStatus::Truncated, {}, 0};

  Decoded out{DecodeStatus::Ok, {static_cast<Opcode>(code[address] & 0xFF), {}}, words};
  std::array<uint32_t, 2> used{0xFF, 0};  // bits of the packed words that mean something
  size_t small = 0;
  uint32_t packed_words = 1;
  for (size_t n = 0; n < row->operand_count; ++n) {
    if (!is_small(row->kinds[n])) continue;
    const Field& field = kFields[small++];
    packed_words = field.word + 1U;
    used[field.word] |= uint32_t{field.mask} << field.shift;
    out.instruction.operands[n] = static_cast<int32_t>((code[address + field.word] >> field.shift) & field.mask);
  }
  for (uint32_t word = 0; word < packed_words; ++word)
    if ((code[address + word] & ~used[word]) != 0) out.status = DecodeStatus::ReservedBits;
  uint32_t next = packed_words;
  for (size_t n = 0; n < row->operand_count; ++n)
    if (is_word(row->kinds[n])) out.instruction.operands[n] = static_cast<int32_t>(code[address + next++]);
  return out;
}

uint32_t encode(const Instruction& instruction, std::span<uint32_t, kMaxWords> out) {
  const Coding& row = coding(instruction.opcode);
  for (uint32_t& word : out) word = 0;
  out[0] = static_cast<uint8_t>(instruction.opcode);
  size_t small = 0;
  uint32_t next = 1;
  for (auto operand = instruction.operands.begin(); const OperandKind kind : row.kinds) {
    const auto value = static_cast<uint32_t>(*operand++);
    if (!is_small(kind)) continue;
    const Field& field = kFields[small++];
    next = field.word + 1U;
    out[field.word] |= (value & field.mask) << field.shift;
  }
  for (auto operand = instruction.operands.begin(); const OperandKind kind : row.kinds) {
    const auto value = static_cast<uint32_t>(*operand++);
    if (is_word(kind)) out[next++] = value;
  }
  return next;
}

// The branch codes come in pairs of opposites: == !=, < >=, <= >.
Opcode inverse(Opcode opcode) {
  switch (opcode) {
    case Opcode::JmpEqHH: return Opcode::JmpNeHH;
    case Opcode::JmpNeHH: return Opcode::JmpEqHH;
    case Opcode::JmpLtHH: return Opcode::JmpGeHH;
    case Opcode::JmpGeHH: return Opcode::JmpLtHH;
    case Opcode::JmpLeHH: return Opcode::JmpGtHH;
    case Opcode::JmpGtHH: return Opcode::JmpLeHH;
    case Opcode::JmpEqHK: return Opcode::JmpNeHK;
    case Opcode::JmpNeHK: return Opcode::JmpEqHK;
    case Opcode::JmpLtHK: return Opcode::JmpGeHK;
    case Opcode::JmpGeHK: return Opcode::JmpLtHK;
    case Opcode::JmpLeHK: return Opcode::JmpGtHK;
    case Opcode::JmpGtHK: return Opcode::JmpLeHK;
    default: return opcode;
  }
}

}  // namespace ipos::vm
