// Machine code of each command on variables in registers and in memory: both, one of them, the same one twice; and each
// pair of commands that may become one instruction. The reference interpreter is the expected value.
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "tests/engines/sequence.hpp"
#include "tests/vm/code.hpp"

namespace ipos::tests {
namespace {

using vm::Instruction;
using vm::Opcode;
using Commands = std::vector<Instruction>;

constexpr int32_t kMost = INT32_MAX, kLeast = INT32_MIN;
constexpr int32_t kValues[] = {kLeast, -100, -1, 0, 1, 33, kMost};

#if defined(__aarch64__)
constexpr size_t kRegisters = 20;
#else
constexpr size_t kRegisters = 11;
#endif

int32_t behind(const Commands& commands) {
  int32_t words = 0;
  for (const Instruction& command : commands) words += vm::info(command.opcode).words;
  return words;
}

// These commands at the beginning of a loop that is gone through once. An inner loop that nobody comes to uses as many
// variables as there are registers more than all others: those that are to have one, then H20 and further.
constexpr int32_t kNever = 60, kBusy = 20, kLookedAt = 11;
Commands once(Commands out, const std::vector<int32_t>& in_registers) {
  const int32_t inner = behind(out) + vm::info(Opcode::Jmp).words;
  Commands uses;
  for (size_t n = 0; n < kRegisters; ++n) {
    const int32_t variable = n < in_registers.size() ? in_registers[n] : kBusy + static_cast<int32_t>(n);
    uses.push_back(I(Opcode::SetHH, variable, variable));
  }
  uses.push_back(I(Opcode::JmpLtHK, kNever, 0, inner));
  uses.push_back(I(Opcode::JmpLtHK, kNever, 0, 0));
  out.push_back(I(Opcode::Jmp, inner + behind(uses)));
  out.insert(out.end(), uses.begin(), uses.end());
  out.push_back(I(Opcode::End));
  return out;
}

void expect_equal(const Sequence& sequence, const std::vector<std::pair<int32_t, int32_t>>& values) {
  std::vector<int32_t> variables(kRowLimits.variables);
  for (size_t n = 0; n < variables.size(); ++n) variables[n] = static_cast<int32_t>(1000 + n);
  variables[kNever] = 0;
  for (const auto& [number, value] : values) variables[static_cast<size_t>(number)] = value;
  ASSERT_NO_FATAL_FAILURE(sequence.expect_equal_parts(variables, {500}));
}

// A command of the two variables, or of the first and the constant.
std::optional<Instruction> on(const vm::OpcodeInfo& row, int32_t a, int32_t b, int32_t constant) {
  Instruction out{row.opcode, {}};
  bool first = true;
  for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) switch (row.operands[n].kind) {
      case vm::OperandKind::Variable: out.operands[n] = first ? a : b, first = false; break;
      case vm::OperandKind::Constant: out.operands[n] = constant; break;
      case vm::OperandKind::Bit: out.operands[n] = constant & 31; break;
      case vm::OperandKind::Count: out.operands[n] = 3; break;
      default: return std::nullopt;
    }
  return out;
}

struct Place {
  int32_t a, b;
  std::vector<int32_t> in_registers;
};
const Place kPlaces[] = {{1, 2, {}}, {1, 2, {1}}, {1, 2, {2}}, {1, 2, {1, 2}}, {1, 1, {}}, {1, 1, {1}}};

TEST(Registers, EachCommandWithItsVariablesInThemAndInMemory) {
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    if (row.flow != vm::Flow::Next) continue;
    const auto sample = on(row, 1, 2, 1);
    ASSERT_TRUE(sample) << row.text;
    bool constant = false, variables = false;
    for (size_t n = 1; n < static_cast<size_t>(row.operand_count); ++n) {
      variables = variables || row.operands[n].kind == vm::OperandKind::Variable;
      constant = constant || row.operands[n].kind != vm::OperandKind::Variable;
    }
    for (const Place& place : kPlaces)
      for (const int32_t k : kValues) {
        const Sequence sequence(once({*on(row, place.a, place.b, k)}, place.in_registers));
        ASSERT_TRUE(sequence.good()) << row.text;
        SCOPED_TRACE(testing::Message() << row.text << " " << place.a << ", " << place.b << ", " << k << ", "
                                        << place.in_registers.size() << " in registers");
        for (const int32_t x : kValues)
          for (const int32_t y : kValues) {
            ASSERT_NO_FATAL_FAILURE(expect_equal(sequence, {{place.b, y}, {place.a, x}}));
            if (!variables) break;
          }
        if (!constant) break;
      }
  }
}

