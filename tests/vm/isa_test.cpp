// The instruction table and the coding of commands in code words.
#include "vm/isa/isa.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/vm/code.hpp"
#include "vm/isa/blocks.hpp"

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

// Every bit of every word of every command, after the layout of docs/reference/isa.md: what belongs to an operand changes
// that one alone, what belongs to none is seen.
TEST(Isa, EveryBitIsAnOperandsOrReserved) {
  for (const OpcodeInfo& row : opcode_table()) {
    SCOPED_TRACE(row.text);
    struct Place {
      size_t word, first, bits;
    };
    std::vector<Place> places;
    const Place small[] = {{0, 8, 12}, {0, 20, 12}, {1, 0, 16}, {1, 16, 16}};
    const auto operands = std::span(row.operands).first(static_cast<size_t>(row.operand_count));
    size_t smalls = 0;
    const auto has_word = [](const OperandInfo& operand) {
      return operand.kind == OperandKind::Constant || operand.kind == OperandKind::Label;
    };
    for (const OperandInfo& operand : operands) smalls += has_word(operand) ? 0 : 1;
    size_t next_small = 0, next_word = smalls > 2 ? 2 : 1;
    for (const OperandInfo& operand : operands)
      places.push_back(has_word(operand) ? Place{next_word++, 0, 32} : small[next_small++]);
    ASSERT_EQ(static_cast<size_t>(row.words), next_word);

    const std::vector<uint32_t> plain = code_of({I(row.opcode)});
    ASSERT_EQ(plain.size(), next_word);
    for (size_t word = 0; word < plain.size(); ++word)
      for (size_t bit = word == 0 ? 8 : 0; bit < 32; ++bit) {
        std::vector<uint32_t> code = plain;
        code[word] ^= 1U << bit;
        Instruction wanted{row.opcode, {}};
        bool reserved = true;
        for (size_t n = 0; n < places.size(); ++n) {
          const Place& place = places[n];
          if (place.word != word || bit < place.first || bit >= place.first + place.bits) continue;
          wanted.operands[n] = static_cast<int32_t>(1U << (bit - place.first));
          reserved = false;
        }
        const Decoded decoded = decode(code, 0);
        EXPECT_EQ(decoded.status, reserved ? DecodeStatus::ReservedBits : DecodeStatus::Ok)
            << word << "." << bit;
        EXPECT_EQ(decoded.instruction, wanted) << word << "." << bit;
        EXPECT_EQ(decoded.words, plain.size());
        if (!reserved) {
          EXPECT_EQ(code_of({wanted}), code) << word << "." << bit;
        }
      }
  }
}

// Wherever it stands, and not when it is cut.
TEST(Isa, CommandsAreReadAtTheirAddress) {
  const std::vector<uint32_t> code =
      code_of({I(Opcode::Nop), I(Opcode::BitMove, 1, 2, 3, 4), I(Opcode::JmpLeHK, 6, 7, 8), I(Opcode::End)});
  EXPECT_EQ(decode(code, 1).instruction, I(Opcode::BitMove, 1, 2, 3, 4));
  EXPECT_EQ(decode(code, 3).instruction, I(Opcode::JmpLeHK, 6, 7, 8));
  EXPECT_EQ(decode(code, 6).instruction, I(Opcode::End));
  for (const uint32_t address : {7U, 8U, UINT32_MAX})
    EXPECT_EQ(decode(code, address).status, DecodeStatus::Truncated) << address;
  EXPECT_EQ(decode({}, 0).status, DecodeStatus::Truncated);
  EXPECT_EQ(decode(std::span(code).first(5), 3).status, DecodeStatus::Truncated);
  EXPECT_EQ(decode(std::span(code).first(6), 3).status, DecodeStatus::Ok);
}

