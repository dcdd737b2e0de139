// Every rule of the verifier is broken once, and sound programs pass.
#include "vm/verify/verify.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "tests/vm/code.hpp"

namespace ipos::vm {
namespace {

using tests::code_of;
using tests::I;

constexpr Limits kLimits{512, 2048, 2, 32};
constexpr Limits kLimitsB{1024, 16384, 3, 32};

struct Seen {
  uint32_t count;
  Rule rule;
  uint32_t address;
};

Seen first_violation(const std::vector<uint32_t>& code, const Limits& limits = kLimits) {
  std::array<Violation, 8> out{};
  const Verification result = verify(code, limits, out);
  EXPECT_EQ(result.image.has_value(), result.violations == 0);
  return {result.violations, out[0].rule, out[0].address};
}

class Rules : public ::testing::Test {
 protected:
  static void expect(const std::vector<uint32_t>& code, Rule rule, uint32_t address,
                     const Limits& limits = kLimits) {
    const Seen seen = first_violation(code, limits);
    ASSERT_GE(seen.count, 1U) << info(rule).code;
    EXPECT_STREQ(info(seen.rule).code, info(rule).code);
    EXPECT_EQ(seen.address, address) << info(rule).code;
  }
};

TEST_F(Rules, EachIsEnforced) {
  std::set<Rule> covered;
  const auto breaks = [&](Rule rule, const std::vector<uint32_t>& code, uint32_t address,
                          const Limits& limits = kLimits) {
    expect(code, rule, address, limits);
    covered.insert(rule);
  };
  breaks(Rule::EmptyCode, {}, 0);
  std::vector<uint32_t> longest(2049, static_cast<uint32_t>(Opcode::Ret));
  breaks(Rule::TooLong, longest, 2048);
  longest.pop_back();
  EXPECT_EQ(first_violation(longest).count, 0U);
  longest.resize(kLimitsB.program_words, static_cast<uint32_t>(Opcode::Ret));
  EXPECT_EQ(first_violation(longest, kLimitsB).count, 0U) << "the longest program there is";
  breaks(Rule::UnknownOpcode, {1, 0, 2}, 1);
  breaks(Rule::TruncatedCommand, {1, static_cast<uint32_t>(Opcode::SetHK)}, 1);
  breaks(Rule::ReservedBits, {0x10002}, 0);
  breaks(Rule::VariableRange, code_of({I(Opcode::AddHK, 512, 1), I(Opcode::End)}), 0);
  breaks(Rule::VariableRange, code_of({I(Opcode::Nop), I(Opcode::AddHH, 0, 512), I(Opcode::End)}), 1);
  breaks(Rule::StructureRange, code_of({I(Opcode::Movlnk, 506), I(Opcode::End)}), 0);
  EXPECT_EQ(first_violation(code_of({I(Opcode::Movlnk, 505), I(Opcode::End)})).count, 0U);
  breaks(Rule::StructureRange, code_of({I(Opcode::Scom, 1, 507), I(Opcode::End)}), 0);
  EXPECT_EQ(first_violation(code_of({I(Opcode::Scom, 3, 509), I(Opcode::End)})).count, 0U);
  breaks(Rule::StructureRange, code_of({I(Opcode::Copy, 500, 0, 13), I(Opcode::End)}), 0);
  breaks(Rule::StructureRange, code_of({I(Opcode::Copy, 0, 500, 13), I(Opcode::End)}), 0);
  breaks(Rule::StructureRange, code_of({I(Opcode::Copy, 0, 500, 0), I(Opcode::End)}), 0);
  breaks(Rule::BitRange, code_of({I(Opcode::BitSet, 0, 32), I(Opcode::End)}), 0);
  breaks(Rule::BitRange, code_of({I(Opcode::BitMove, 0, 31, 0, 32), I(Opcode::End)}), 0);
  breaks(Rule::UnknownKeyword, code_of({I(Opcode::Scom, 4, 0), I(Opcode::End)}), 0);
  breaks(Rule::LabelTarget, code_of({I(Opcode::SetHK, 0, 1), I(Opcode::Jmp, 1)}), 2);
  breaks(Rule::LabelTarget, code_of({I(Opcode::Jmp, 2)}), 0);
  breaks(Rule::LabelTarget, code_of({I(Opcode::Jmp, -1)}), 0);
  breaks(Rule::RunsOffEnd, code_of({I(Opcode::Nop)}), 0);
  breaks(Rule::RunsOffEnd, code_of({I(Opcode::JmpEqHK, 0, 1, 0)}), 0);
  breaks(Rule::RunsOffEnd, code_of({I(Opcode::Call, 0)}), 0);
  breaks(Rule::TaskMissing, code_of({I(Opcode::Task, 1, 0), I(Opcode::End)}), 0);
  EXPECT_EQ(first_violation(code_of({I(Opcode::Task, 1, 0), I(Opcode::End)}), kLimitsB).count, 0U);
  EXPECT_EQ(covered.size(), rule_table().size()) << "a rule has no program that breaks it";
}

TEST(Verifier, ReportsAllAndCountsThoseThatDoNotFit) {
  const std::vector<uint32_t> code = code_of(
      {I(Opcode::AddHK, 600, 1), I(Opcode::BitSet, 0, 40), I(Opcode::Jmp, 99), I(Opcode::AddHK, 700, 1)});
  std::array<Violation, 2> out{};
  EXPECT_EQ(verify(code, kLimits, out).violations, 5U);  // two variables, a bit, a label, and the end
}

// A program that is too long has this one violation, whatever is in it: it is not read, nor is there room for its starts.
TEST(Verifier, WhatIsTooLongIsNotRead) {
  for (const uint16_t words : {uint16_t{4}, uint16_t{2048}, uint16_t{16384}, uint16_t{65535}})
    for (const uint32_t word : {0U, static_cast<uint32_t>(Opcode::Ret), static_cast<uint32_t>(Opcode::Nop)}) {
      const uint32_t longest = words < kMaxProgramWords ? words : kMaxProgramWords;
      const std::vector<uint32_t> code(longest + 100, word);
      const Seen seen = first_violation(code, Limits{512, words, 2, 32});
      EXPECT_EQ(seen.count, 1U) << words << " " << word;
      EXPECT_EQ(seen.rule, Rule::TooLong);
      EXPECT_EQ(seen.address, longest);
    }
}

// To every word of a program that is longer than the words the verifier remembers its starts in: commands of two words
// can be jumped to at the even ones.
TEST(Verifier, LabelsHitStartsWhereverTheyAre) {
  for (const uint32_t commands : {40U, 120U}) {
    std::vector<uint32_t> code;
    for (uint32_t n = 0; n < commands; ++n)
      for (const uint32_t word : code_of({I(Opcode::SetHK, 0, 1)})) code.push_back(word);
    for (int32_t target = 0; target <= static_cast<int32_t>(2 * commands) + 2; ++target) {
      std::vector<uint32_t> jumps = code;
      for (const uint32_t word : code_of({I(Opcode::Jmp, target)})) jumps.push_back(word);
      const bool start = target % 2 == 0 && target <= static_cast<int32_t>(2 * commands);
      ASSERT_EQ(first_violation(jumps).count, start ? 0U : 1U) << target;
    }
  }
}

// Behind a word that is no command the next one is looked at.
TEST(Verifier, EveryUnknownWordIsReported) {
  std::array<Violation, 8> out{};
  const std::vector<uint32_t> code{0, 0xFF, 0, static_cast<uint32_t>(Opcode::End)};
  EXPECT_EQ(verify(code, kLimits, out).violations, 3U);
  for (uint32_t n = 0; n < 3; ++n) {
    EXPECT_EQ(out[n].rule, Rule::UnknownOpcode);
    EXPECT_EQ(out[n].address, n);
  }
}

// And the label of the command behind it is looked at, too.
TEST(Verifier, LabelsBehindAnUnknownWordAreChecked) {
  for (uint32_t unknown = 0; unknown <= 3; ++unknown) {
    std::vector<uint32_t> code(unknown, 0xFF);
    for (const uint32_t word : code_of({I(Opcode::Jmp, 99)})) code.push_back(word);
    std::array<Violation, 8> out{};
    ASSERT_EQ(verify(code, kLimits, out).violations, unknown + 1);
    EXPECT_EQ(out[unknown].rule, Rule::LabelTarget);
    EXPECT_EQ(out[unknown].address, unknown);
  }
}

TEST(Verifier, AcceptsEverySingleCommandWithSoundOperands) {
  for (const OpcodeInfo& row : opcode_table()) {
    Instruction command{row.opcode, {}};
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) {
      if (row.operands[n].kind == OperandKind::Keyword)
        command.operands[n] = row.opcode == Opcode::Scom ? 1 : 0;
      if (row.operands[n].kind == OperandKind::Count) command.operands[n] = 1;
    }
    EXPECT_EQ(first_violation(code_of({command, I(Opcode::End)}), kLimitsB).count, 0U) << row.text;
  }
}

// Lengths of the structures as the manuals print them (1053 1610 p. 47 to 56, IPOSplus p. 86, 347), and ten process data
// words (ours); every other variable operand is one variable, whatever its keyword.
uint32_t printed_length(Opcode opcode, int32_t keyword) {
  switch (opcode) {
    case Opcode::Movlnk:
    case Opcode::VarInt: return 7;
    case Opcode::Scom: return keyword == 1 ? 6 : keyword == 2 ? 4 : 3;
    case Opcode::GetSys:
      return keyword == 5 ? 3 : keyword == 7 ? 2 : keyword == 8 ? 14 : keyword == 9 ? 10 : 1;
    case Opcode::SetSys: return keyword == 6 ? 3 : keyword == 9 || keyword == 10 ? 2 : keyword == 15 ? 10 : 1;
    default: return 1;
  }
}

constexpr int32_t kCount = 5;  // of a block copy

// Each variable operand of each command with each keyword, so that its last variable is the unit's last, and one
// further; both amounts of variables that units have.
TEST(Verifier, EveryStructureMayEndAtTheLastVariableAndNotBehindIt) {
  int structures = 0;
  for (const OpcodeInfo& row : opcode_table()) {
    Instruction command{row.opcode, {}};
    const OperandInfo* keywords = nullptr;
    size_t keyword_at = 0;
    bool copies = false;
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) {
      if (row.operands[n].kind == OperandKind::Count) command.operands[n] = kCount, copies = true;
      if (row.operands[n].kind == OperandKind::Keyword) keywords = &row.operands[n], keyword_at = n;
    }
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n)
      for (const KeywordInfo& word : keyword_table()) {
        if (row.operands[n].kind != OperandKind::Variable) break;
        if (keywords != nullptr && word.set != keywords->keyword_set) continue;
        if (keywords != nullptr) command.operands[keyword_at] = word.value;
        const uint32_t length = copies ? kCount : printed_length(row.opcode, word.value);
        structures += length > 1;
        for (const Limits& limits : {Limits{512, 2048, 3, 32}, kLimitsB}) {
          Instruction at = command;
          at.operands[n] = static_cast<int32_t>(limits.variables - length);
          EXPECT_EQ(first_violation(code_of({at, I(Opcode::End)}), limits).count, 0U)
              << row.text << ", operand " << n << ", keyword " << word.value;
          ++at.operands[n];
          const Seen seen = first_violation(code_of({at, I(Opcode::End)}), limits);
          EXPECT_EQ(seen.count, 1U) << row.text << ", operand " << n << ", keyword " << word.value;
          EXPECT_EQ(seen.rule, length > 1 ? Rule::StructureRange : Rule::VariableRange) << row.text;
          EXPECT_EQ(seen.address, 0U);
        }
        if (keywords == nullptr) break;
      }
  }
  EXPECT_EQ(structures, 2 + 3 + 4 + 4 + 2)
      << "MOVLNK and VARINT, three of SCOM, four of GETSYS and SETSYS, both of COPY";
}

}  // namespace
}  // namespace ipos::vm
