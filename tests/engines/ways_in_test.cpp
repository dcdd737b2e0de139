// Which commands machine code can be entered at (fast::Native::needs), and so what it has made of them: two commands
// that became one, comparisons that became a table, a test that looks at the flags, a jump that was decided in advance
// (docs/inside/performance.md). Each program does the same as in the reference interpreter, with every budget. Labels are
// numbers of commands.
#include <gtest/gtest.h>

#include <string>

#include "tests/engines/pair.hpp"
#include "tests/engines/sequence.hpp"
#include "tests/vm/code.hpp"
#include "vm/exec/saved_state.hpp"
#include "vm/jit/flow.hpp"

namespace ipos::tests {
namespace {

using vm::Instruction;
using vm::Opcode;
using Commands = std::vector<Instruction>;

class WaysIn : public testing::Test {
 protected:
  void SetUp() override {
    if (!vm::jit::available()) GTEST_SKIP() << "this build has no machine code";
  }
};

Instruction jump(int32_t to) { return I(Opcode::Jmp, to); }
Instruction set(int32_t to, int32_t k) { return I(Opcode::SetHK, to, k); }
Instruction copy(int32_t to, int32_t from) { return I(Opcode::SetHH, to, from); }
Instruction add(int32_t to, int32_t k) { return I(Opcode::AddHK, to, k); }
Instruction equal(int32_t variable, int32_t k, int32_t to) { return I(Opcode::JmpEqHK, variable, k, to); }
Instruction less(int32_t variable, int32_t k, int32_t to) { return I(Opcode::JmpLtHK, variable, k, to); }
const Instruction kNop = I(Opcode::Nop), kRet = I(Opcode::Ret), kEnd = I(Opcode::End);

// Of each command '+', or '-' where there is no way in. Where there is one so much is needed as flow.hpp says.
std::string ways_in(const Commands& commands) {
  const Sequence sequence(assembled(commands));
  EXPECT_TRUE(sequence.good());
  if (sequence.native() == nullptr) return "none";
  const std::span<const uint16_t> needs = sequence.native()->native().needs;
  std::string out;
  for (const vm::jit::Command& command : vm::jit::Program(sequence.image()).commands) {
    out += needs[command.at] == 0 ? '-' : '+';
    if (needs[command.at] != 0) {
      EXPECT_EQ(needs[command.at], command.need) << "command " << out.size();
    }
  }
  return out;
}

// With all budgets up to so many, for these values of H1 to H4.
void expect_same(const Commands& commands, uint32_t most) {
  const Sequence sequence(assembled(commands));
  ASSERT_TRUE(sequence.good());
  for (const auto& [one, two] : {std::pair{0, 0}, {1, 2}, {2, 1}, {3, -5}})
    ASSERT_NO_FATAL_FAILURE(sequence.expect_equal({0, one, two, two - one, one}, most)) << one << ", " << two;
}

struct Shape {
  const char* what;
  Commands commands;
  std::string ways;
};

void expect_shapes(const std::vector<Shape>& shapes) {
  for (const Shape& shape : shapes) {
    EXPECT_EQ(ways_in(shape.commands), shape.ways) << shape.what;
    ASSERT_NO_FATAL_FAILURE(expect_same(shape.commands, 24)) << shape.what;
  }
}

TEST_F(WaysIn, EachCommandHasOneButThoseOfTheHostLongBlocksEndsAndFaults) {
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    Instruction command{row.opcode, {}};
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) {
      if (row.operands[n].kind == vm::OperandKind::Keyword) command.operands[n] = row.opcode == Opcode::Scom;
      if (row.operands[n].kind == vm::OperandKind::Count) command.operands[n] = 1;
      if (row.operands[n].kind == vm::OperandKind::Constant) command.operands[n] = 2;
    }
    const bool other = row.flow == vm::Flow::System || row.flow == vm::Flow::SystemCall ||
                       row.flow == vm::Flow::End;
    EXPECT_EQ(ways_in({command, kNop, kEnd}), other ? "-+-" : "++-") << row.text;
  }
  expect_shapes({{"a long block", {I(Opcode::Copy, 1, 20, 9), kNop, kEnd}, "-+-"},
                 {"a division by 0", {I(Opcode::DivHK, 1, 0), kNop, kEnd}, "-+-"},
                 {"a remainder by 0", {kNop, I(Opcode::ModHK, 1, 0), kEnd}, "+--"}});
}

