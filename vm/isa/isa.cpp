// Tables and coding of the instruction set. Operand lists are read out of the text forms at compile time.
#include "vm/isa/isa.hpp"

namespace ipos::vm {
namespace {

constexpr bool is_small(OperandKind kind) {
  return kind == OperandKind::Variable || kind == OperandKind::Bit || kind == OperandKind::Count ||
         kind == OperandKind::Keyword;
}

constexpr bool is_word(OperandKind kind) {
  return kind == OperandKind::Constant || kind == OperandKind::Label;
}

constexpr OperandInfo operand_of(std::string_view placeholder) {
  if (placeholder == "v") return {OperandKind::Variable, {}};
  if (placeholder == "b") return {OperandKind::Bit, {}};
  if (placeholder == "n") return {OperandKind::Count, {}};
  if (placeholder == "k") return {OperandKind::Constant, {}};
  if (placeholder == "m") return {OperandKind::Label, {}};
  return {OperandKind::Keyword, placeholder};
}

constexpr OpcodeInfo make_info(Opcode opcode, std::string_view name, std::string_view text, Flow flow,
                               std::string_view meaning) {
  OpcodeInfo row{opcode, name, text, flow, meaning, {}, 0, 1};
  int small = 0;
  for (size_t at = text.find('{'); at != std::string_view::npos; at = text.find('{', at + 1)) {
    const OperandInfo operand = operand_of(text.substr(at + 1, text.find('}', at) - at - 1));
    row.operands[static_cast<size_t>(row.operand_count++)] = operand;
    if (is_small(operand.kind) && ++small == 3) ++row.words;  // the extension word
    if (is_word(operand.kind)) ++row.words;
  }
  return row;
}

constexpr OpcodeInfo kOpcodes[] = {
#define OPCODE(code, name, text, flow, meaning) make_info(Opcode::name, #name, text, Flow::flow, meaning),
#include "vm/isa/opcodes.def"
};

constexpr KeywordInfo kKeywords[] = {
#define KEYWORD(set, value, text, constant) {#set, value, text, constant},
#include "vm/isa/keywords.def"
};

// Row number by opcode byte, -1 where there is no command.
constexpr auto kIndex = [] {
  std::array<int16_t, 256> index{};
  index.fill(-1);
  for (size_t row = 0; row < std::size(kOpcodes); ++row)
    index[static_cast<uint8_t>(kOpcodes[row].opcode)] = static_cast<int16_t>(row);
  return index;
}();

// Where the small operand number n stands: word, shift and mask.
struct Field {
  uint32_t word;
  uint32_t shift;
  uint32_t mask;
};
constexpr std::array<Field, kMaxOperands> kFields{
    {{0, 8, 0xFFF}, {0, 20, 0xFFF}, {1, 0, 0xFFFF}, {1, 16, 0xFFFF}}};

}  // namespace

std::span<const OpcodeInfo> opcode_table() { return kOpcodes; }
std::span<const KeywordInfo> keyword_table() { return kKeywords; }

const OpcodeInfo* find_opcode(uint32_t code) {
  if (code >= kIndex.size() || kIndex[code] < 0) return nullptr;
  return &kOpcodes[kIndex[code]];
}

const OpcodeInfo& info(Opcode opcode) { return kOpcodes[kIndex[static_cast<uint8_t>(opcode)]]; }

const KeywordInfo* find_keyword(std::string_view set, int32_t value) {
  for (const KeywordInfo& row : kKeywords)
    if (row.set == set && row.value == value) return &row;
  return nullptr;
}

const KeywordInfo* find_keyword(std::string_view set, std::string_view text) {
  for (const KeywordInfo& row : kKeywords)
    if (row.set == set && row.text == text) return &row;
  return nullptr;
}

Decoded decode(std::span<const uint32_t> code, uint32_t address) {
  if (address >= code.size()) return {DecodeStatus::Truncated, {}, 0};
  const OpcodeInfo* row = find_opcode(code[address] & 0xFF);
  if (row == nullptr) return {DecodeStatus::UnknownOpcode, {}, 0};
  const auto words = static_cast<uint32_t>(row->words);
  if (code.size() - address < words) return {DecodeStatus::Truncated, {}, 0};

  Decoded out{DecodeStatus::Ok, {row->opcode, {}}, words};
  std::array<uint32_t, 2> used{0xFF, 0};  // bits of the packed words that mean something
  size_t small = 0;
  uint32_t packed_words = 1;
  for (size_t n = 0; n < static_cast<size_t>(row->operand_count); ++n) {
    if (!is_small(row->operands[n].kind)) continue;
    const Field& field = kFields[small++];
    packed_words = field.word + 1;
    used[field.word] |= field.mask << field.shift;
    out.instruction.operands[n] =
        static_cast<int32_t>((code[address + field.word] >> field.shift) & field.mask);
  }
  for (uint32_t word = 0; word < packed_words; ++word)
    if ((code[address + word] & ~used[word]) != 0) out.status = DecodeStatus::ReservedBits;
  uint32_t next = packed_words;
  for (size_t n = 0; n < static_cast<size_t>(row->operand_count); ++n)
    if (is_word(row->operands[n].kind))
      out.instruction.operands[n] = static_cast<int32_t>(code[address + next++]);
  return out;
}

uint32_t encode(const Instruction& instruction, std::span<uint32_t, kMaxWords> out) {
  const OpcodeInfo& row = info(instruction.opcode);
  for (uint32_t& word : out) word = 0;
  out[0] = static_cast<uint8_t>(instruction.opcode);
  size_t small = 0;
  uint32_t next = 1;
  for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) {
    if (!is_small(row.operands[n].kind)) continue;
    const Field& field = kFields[small++];
    next = field.word + 1;
    out[field.word] |= (static_cast<uint32_t>(instruction.operands[n]) & field.mask) << field.shift;
  }
  for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n)
    if (is_word(row.operands[n].kind)) out[next++] = static_cast<uint32_t>(instruction.operands[n]);
  return next;
}

}  // namespace ipos::vm
