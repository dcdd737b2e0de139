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

}  // namespace
}  // namespace ipos::vm