// Four comparisons and more of one variable, with constants that count up, are a table.
TEST_F(WaysIn, ComparisonsWithConstantsThatFollowEachOtherAreOneJump) {
  for (int32_t count = 1; count <= 6; ++count)
    for (const int32_t first : {-1, 0, 2}) {
      Commands commands{add(2, 1)};
      const int32_t cases = count + 3;
      for (int32_t n = 0; n < count; ++n) commands.push_back(equal(1, first + n, cases + 2 * n));
      commands.push_back(set(3, -1));
      commands.push_back(kEnd);
      std::string ways = "+" + std::string(static_cast<size_t>(count), '+') + "+-";
      if (count >= 4) ways.replace(2, static_cast<size_t>(count - 1), static_cast<size_t>(count - 1), '-');
      for (int32_t n = 0; n < count; ++n) {
        commands.push_back(set(3, n));
        commands.push_back(n % 2 == 0 ? jump(count + 1) : less(2, 12, 0));
        ways += "++";
      }
      commands.push_back(kEnd);
      EXPECT_EQ(ways_in(commands), ways + "-") << count;
      ASSERT_NO_FATAL_FAILURE(expect_same(commands, 16)) << count << " from " << first;
    }
  expect_shapes({
      {"another variable",
       {equal(1, 0, 5), equal(1, 1, 5), equal(2, 2, 5), equal(1, 3, 5), kEnd, kEnd},
       "++++--"},
      {"a gap", {equal(1, 0, 5), equal(1, 1, 5), equal(1, 2, 5), equal(1, 4, 5), kEnd, kEnd}, "++++--"},
      {"the other way round",
       {equal(1, 3, 5), equal(1, 2, 5), equal(1, 1, 5), equal(1, 0, 5), kEnd, kEnd},
       "++++--"},
      {"another test",
       {equal(1, 0, 5), equal(1, 1, 5), equal(1, 2, 5), I(Opcode::JmpNeHK, 1, 3, 5), kEnd, kEnd},
       "++++--"},
      {"a label in it",
       {equal(2, 9, 3), equal(1, 0, 6), equal(1, 1, 6), equal(1, 2, 6), equal(1, 3, 6), kEnd, kEnd},
       "+++++--"},
      {"a label in front of it",
       {equal(2, 9, 1), equal(1, 0, 6), equal(1, 1, 6), equal(1, 2, 6), equal(1, 3, 6), kEnd, kEnd},
       "++-----"},
      {"behind others",
       {equal(1, 7, 6), equal(1, 0, 6), equal(1, 1, 6), equal(1, 2, 6), equal(1, 3, 6), kEnd, kEnd},
       "++-----"},
      {"around the largest number",
       {equal(1, INT32_MAX - 1, 5), equal(1, INT32_MAX, 5), equal(1, INT32_MIN, 5),
        equal(1, INT32_MIN + 1, 5), kEnd, kEnd},
       "+-----"},
  });
}