// The table with texts and the one without have the same commands.
TEST(Isa, BothTablesAgree) {
  for (uint32_t code = 0; code <= 300; ++code) {
    const OpcodeInfo* row = find_opcode(code);
    const Coding* coding_row = find_coding(code);
    ASSERT_EQ(row != nullptr, coding_row != nullptr) << code;
    if (code < 256) {
      EXPECT_EQ(decode(std::vector<uint32_t>{code, 0, 0, 0}, 0).status,
                row != nullptr ? DecodeStatus::Ok : DecodeStatus::UnknownOpcode)
          << code;
    }
    if (row == nullptr) continue;
    EXPECT_EQ(coding_row, &coding(row->opcode)) << row->text;
    EXPECT_EQ(&info(row->opcode), row);
    EXPECT_EQ(coding_row->flow, row->flow) << row->text;
    EXPECT_EQ(coding_row->words, row->words) << row->text;
    EXPECT_EQ(coding_row->operand_count, row->operand_count) << row->text;
    for (size_t n = 0; n < kMaxOperands; ++n) {
      EXPECT_EQ(coding_row->kinds[n], row->operands[n].kind) << row->text;
      if (row->operands[n].kind != OperandKind::Keyword) continue;
      for (int32_t value = -1; value <= 64; ++value)
        EXPECT_EQ(coding_row->has_keyword(value),
                  find_keyword(row->operands[n].keyword_set, value) != nullptr)
            << row->text << " " << value;
    }
  }
}

// Of less, equal and greater a branch and its inverse jump at disjoint ones, and at all of them together. Names tell what
// they jump at.
TEST(Isa, InverseBranchesJumpWhenTheOtherDoesNot) {
  constexpr unsigned kLess = 1, kEqual = 2, kGreater = 4;
  const std::pair<std::string_view, unsigned> conditions[] = {{"Eq", kEqual},   {"Ne", kLess | kGreater},
                                                              {"Lt", kLess},    {"Le", kLess | kEqual},
                                                              {"Gt", kGreater}, {"Ge", kGreater | kEqual}};
  const auto jumps_at = [&](Opcode opcode) {
    for (const auto& [name, at] : conditions)
      if (info(opcode).name.substr(3, 2) == name) return at;
    return 0U;
  };
  int branches = 0;
  for (const OpcodeInfo& row : opcode_table()) {
    const Opcode other = inverse(row.opcode);
    if (row.flow != Flow::Branch) {
      EXPECT_EQ(other, row.opcode) << row.text;
      continue;
    }
    ++branches;
    EXPECT_EQ(jumps_at(row.opcode) ^ jumps_at(other), kLess | kEqual | kGreater) << row.text;
    EXPECT_EQ(info(other).name.substr(5), row.name.substr(5)) << "of the same operands";
  }
  EXPECT_EQ(branches, 12);
}

TEST(Isa, BlocksAreTheRowsOfTheKeyword) {
  const auto types = [](Opcode opcode, size_t operand, int32_t keyword) {
    std::string out;
    for (const BlockInfo& row : blocks_of(opcode, operand, keyword)) out += std::string(row.type) + " ";
    return out;
  };
  EXPECT_EQ(types(Opcode::GetSys, 0, 8), "GSCAM GSCAM_EXT ") << "either of them";
  EXPECT_EQ(types(Opcode::GetSys, 0, 9), "GSPODATA10 ");
  EXPECT_EQ(types(Opcode::GetSys, 0, 6), "long ") << "the row of all others";
  EXPECT_EQ(types(Opcode::GetSys, 1, 8), "") << "no row of this operand";
  EXPECT_EQ(types(Opcode::SetSys, 1, 9), "SSPOSRAMP ");
  EXPECT_EQ(types(Opcode::Scom, 1, 4), "") << "no such keyword";
  EXPECT_EQ(types(Opcode::Movlnk, 0, kAnyKeyword), "MOVLNK ");
  EXPECT_EQ(types(Opcode::Copy, 1, kAnyKeyword), " ") << "of any type";
  EXPECT_EQ(types(Opcode::AddHH, 0, kAnyKeyword), "");
  const std::span<const BlockInfo> cams = blocks_of(Opcode::GetSys, 0, 8);  // IPOSplus p. 86, 91
  EXPECT_EQ(cams.front().variables, 14);
  EXPECT_EQ(cams.back().variables, 16);
  EXPECT_EQ(block_size(I(Opcode::GetSys, 0, 8), 0), 14U) << "the smaller of both";
  EXPECT_EQ(block_size(I(Opcode::Copy, 0, 0, 77), 0), 77U);
  EXPECT_EQ(block_size(I(Opcode::AddHH, 0, 0), 1), 1U);
}

}  // namespace
}  // namespace ipos::vm
