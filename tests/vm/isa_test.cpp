// The instruction table and the coding of commands in code words.
#include "vm/isa/isa.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/vm/code.hpp"

namespace ipos::vm {
namespace {

using tests::code_of;
using tests::I;

// Coding as docs/reference/isa.md prints it, worked out by hand.
TEST(Isa, CodesOperandsInTheirPlaces) {
  EXPECT_EQ(code_of({I(Opcode::Ret)}), (std::vector<uint32_t>{0x00000003}));
  EXPECT_EQ(code_of({I(Opcode::AddHH, 420, 7)}), (std::vector<uint32_t>{(7U << 20) | (420U << 8) | 0x30}));
  EXPECT_EQ(code_of({I(Opcode::SetHK, 420, -2)}), (std::vector<uint32_t>{(420U << 8) | 0x21, 0xFFFFFFFE}));
  EXPECT_EQ(code_of({I(Opcode::JmpLeHK, 0, 15, 9)}), (std::vector<uint32_t>{0x1B, 15, 9}));
  EXPECT_EQ(code_of({I(Opcode::BitMove, 1, 2, 3, 4)}),
            (std::vector<uint32_t>{(2U << 20) | (1U << 8) | 0x52, (4U << 16) | 3}));
  EXPECT_EQ(code_of({I(Opcode::InputCall, 1, 8, 5)}), (std::vector<uint32_t>{(1U << 8) | 0x6E, 8, 5}));
}

TEST(Isa, EveryCommandDecodesToItself) {
  for (const OpcodeInfo& row : opcode_table()) {
    Instruction command{row.opcode, {}};
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n)
      command.operands[n] = static_cast<int32_t>(n + 5);
    const std::vector<uint32_t> code = code_of({command});
    EXPECT_EQ(code.size(), static_cast<size_t>(row.words)) << row.text;
    const Decoded decoded = decode(code, 0);
    EXPECT_EQ(decoded.status, DecodeStatus::Ok) << row.text;
    EXPECT_EQ(decoded.instruction, command) << row.text;
    EXPECT_EQ(decoded.words, code.size()) << row.text;
    if (row.words > 1) {
      EXPECT_EQ(decode(std::span(code).first(code.size() - 1), 0).status, DecodeStatus::Truncated)
          << row.text;
    }
  }
}

TEST(Isa, TableIsConsistent) {
  std::set<std::string_view> texts;
  for (const OpcodeInfo& row : opcode_table()) {
    EXPECT_TRUE(texts.insert(row.text).second) << "two commands read " << row.text;
    EXPECT_EQ(find_opcode(static_cast<uint8_t>(row.opcode)), &row);
    EXPECT_LE(row.operand_count, kMaxOperands);
    for (const OperandInfo& operand : row.operands)
      if (operand.kind == OperandKind::Keyword) {
        EXPECT_NE(find_keyword(operand.keyword_set, row.opcode == Opcode::Scom ? 1 : 0), nullptr) << row.text;
      }
  }
  EXPECT_EQ(find_opcode(0), nullptr) << "cleared program memory must not run";
  EXPECT_EQ(find_opcode(256), nullptr);
}

TEST(Isa, KeywordsAreUnique) {
  std::set<std::pair<std::string_view, int32_t>> values;
  std::set<std::pair<std::string_view, std::string_view>> texts;
  for (const KeywordInfo& row : keyword_table()) {
    EXPECT_TRUE(values.insert({row.set, row.value}).second) << row.text;
    EXPECT_TRUE(texts.insert({row.set, row.text}).second) << row.text;
    EXPECT_EQ(find_keyword(row.set, row.value), &row);
    EXPECT_EQ(find_keyword(row.set, row.text), &row);
  }
  EXPECT_EQ(find_keyword("scom", 99), nullptr);
}

TEST(Isa, ReservedBitsAreSeen) {
  EXPECT_EQ(decode(std::vector<uint32_t>{0x80000003}, 0).status, DecodeStatus::ReservedBits);
  EXPECT_EQ(decode(std::vector<uint32_t>{(1U << 20) | 0x21, 5}, 0).status, DecodeStatus::ReservedBits);
}

}  // namespace
}  // namespace ipos::vm