// A test of what a command has just made looks at the processor's flags.
TEST_F(WaysIn, ATestForZeroBehindAnOperationBelongsToIt) {
  const auto loop = [](const Instruction& operation, Opcode test, int32_t variable, int32_t k) {
    return Commands{kNop, operation, I(test, variable, k, 4), add(3, 1), add(4, 1), less(4, 9, 1), kEnd};
  };
#if defined(__x86_64__)
  for (const Opcode operation : {Opcode::AddHK, Opcode::SubHK, Opcode::AndHK, Opcode::OrHK, Opcode::XorHK})
    for (const Opcode test : {Opcode::JmpEqHK, Opcode::JmpNeHK, Opcode::JmpLtHK, Opcode::JmpGeHK})
      EXPECT_EQ(ways_in(loop(I(operation, 1, 1), test, 1, 0)), "++-+++-") << vm::info(operation).text;
#endif
  for (const Opcode test : {Opcode::JmpEqHK, Opcode::JmpNeHK, Opcode::JmpLtHK, Opcode::JmpLeHK,
                            Opcode::JmpGtHK, Opcode::JmpGeHK}) {
    for (const int32_t k : {-1, 1})
      EXPECT_EQ(ways_in(loop(add(1, 1), test, 1, k)), "++++++-") << vm::info(test).text << " not with 0";
    EXPECT_EQ(ways_in(loop(add(1, 1), test, 2, 0)), "++++++-") << vm::info(test).text << " of another";
    EXPECT_EQ(ways_in(loop(set(1, 1), test, 1, 0)), "++++++-") << vm::info(test).text << " of no result";
    for (const int32_t variable : {1, 2})
      for (const int32_t k : {-1, 0, 1})
        for (const Instruction& operation :
             {add(1, -1), set(1, 0), I(Opcode::AddHH, 1, 2), I(Opcode::SubHH, 2, 1)})
          ASSERT_NO_FATAL_FAILURE(expect_same(loop(operation, test, variable, k), 12));
  }
  // Who comes to the test from elsewhere has other flags.
  expect_shapes({
      {"a label at the test",
       {add(2, 1), equal(3, 2, 3), add(1, -1), equal(1, 0, 5), add(3, 4), add(4, 1), less(4, 9, 0), kEnd},
       "+++++++-"},
      {"two operations in front",
       {add(1, -1), add(2, 1), equal(1, 0, 4), add(3, 4), add(4, 1), less(4, 9, 0), kEnd},
       "++++++-"},
      {"two tests",
       {add(1, -1), less(2, 0, 4), equal(1, 0, 4), add(3, 4), add(4, 1), less(4, 9, 0), kEnd},
       "++++++-"},
      {"a test behind a NOP",
       {add(1, -1), kNop, equal(1, 0, 4), add(3, 4), add(4, 1), less(4, 9, 0), kEnd},
       "++++++-"},
  });
}

#if defined(__x86_64__)
// SET and one operation on it are one instruction where both variables have registers, and so are two sums.
TEST_F(WaysIn, TwoCommandsThatBecomeOneHaveOneWay) {
  const auto loop = [](const Instruction& first, const Instruction& second) {
    return Commands{kNop, first, second, less(4, 9, 0), kEnd};
  };
  const auto plus = [](int32_t a, int32_t b) { return I(Opcode::AddHH, a, b); };
  const auto minus = [](int32_t a, int32_t b) { return I(Opcode::SubHH, a, b); };
  const auto times = [](int32_t a, int32_t k) { return I(Opcode::MulHK, a, k); };
  struct Row {
    Instruction first, second;
    bool one;
  };
  for (const Row& row : {Row{copy(1, 2), add(1, 5), true},
                         {copy(1, 2), I(Opcode::SubHK, 1, 5), true},
                         {copy(1, 2), times(1, 5), true},
                         {copy(1, 2), times(1, 7), true},
                         {copy(1, 2), plus(1, 3), true},
                         {copy(1, 2), plus(1, 2), true},
                         {copy(1, 2), plus(1, 1), false},
                         {copy(1, 2), minus(1, 3), false},
                         {copy(1, 1), add(1, 5), false},
                         {copy(1, 2), add(2, 5), false},
                         {copy(1, 2), add(3, 5), false},
                         {set(1, 2), add(1, 5), false},
                         {copy(1, 2), I(Opcode::AndHK, 1, 5), false},
                         {plus(1, 2), plus(1, 3), true},
                         {plus(1, 2), minus(1, 3), true},
                         {minus(1, 2), plus(1, 3), true},
                         {minus(1, 2), minus(1, 3), true},
                         {plus(1, 2), plus(1, 2), true},
                         {plus(1, 2), plus(3, 2), false},
                         {plus(1, 1), plus(1, 2), false},
                         {plus(1, 2), plus(1, 1), false},
                         {plus(1, 2), add(1, 3), false},
                         {add(1, 3), plus(1, 2), false}}) {
    const std::string name =
        std::string(vm::info(row.first.opcode).text) + "; " + vm::info(row.second.opcode).text.data();
    EXPECT_EQ(ways_in(loop(row.first, row.second)), row.one ? "++-+-" : "++++-") << name;
    ASSERT_NO_FATAL_FAILURE(expect_same(loop(row.first, row.second), 12)) << name;
    // A label at the second, and nothing of it in a register.
    Commands joined = loop(row.first, row.second);
    joined[0] = equal(3, 2, 2);
    EXPECT_EQ(ways_in(joined), "++++-") << name;
    ASSERT_NO_FATAL_FAILURE(expect_same(joined, 12)) << name;
    EXPECT_EQ(ways_in({kNop, row.first, row.second, kEnd}), "+++-") << name;
  }
}
#endif