TEST(Registers, EachBranchWithItsVariablesInThemAndInMemory) {
  const std::vector<int32_t> constants{kLeast, -1, 0, 1, kMost};
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    if (row.flow != vm::Flow::Branch) continue;
    const bool constant = row.operands[1].kind == vm::OperandKind::Constant;
    for (const Place& place : kPlaces)
      for (const int32_t k : constants) {
        // A branch behind nothing, behind a command whose result it tests, and behind one of another variable.
        for (const int32_t before : {0, 1, 3}) {
          Commands commands;
          if (before != 0) commands.push_back(I(Opcode::AddHK, before, 1));
          const int32_t at = behind(commands) + row.words + vm::info(Opcode::SetHK).words;
          commands.push_back(I(row.opcode, place.a, constant ? k : place.b, at));
          commands.push_back(I(Opcode::SetHK, kLookedAt, 5));
          const Sequence sequence(once(commands, place.in_registers));
          ASSERT_TRUE(sequence.good()) << row.text;
          SCOPED_TRACE(testing::Message() << row.text << " " << place.a << ", " << place.b << ", " << k
                                          << ", behind " << before);
          for (const int32_t x : {kLeast, -2, -1, 0, 1, kMost})
            for (const int32_t y : {kLeast, -1, 0, kMost}) {
              ASSERT_NO_FATAL_FAILURE(expect_equal(sequence, {{place.b, y}, {place.a, x}}));
              if (constant) break;
            }
        }
        if (!constant) break;
      }
  }
}

// SET and what works on the same variable then; two sums on one variable.
TEST(Registers, TwoCommandsThatMayBecomeOne) {
  const Opcode seconds[] = {Opcode::AddHH, Opcode::SubHH, Opcode::MulHH, Opcode::AndHH, Opcode::AddHK,
                            Opcode::SubHK, Opcode::MulHK, Opcode::ShlHK, Opcode::NotH};
  const Opcode firsts[] = {Opcode::SetHH, Opcode::AddHH, Opcode::SubHH, Opcode::SetHK};
  const std::vector<int32_t> registers[] = {{}, {1}, {2}, {3}, {1, 2}, {1, 3}, {2, 3}, {1, 2, 3}};
  for (const auto& in_registers : registers)
    for (const Opcode first : firsts)
      for (const Opcode second : seconds)
        for (const auto& [to, from, other] :
             {std::array{1, 2, 3}, {1, 2, 2}, {1, 2, 1}, {1, 1, 2}, {1, 1, 1}, {2, 3, 3}}) {
          const bool constant = vm::info(second).operands[1].kind == vm::OperandKind::Constant;
          const bool product = first == Opcode::SetHH && second == Opcode::MulHK;
          for (const int32_t k : {kLeast, 5, 0, -1, 1, 3, 8, 9, 100}) {
            if (k != kLeast && k != 5 && !product) break;
            const Sequence sequence(
                once({I(first, 1, from), I(second, to, constant ? k : other)}, in_registers));
            ASSERT_TRUE(sequence.good());
            SCOPED_TRACE(testing::Message() << vm::info(first).text << ", " << vm::info(second).text << " of "
                                            << to << " " << from << " " << other << ", " << k << ", "
                                            << in_registers.size() << " in registers");
            for (const auto& [x, y] : {std::pair{-7, 12}, {kLeast, -1}, {0, kMost}})
              ASSERT_NO_FATAL_FAILURE(expect_equal(sequence, {{1, x}, {2, y}, {3, 77}}));
            if (!constant) break;
          }
        }
}

// Blocks in front of what they are copied from, behind it and on it, as long as machine code copies them and longer.
TEST(Registers, BlocksThatOverlap) {
  constexpr int32_t kFrom = 5;
  const std::vector<int32_t> registers[] = {{}, {kFrom}, {7, 8}, {1, 3, 5, 7, 9, 11, 13}, {4, 5, 6, 7, 8, 9, 10, 11}};
  for (const auto& in_registers : registers)
    for (int32_t count = 1; count <= 9; ++count)
      for (int32_t to = 1; to <= 10; ++to) {
        const Sequence sequence(once({I(Opcode::Copy, to, kFrom, count)}, in_registers));
        ASSERT_TRUE(sequence.good());
        SCOPED_TRACE(testing::Message() << count << " to H" << to << ", " << in_registers.size() << " in registers");
        ASSERT_NO_FATAL_FAILURE(expect_equal(sequence, {}));
      }
}

// An index leads to a variable in memory in front of those in registers, between them and behind, to one in a register,
// to the index itself and to what is loaded or stored, and to none.
TEST(Registers, IndexesLeadAnywhere) {
  const std::vector<int32_t> registers[] = {{}, {1}, {2}, {1, 2}, {0, 5, 10}, {1, 5, 63}};
  for (const auto& in_registers : registers)
    for (const bool loads : {true, false})
      for (const int32_t added : {0, 6, 40, 62, -1}) {
        Commands commands;
        if (added != 0) commands.push_back(I(Opcode::AddHK, 1, added));
        commands.push_back(loads ? I(Opcode::SetiLoad, 2, 1) : I(Opcode::SetiStore, 1, 2));
        commands.push_back(loads ? I(Opcode::SetiLoad, 1, 1) : I(Opcode::SetiStore, 1, 1));
        const Sequence sequence(once(commands, in_registers));
        ASSERT_TRUE(sequence.good());
        for (int32_t index = -2; index <= 66; ++index) {
          SCOPED_TRACE(testing::Message() << (loads ? "load " : "store ") << index << " as " << added
                                          << " and the rest, " << in_registers.size() << " in registers");
          ASSERT_NO_FATAL_FAILURE(expect_equal(sequence, {{2, 3}, {1, index - added}}));
        }
        for (const int32_t far : {kLeast, kMost, -64, 1 << 30})
          ASSERT_NO_FATAL_FAILURE(expect_equal(sequence, {{1, far}}));
      }
}

}  // namespace
}  // namespace ipos::tests
