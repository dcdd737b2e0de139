// Tables of the instruction set with their texts.
#include "vm/isa/isa.hpp"

#include "vm/isa/operand_text.hpp"

namespace ipos::vm {
namespace {

constexpr OpcodeInfo make_info(Opcode opcode, std::string_view name, std::string_view text, Flow flow,
                               std::string_view meaning) {
  OpcodeInfo row{opcode, name, text, flow, meaning, {}, 0, words_of(text)};
  for_each_operand(text, [&](OperandKind kind, std::string_view keyword_set) {
    row.operands[static_cast<size_t>(row.operand_count++)] = {kind, keyword_set};
  });
  return row;
}

constexpr OpcodeInfo kOpcodes[] = {
#define OPCODE(code, name, text, flow, reads, writes, faults, meaning) \
  make_info(Opcode::name, #name, text, Flow::flow, meaning),
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

}  // namespace ipos::vm