// A JMP behind a SET of a constant to tests of it goes where they lead. Who enters at the JMP may have another value, so
// there is no way in.
TEST_F(WaysIn, AJumpBehindASetIsDecided) {
  const auto not_equal = [](int32_t variable, int32_t k, int32_t to) {
    return I(Opcode::JmpNeHK, variable, k, to);
  };
  expect_shapes({
      {"to a case",
       {equal(1, 1, 5), equal(1, 2, 8), add(3, 1), add(2, 1), kEnd, add(2, 3), set(1, 2), jump(0), add(2, 5),
        kEnd},
       "++++-++-+-"},
      {"to the second case from the first",
       {equal(1, 1, 4), equal(1, 2, 7), add(3, 1), jump(9), add(2, 3), set(1, 2), jump(0), set(1, 3), jump(0),
        kEnd},
       "++++++-++-"},
      {"by a test that it is not",
       {not_equal(1, 2, 4), add(2, 1), add(3, 1), kEnd, add(2, 3), set(1, 3), less(2, 20, 8), kEnd, jump(0)},
       "+++-+++-+"},
      {"by a test of a copy",
       {copy(2, 1), equal(2, 1, 5), equal(2, 2, 8), add(3, 1), kEnd, add(4, 3), set(1, 2), jump(0), add(4, 5),
        kEnd},
       "++++-++-+-"},
      {"by a test of a copy of a copy",
       {copy(2, 1), copy(3, 2), equal(3, 1, 6), equal(3, 2, 9), add(4, 1), kEnd, add(4, 3), set(1, 2),
        jump(0), add(4, 5), kEnd},
       "+++++-++-+-"},
      {"to what begins nothing",
       {equal(1, 1, 4), equal(1, 2, 7), add(3, 1), kEnd, add(2, 3), set(1, 5), jump(0), add(2, 5), kEnd},
       "+++-++++-"},
      {"to no test", {add(3, 1), less(3, 9, 4), kEnd, kNop, set(1, 2), jump(0), kEnd}, "++-+++-"},
      {"to a test of another",
       {equal(2, 9, 4), add(2, 1), less(2, 9, 4), kEnd, set(1, 2), jump(0), kEnd},
       "+++-++-"},
      {"behind another command",
       {equal(1, 1, 4), equal(1, 2, 8), add(3, 1), kEnd, set(1, 2), kNop, jump(0), kEnd, add(2, 5), kEnd},
       "+++-+++-+-"},
      {"a label at the JMP",
       {equal(1, 1, 4), equal(1, 2, 8), less(2, 1, 6), kEnd, kNop, set(1, 2), jump(0), kEnd, add(2, 5), kEnd},
       "+++-+++-+-"},
      {"a sum, not a SET",
       {equal(1, 1, 4), equal(1, 2, 8), add(3, 1), kEnd, kNop, add(1, 1), jump(0), kEnd, add(2, 5), kEnd},
       "+++-+++-+-"},
  });
  // Sixty-four commands are gone through, not more.
  for (const int32_t value : {62, 63, 64, 65}) {
    Commands commands;
    constexpr int32_t kTests = 70;
    for (int32_t n = 0; n < kTests; ++n) commands.push_back(equal(1, 2 * n, kTests + 5));
    for (const Instruction& command : {add(3, 1), kEnd, kNop, set(1, 2 * value), jump(0), add(2, 1), kEnd})
      commands.push_back(command);
    EXPECT_EQ(ways_in(commands)[kTests + 4], value < 64 ? '-' : '+') << value;
  }
}

// The end of a loop that is short is repeated in place of a jump to it, the jump decided or not.
TEST_F(WaysIn, ShortEndsOfLoopsAreRepeated) {
  for (int32_t length = 0; length <= 5; ++length)
    for (const auto& [known, changed] : {std::pair{false, 3}, {true, 3}, {true, 1}})
      for (const bool returns : {false, true}) {
        // if (H1 == 1) H2 += 5; else H2 += 7; and the end of the loop, or of a subroutine. There H1 may change.
        Commands commands{returns ? I(Opcode::Call, 3) : kNop, returns ? less(4, 9, 0) : kNop,
                          returns ? kEnd : kNop};
        const auto head = static_cast<int32_t>(commands.size());
        commands.push_back(equal(1, 1, head + 4));
        commands.push_back(add(2, 5));
        commands.push_back(known ? set(1, 1) : add(2, 1));
        commands.push_back(jump(head + 5));
        commands.push_back(add(2, 7));
        for (int32_t n = 0; n < length; ++n) commands.push_back(n == 1 ? set(changed, 2) : add(4, n + 1));
        commands.push_back(returns ? kRet : less(4, 40, head));
        for (const Instruction& command : {add(2, 100), kEnd}) commands.push_back(command);
        ASSERT_NO_FATAL_FAILURE(expect_same(commands, 24)) << length << known << changed << returns;
      }
}

// Two states that lead to each other, until the end of the loop does not lead back: it is left from either of them.
TEST_F(WaysIn, StateMachinesEndBehindAnyState) {
  for (int32_t length = 0; length <= 4; ++length)
    for (int32_t limit = 20; limit <= 28; ++limit) {
      Commands commands{kNop,      equal(1, 1, 6), equal(1, 2, 9), add(4, 1), set(1, 1), jump(11),
                        add(4, 3), set(1, 2),      jump(11),       add(4, 5), set(1, 1)};
      for (int32_t n = 0; n < length; ++n) commands.push_back(add(2 + n % 2, n + 1));
      for (const Instruction& command : {less(4, limit, 1), add(2, 100), add(3, 50), kEnd})
        commands.push_back(command);
      ASSERT_NO_FATAL_FAILURE(expect_same(commands, 12)) << length << ", " << limit;
    }
}

// What is in the way of that: a command that is not machine code, one that may fault, one that others come to, a branch, a
// call, a loop.
TEST_F(WaysIn, EndsOfLoopsWithMoreInThemAreJumpedTo) {
  constexpr int32_t kTail = 6, kSub = 14;
  const Instruction tails[][2] = {{add(4, 1), kNop},
                                  {add(4, 1), I(Opcode::Copy, 10, 1, 9)},
                                  {I(Opcode::Copy, 10, 1, 9), add(4, 1)},
                                  {add(4, 1), I(Opcode::DivHH, 3, 1)},
                                  {add(4, 1), I(Opcode::DivHK, 3, 0)},
                                  {add(4, 1), I(Opcode::SetiLoad, 3, 2)},
                                  {add(4, 1), I(Opcode::WaitK, 0)},
                                  {add(4, 1), equal(1, 2, kTail + 2)},
                                  {add(4, 1), equal(1, 2, kTail + 4)},
                                  {add(4, 1), less(4, 2, kTail)},
                                  {add(4, 1), I(Opcode::Call, kSub)},
                                  {I(Opcode::Call, kSub), add(4, 1)}};
  for (const auto& tail : tails)
    for (const int32_t into : {kTail, kTail + 1, kTail + 2})
      for (const bool known : {false, true}) {
        Commands commands{kNop,        equal(1, 1, 5), add(2, 5), known ? set(1, 1) : add(2, 1),
                          jump(kTail), add(2, 7)};
        for (const Instruction& command : {tail[0], tail[1], less(4, 40, 1), add(2, 100), less(2, 0, into),
                                           jump(12), kEnd, kEnd, add(2, 9), kRet})
          commands.push_back(command);
        ASSERT_NO_FATAL_FAILURE(expect_same(commands, 16))
            << vm::info(tail[0].opcode).text << ", " << vm::info(tail[1].opcode).text << " " << into << known;
      }
}

// A state that was saved may have any command as the one to return to.
TEST_F(WaysIn, ARetLeadsToAnyCommand) {
  const Sequence sequence(
      assembled({jump(6), add(1, 1), add(2, 1), kRet, kNop, kEnd, I(Opcode::Call, 1), add(3, 1),
                 equal(3, 3, 11), I(Opcode::Copy, 10, 1, 9), jump(6), I(Opcode::WaitK, 0), add(4, 1), kEnd}));
  ASSERT_TRUE(sequence.good());
  constexpr size_t kFirstCall = 20;  // of task 1, in the bytes of a state
  for (const vm::jit::Command& command : vm::jit::Program(sequence.image()).commands) {
    const auto back_to_it = [&](vm::Machine& machine) {
      machine.run(1, 3);
      ASSERT_EQ(machine.task(1).depth, 1);
      std::vector<uint8_t> state(vm::SavedState::size(machine.program()));
      vm::SavedState::write(machine, state.data());
      ASSERT_EQ(state[kFirstCall] + 256 * state[kFirstCall + 1], machine.task(1).calls[0]);
      state[kFirstCall] = static_cast<uint8_t>(command.at);
      ASSERT_TRUE(vm::SavedState::check(machine.program(), state.data()));
      vm::SavedState::read(state.data(), machine);
      ASSERT_EQ(machine.task(1).calls[0], command.at);
    };
    for (uint32_t budget = 17; budget < 40; ++budget)
      ASSERT_NO_FATAL_FAILURE(sequence.expect_equal_parts({}, {budget, 50}, back_to_it)) << command.at;
  }
}

size_t size_of(const Commands& commands) {
  const Sequence sequence(assembled(commands));
  EXPECT_TRUE(sequence.good());
  return sequence.native() == nullptr ? 0 : sequence.native()->bytes();
}

// A loop along a table is there twice, with checks and without, when its indexes can be good.
TEST_F(WaysIn, ALoopAlongATableIsThereTwice) {
  constexpr int32_t kVariables = kRowLimits.variables;
  for (const Opcode test : {Opcode::JmpLtHK, Opcode::JmpLeHK}) {
    const auto loop = [&](int32_t counter, int32_t other, int32_t limit) {
      return Commands{set(counter, 10), I(Opcode::SetiStore, counter, other), add(counter, 1),
                      I(test, counter, limit, 1), kEnd};
    };
    // The counter in the first register and in the second.
    for (const auto& [counter, other] : {std::pair{1, 2}, {2, 1}}) {
      const int32_t last = test == Opcode::JmpLtHK ? kVariables : kVariables - 1;
      const size_t twice = size_of(loop(counter, other, last)),
                   once = size_of(loop(counter, other, last + 1));
      EXPECT_GT(twice, once + 10) << "the largest good limit";
      ASSERT_NO_FATAL_FAILURE(expect_same(loop(counter, other, last), 20));
      ASSERT_NO_FATAL_FAILURE(expect_same(loop(counter, other, last + 1), 20));
    }
  }
}

}  // namespace
}  // namespace ipos::tests
