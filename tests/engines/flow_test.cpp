// What is known of a program before machine code is made of it (vm/jit/flow.hpp): each row is a small
// program and what its loops, joints, budgets, tables and hot variables are by docs/inside/performance.md. Labels are
// numbers of commands.
#include "vm/jit/flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/engines/pair.hpp"
#include "tests/vm/code.hpp"

namespace ipos::tests {
namespace {

using vm::Instruction;
using vm::Opcode;
using vm::jit::Program;
using Commands = std::vector<Instruction>;

constexpr vm::Limits kFlowLimits{64, 2048, 3, 6};

Program program_of(const Commands& commands, const vm::Limits& limits = kFlowLimits) {
  const std::vector<uint32_t> code = assembled(commands);
  const auto image = vm::verify(code, limits, {}).image;
  EXPECT_TRUE(image);
  return Program(*image);
}

Instruction jump(int32_t to) { return I(Opcode::Jmp, to); }
Instruction call(int32_t to) { return I(Opcode::Call, to); }
Instruction branch(int32_t to) { return I(Opcode::JmpLtHK, 1, 5, to); }
const Instruction kNop = I(Opcode::Nop), kRet = I(Opcode::Ret), kEnd = I(Opcode::End),
                  kAdd = I(Opcode::AddHK, 1, 1), kWait = I(Opcode::WaitK, 3);

TEST(Flow, CommandsAreFoundByTheirAddress) {
  const Commands commands{I(Opcode::SetHK, 1, 7), jump(3), kNop, I(Opcode::JmpEqHK, 1, 7, 0), kEnd};
  const Program program = program_of(commands);
  const std::vector<uint32_t> addresses{0, 2, 4, 5, 8};
  ASSERT_EQ(program.commands.size(), commands.size());
  ASSERT_EQ(program.index.size(), 9U);
  for (size_t n = 0; n < commands.size(); ++n) {
    EXPECT_EQ(program.commands[n].at, addresses[n]);
    EXPECT_EQ(program.index[addresses[n]], n);
    EXPECT_EQ(program.commands[n].instruction.opcode, commands[n].opcode);
    EXPECT_EQ(program.commands[n].flow, vm::info(commands[n].opcode).flow);
  }
  EXPECT_EQ(std::count(program.index.begin(), program.index.end(), vm::jit::kNowhere), 4);
  EXPECT_EQ(program.commands[1].target, 3U);
  EXPECT_EQ(program.commands[3].target, 0U);
  EXPECT_EQ(program.commands[0].target, vm::jit::kNowhere);
}

// "System commands, COPY of more than 8 variables, the end of a task and faults are never machine code."
TEST(Flow, MachineCodeIsAllButSystemCommandsLongBlocksEndsAndFaults) {
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    Instruction command{row.opcode, {}};
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) {
      if (row.operands[n].kind == vm::OperandKind::Keyword) command.operands[n] = row.opcode == Opcode::Scom;
      if (row.operands[n].kind == vm::OperandKind::Count || row.operands[n].kind == vm::OperandKind::Constant)
        command.operands[n] = 1;
    }
    const bool other = row.flow == vm::Flow::System || row.flow == vm::Flow::SystemCall ||
                       row.flow == vm::Flow::End;
    EXPECT_EQ(program_of({command, kEnd}).commands[0].native, !other) << row.text;
  }
  for (const Opcode opcode : {Opcode::DivHK, Opcode::ModHK})
    EXPECT_FALSE(program_of({I(opcode, 1, 0), kEnd}).commands[0].native) << "by 0";
  EXPECT_TRUE(program_of({I(Opcode::DivHH, 1, 0), kEnd}).commands[0].native);
  EXPECT_TRUE(program_of({I(Opcode::Copy, 1, 20, 8), kEnd}).commands[0].native);
  EXPECT_FALSE(program_of({I(Opcode::Copy, 1, 20, 9), kEnd}).commands[0].native);
}

struct Shape {
  const char* what;
  Commands commands;
  // Of each command a letter: '.' control comes from the command in front only; 'j' it comes from elsewhere; 'b' the
  // budget is looked at, too; 'c' a subroutine begins, or a call returns here.
  std::string joints;
  std::string depths;  // of loops, a digit a command
};

std::string joints_of(const Program& program) {
  std::string out;
  for (const vm::jit::Command& c : program.commands) {
    EXPECT_TRUE(c.joins || !c.checks) << "where the budget is looked at control comes together";
    EXPECT_TRUE(c.checks || !c.called) << "cycles close in subroutines";
    out += c.called ? 'c' : c.checks ? 'b' : c.joins ? 'j' : '.';
  }
  return out;
}

std::string depths_of(const Program& program) {
  std::string out;
  for (const vm::jit::Command& c : program.commands) out += std::to_string(c.depth);
  return out;
}

std::vector<Shape> shapes() {
  std::vector<Shape> out{
      {"a line", {kAdd, kNop, kAdd, kEnd}, "....", "0000"},
      {"a branch forward", {branch(2), kAdd, kAdd, kEnd}, "..j.", "0000"},
      {"to the next command", {branch(1), kAdd, kEnd}, ".j.", "000"},
      {"behind a JMP", {jump(2), kAdd, kAdd, kEnd}, ".jj.", "0000"},
      {"behind RET and END", {kRet, kAdd, kEnd, kAdd, kEnd}, ".j.j.", "00000"},
      {"behind a system command", {kAdd, kWait, kAdd, kEnd}, "..j.", "0000"},
      {"behind a block copy", {I(Opcode::Copy, 1, 2, 9), kAdd, kEnd}, ".j.", "000"},
      {"behind a short one", {I(Opcode::Copy, 1, 2, 8), kAdd, kEnd}, "...", "000"},
      {"a loop", {kAdd, kAdd, branch(1), kAdd, kEnd}, ".b...", "01100"},
      {"a loop that jumps", {kAdd, kAdd, jump(1), kAdd, kEnd}, ".b.j.", "01100"},
      {"a command that leads to itself", {kAdd, branch(1), jump(2), kEnd}, ".bbj", "0110"},
      {"the first command", {branch(0), kEnd}, "b.", "10"},
      {"one in another", {kAdd, kAdd, kAdd, branch(2), kAdd, branch(1), kEnd}, ".bb....", "0122110"},
      {"two ends of one loop", {kAdd, branch(0), kAdd, branch(0), kAdd, kEnd}, "b.....", "111100"},
      {"a branch in a loop", {kNop, kAdd, branch(3), kAdd, branch(1), kEnd}, ".b.j..", "011110"},
      {"one behind another", {kAdd, branch(0), kAdd, branch(2), kEnd}, "b.b..", "11110"},
      {"loops that overlap", {kAdd, kAdd, branch(0), kAdd, branch(1), kEnd}, "bb....", "122110"},
      {"a task's label", {I(Opcode::Task2, 1, 2), kAdd, kAdd, kEnd}, ".jj.", "0000"},
      {"a task's label in front", {kAdd, I(Opcode::Task2, 1, 0), kAdd, kEnd}, "j.j.", "0000"},
      {"a system call", {I(Opcode::SystemCall, 0, 3), kAdd, kEnd, kRet}, ".c.j", "0000"},
      {"a subroutine behind", {call(3), kAdd, kEnd, kAdd, kRet}, ".c.c.", "00000"},
      {"a subroutine in front is one deeper", {jump(3), kAdd, kRet, call(1), kEnd}, ".c.jc", "01100"},
      {"a subroutine behind, called in a loop",
       {kAdd, call(4), branch(0), kEnd, kAdd, kRet},
       "b.c.c.",
       "111011"},
      {"a loop in a subroutine in a loop",
       {call(3), branch(0), kEnd, kAdd, kAdd, branch(4), kRet},
       "bc.cb..",
       "1101221"},
      {"the deepest call counts",
       {call(5), kAdd, call(5), branch(1), kEnd, kAdd, kRet},
       ".c.c.c.",
       "0111011"},
      {"the first call is the deepest", {call(4), branch(0), call(4), kEnd, kAdd, kRet}, "bc.cc.", "110011"},
      {"a call of a call", {call(3), branch(0), kEnd, call(5), kRet, kAdd, kRet}, "bc.ccc.", "1101111"},
      {"calls to the front, each one deeper",
       {jump(5), kAdd, kRet, call(1), kRet, call(3), kEnd},
       ".c.ccjc",
       "0221100"},
      {"it calls itself", {call(2), kEnd, kAdd, call(2), kRet}, ".cc.c", "00777"},
      {"both ways of a branch belong to it",
       {call(3), branch(0), kEnd, branch(5), kRet, kAdd, kRet, kEnd},
       "bc.c.j.j",
       "11011110"},
      {"a JMP leads on", {call(4), branch(0), kEnd, kAdd, jump(6), kAdd, kAdd, kRet}, "bc.jcjj.", "11001011"},
      {"an END ends it", {call(3), branch(0), kEnd, kAdd, kEnd, kAdd, kEnd}, "bc.c.j.", "1101100"},
      {"behind a call it goes on",
       {call(3), branch(0), kEnd, call(6), kAdd, kRet, kRet},
       "bc.cc.c",
       "1101111"},
      {"behind a wait it goes on", {call(3), branch(0), kEnd, kWait, kAdd, kRet}, "bc.cj.", "110111"},
  };
  // Deeper than seven is as deep as seven.
  for (const int loops : {6, 7, 8, 9}) {
    Shape shape{"one in another, many", {}, "", ""};
    for (int n = 0; n < loops; ++n) {
      shape.commands.push_back(kAdd);
      shape.joints += 'b';
      shape.depths += std::to_string(std::min(n + 1, 7));
    }
    for (int n = loops - 1; n >= 0; --n) {
      shape.commands.push_back(branch(n));
      shape.joints += '.';
      shape.depths += std::to_string(std::min(n + 1, 7));
    }
    shape.commands.push_back(kEnd);
    out.push_back({shape.what, shape.commands, shape.joints + '.', shape.depths + '0'});
  }
  return out;
}

TEST(Flow, LoopsAndJoints) {
  for (const Shape& shape : shapes()) {
    const Program program = program_of(shape.commands);
    EXPECT_EQ(joints_of(program), shape.joints) << shape.what;
    EXPECT_EQ(depths_of(program), shape.depths) << shape.what;
  }
}

// Seven loops and a subroutine that is called in them, with a loop of its own: not deeper than seven.
TEST(Flow, SubroutinesAreNotDeeperThanSeven) {
  Commands commands(7, kAdd);
  commands.push_back(call(16));
  for (int n = 6; n >= 0; --n) commands.push_back(branch(n));
  commands.push_back(kEnd);
  for (const Instruction& command : {kAdd, branch(16), kRet}) commands.push_back(command);
  EXPECT_EQ(depths_of(program_of(commands)), "1234567776543210777");
}

// The most commands that can follow until the budget is looked at again, a command itself counted; nothing for those
// that are not machine code.
TEST(Flow, TheBudgetSufficesForTheLongestWay) {
  struct Row {
    const char* what;
    Commands commands;
    std::vector<int32_t> needs;
  };
  const Row rows[] = {
      {"a line", {kAdd, kAdd, kAdd, kEnd}, {3, 2, 1, 0}},
      {"up to a system command", {kAdd, kAdd, kWait, kAdd, kEnd}, {2, 1, 0, 1, 0}},
      {"the longer way straight", {branch(3), kAdd, kAdd, kAdd, kEnd}, {4, 3, 2, 1, 0}},
      {"the longer way taken", {branch(3), kAdd, kEnd, kAdd, kAdd, kEnd}, {3, 1, 0, 2, 1, 0}},
      {"a JMP leads on", {jump(3), kAdd, kEnd, kAdd, kAdd, kEnd}, {3, 1, 0, 2, 1, 0}},
      {"a loop", {kAdd, kAdd, kAdd, branch(1), kAdd, kAdd, kEnd}, {1, 5, 4, 3, 2, 1, 0}},
      {"a loop that jumps", {kAdd, kAdd, jump(1), kEnd}, {1, 2, 1, 0}},
      {"up to the loop behind", {kAdd, kAdd, kAdd, branch(2), kEnd}, {2, 1, 2, 1, 0}},
      {"a branch to a loop", {branch(3), kAdd, kAdd, kAdd, branch(3), kEnd}, {3, 2, 1, 2, 1, 0}},
      {"a JMP to a loop", {jump(2), kEnd, kAdd, branch(2), kEnd}, {1, 0, 2, 1, 0}},
      {"a call and a return end it", {kAdd, call(4), kAdd, kEnd, kAdd, kRet}, {2, 1, 1, 0, 2, 1}},
      {"two branches",
       {branch(4), branch(6), kAdd, kEnd, kAdd, kAdd, kAdd, kAdd, kAdd, kEnd},
       {6, 4, 1, 0, 5, 4, 3, 2, 1, 0}},
  };
  for (const Row& row : rows) {
    const Program program = program_of(row.commands);
    std::vector<int32_t> needs;
    for (const vm::jit::Command& command : program.commands) needs.push_back(command.need);
    EXPECT_EQ(needs, row.needs) << row.what;
  }
}

// The number that machine code keeps: in a line of commands it stays, where the budget is looked at the credit is what
// is needed, and the corrections of each way and way back from one look to the next make up for what was not used.
TEST(Flow, CreditsCostNothingInALine) {
  for (const Shape& shape : shapes()) {
    const Program program = program_of(shape.commands);
    for (size_t n = 0; n < program.commands.size(); ++n) {
      const vm::jit::Command& command = program.commands[n];
      if (command.checks) {
        EXPECT_EQ(command.credit, command.need) << shape.what;
      }
      if (command.called) {
        EXPECT_EQ(command.arrival, 0)
            << shape.what << ": who calls and who returns know nothing of each other";
      }
      if (n != 0 && !command.joins) {
        EXPECT_EQ(program.correction(program.commands[n - 1], command), 0) << shape.what << " " << n;
      }
      if (command.native && command.target == n + 1 && command.flow == vm::Flow::Branch) {
        EXPECT_EQ(program.correction(command, program.commands[n + 1]), 0) << shape.what;
      }
    }
  }
}

// Of several ways that meet one is without a correction: the branch of the innermost loop, or the first of several as
// deep; the line in front where no branch leads there; and the way back into a loop.
TEST(Flow, TheWayMostTakenNeedsNoCorrection) {
  struct Row {
    const char* what;
    Commands commands;
    std::vector<std::pair<size_t, size_t>> without, with;  // ways
  };
  const Row rows[] = {
      {"a branch, not the line", {branch(3), kAdd, kAdd, kAdd, kEnd}, {{0, 3}}, {{2, 3}}},
      {"the first of two branches",
       {branch(4), branch(4), kAdd, kAdd, kAdd, kEnd},
       {{0, 4}},
       {{1, 4}, {3, 4}}},
      {"a branch, not a JMP", {branch(5), kAdd, kAdd, jump(5), kAdd, kAdd, kEnd}, {{0, 5}}, {{3, 5}, {4, 5}}},
      {"a JMP where there is no branch",
       {branch(3), kAdd, jump(6), kAdd, kAdd, kAdd, kAdd, kEnd},
       {{2, 6}},
       {{5, 6}}},
      {"the way back into a loop", {kAdd, kAdd, kAdd, kAdd, branch(2), kAdd, kAdd, kEnd}, {{4, 2}}, {{1, 2}}},
      {"the same by a JMP",
       {kAdd, kAdd, kAdd, branch(5), jump(2), kAdd, kAdd, kAdd, kEnd},
       {{4, 2}},
       {{1, 2}}},
      {"the first of two ways back",
       {kAdd, kAdd, branch(1), kAdd, branch(1), kEnd},
       {{2, 1}},
       {{4, 1}, {0, 1}}},
      {"the branch of the inner loop",
       {branch(6), kAdd, branch(6), kAdd, branch(1), kEnd, kAdd, kEnd},
       {{2, 6}},
       {{0, 6}}},
      {"a line into a loop in a loop, and the inner loop's way back",
       {kAdd, kAdd, kAdd, branch(2), kAdd, branch(1), kAdd, kEnd},
       {{3, 2}, {5, 1}},
       {{1, 2}, {0, 1}}},
  };
  for (const Row& row : rows) {
    const Program program = program_of(row.commands);
    for (const auto& [from, to] : row.without)
      EXPECT_EQ(program.correction(program.commands[from], program.commands[to]), 0)
          << row.what << ": " << from << " to " << to;
    for (const auto& [from, to] : row.with)
      EXPECT_NE(program.correction(program.commands[from], program.commands[to]), 0)
          << row.what << ": " << from << " to " << to;
  }
}

// SETI most likely leads to the sum of the constants that make its index, as far back as sums make it; a pointer from farther
// away at least to the greatest constant that it gets anywhere.
TEST(Flow, TablesAreWhatIsAddedToTheIndex) {
  const auto add = [](int32_t to, int32_t k) { return I(Opcode::AddHK, to, k); };
  const auto set = [](int32_t to, int32_t from) { return I(Opcode::SetHH, to, from); };
  const auto set_k = [](int32_t to, int32_t k) { return I(Opcode::SetHK, to, k); };
  const Instruction load = I(Opcode::SetiLoad, 9, 2), store = I(Opcode::SetiStore, 2, 9);
  constexpr int32_t kLast = 63;
  struct Row {
    const char* what;
    Commands in_front;
    int32_t table;
  };
  std::vector<Row> rows{
      {"nothing", {}, -1},
      {"added", {add(2, 40)}, 40},
      {"added to another", {add(3, 40)}, -1},
      {"a second time", {add(2, 20), add(2, 30)}, 50},
      {"a step", {add(2, 40), add(2, 2)}, 42},
      {"a step alone", {add(2, 2)}, 2},
      {"the variable 0", {add(2, 0)}, 0},
      {"the last variable", {add(2, kLast)}, kLast},
      {"behind the last variable", {add(2, kLast + 1)}, -1},
      {"a sum behind the last variable", {add(2, 30), add(2, 40)}, 40},
      {"below the first", {add(2, -1)}, -1},
      {"behind a copy", {add(3, 40), set(2, 3)}, 40},
      {"on both sides of it", {add(3, 3), set(2, 3), add(2, 40)}, 43},
      {"added to another behind the copy", {add(3, 40), set(2, 3), add(3, 30)}, 40},
      {"added before the copy to what is overwritten", {add(2, 40), set(2, 3)}, -1},
      {"a copy serves two elements of a table", {set(2, 3), add(2, 40), add(2, 1)}, 41},
      {"and the one in front", {set(2, 3), add(2, 40), add(2, 1), add(2, -2)}, 39},
      {"a copy goes on to another table", {set(2, 3), add(2, 40), add(2, -33)}, 7},
      {"a record of a pointer set to the table", {set_k(3, 40), set(2, 3), add(2, 2)}, 42},
      {"of one that the table was added to", {add(3, 40), set(2, 3), add(2, 2)}, 42},
      {"taken away", {I(Opcode::SubHK, 2, 40)}, -1},
      {"taken away from more", {add(2, 40), I(Opcode::SubHK, 2, 3)}, 40},
      {"taken away from what is set", {set_k(2, 40), I(Opcode::SubHK, 2, 3)}, 37},
      {"set", {set_k(2, 40)}, 40},
      {"set before, and a step", {set_k(2, 40), add(2, 1)}, 41},
      {"what it is set to last", {set_k(2, 30), set_k(2, 40), set_k(2, 20)}, 20},
      {"set to no variable", {set_k(2, kLast + 1)}, -1},
      {"set to the last", {set_k(2, kLast)}, kLast},
      {"set to the first", {set_k(2, 0)}, 0},
      {"another is set", {set_k(3, 40)}, -1},
      {"set behind a copy", {set_k(3, 40), set(2, 3)}, 40},
      {"a variable is added", {set(2, 3), I(Opcode::AddHH, 2, 4), add(2, 40)}, 40},
      {"a product", {add(2, 40), I(Opcode::MulHK, 2, 3)}, -1},
      {"added to a product", {add(2, 40), I(Opcode::MulHK, 2, 3), add(2, 5)}, 5},
      {"loaded", {set_k(2, 40), I(Opcode::SetiLoad, 2, 3)}, -1},
      {"a block", {set_k(2, 40), I(Opcode::Copy, 1, 11, 2)}, -1},
      {"a block beside it", {set_k(2, 40), I(Opcode::Copy, 3, 11, 2)}, 40},
  };
  // 128 commands back it is looked for.
  for (const size_t between : {127U, 128U}) {
    Row row{"far away", Commands(between, kNop), between <= 127 ? 40 : -1};
    row.in_front.insert(row.in_front.begin(), {set_k(3, 40), set(2, 3)});
    rows.push_back(row);
  }
  for (const Row& row : rows)
    for (const Instruction& access : {load, store}) {
      Commands commands = row.in_front;
      commands.push_back(access);
      commands.push_back(kEnd);
      EXPECT_EQ(program_of(commands).commands[row.in_front.size()].table, row.table)
          << row.what << ", " << vm::info(access.opcode).text;
    }
  const Program behind = program_of({load, set_k(2, 40), add(2, 50), kEnd});
  EXPECT_EQ(behind.commands[0].table, 50) << "the greatest anywhere";
  for (const size_t n : {1U, 2U, 3U}) EXPECT_EQ(behind.commands[n].table, -1) << "no SETI";
}

std::vector<uint16_t> hottest(const Commands& commands, size_t most) {
  return hottest_variables(program_of(commands), most);
}

// "The variables with the most uses": each with the weight 8 to the power of the loops around it.
TEST(Flow, TheHottestVariablesAreThoseOfInnerLoops) {
  using Numbers = std::vector<uint16_t>;
  const auto add = [](int32_t a, int32_t b) { return I(Opcode::AddHH, a, b); };
  const auto until = [](int32_t variable, int32_t to) { return I(Opcode::JmpLtHK, variable, 5, to); };
  EXPECT_EQ(hottest({add(1, 2), add(3, 4), kEnd}, 4), Numbers{}) << "outside of loops only";
  EXPECT_EQ(hottest({add(1, 2), add(1, 3), add(1, 3), until(7, 1), kEnd}, 9), (Numbers{1, 3, 7}));
  EXPECT_EQ(hottest({add(7, 3), add(1, 3), add(1, 0), until(63, 0), kEnd}, 9), (Numbers{1, 3, 0, 7, 63}))
      << "by their numbers where they weigh the same";
  EXPECT_EQ(hottest({add(7, 3), add(1, 3), add(1, 0), until(63, 0), kEnd}, 2), (Numbers{1, 3}));
  EXPECT_EQ(hottest({add(7, 3), add(1, 3), until(1, 0), kEnd}, 0), Numbers{});
  // One use in a loop in a loop is as good as eight in the outer one.
  const Numbers expected[] = {{9, 6, 5}, {9, 5, 6}, {5, 9, 6}};
  for (const int uses : {7, 8, 9}) {
    Commands commands{kNop};
    for (int n = 0; n < uses; ++n) commands.push_back(I(Opcode::SetHK, 5, 0));
    const auto inner = static_cast<int32_t>(commands.size());
    commands.push_back(I(Opcode::SetHK, 6, 0));
    commands.push_back(until(9, inner));
    commands.push_back(until(9, 0));
    commands.push_back(kEnd);
    EXPECT_EQ(hottest(commands, 9), expected[uses - 7]) << uses;
  }
  // What is not machine code does not count, and no other operand does.
  EXPECT_EQ(hottest({I(Opcode::WaitH, 5), I(Opcode::Copy, 6, 30, 9), I(Opcode::BitMove, 20, 21, 22, 23),
                     until(9, 0), kEnd},
                    9),
            (Numbers{9, 20, 22}));
  EXPECT_EQ(hottest({I(Opcode::Copy, 6, 30, 2), until(9, 0), kEnd}, 9), (Numbers{6, 7, 9, 30, 31})) << "a short block";
}

// "None behind the beginning of a table that is used as if a loop deeper": eight times as much.
TEST(Flow, ElementsOfATableAreNotKeptInRegisters) {
  using Numbers = std::vector<uint16_t>;
  const auto loop = [](int uses, int accesses) {
    Commands commands{I(Opcode::AddHK, 2, 40)};
    for (int n = 0; n < accesses; ++n) commands.push_back(I(Opcode::SetiStore, 2, 2));
    for (int n = 0; n < uses; ++n)
      for (const int32_t number : {39, 40, 41}) commands.push_back(I(Opcode::SetHK, number, 0));
    commands.push_back(I(Opcode::JmpLtHK, 2, 5, 0));
    commands.push_back(kEnd);
    return commands;
  };
  EXPECT_EQ(hottest(loop(1, 1), 9), (Numbers{2, 39, 40, 41}));
  EXPECT_EQ(hottest(loop(1, 8), 9), (Numbers{2, 39, 40, 41}));
  EXPECT_EQ(hottest(loop(1, 9), 9), (Numbers{2, 39})) << "in front of the table it is no element";
  EXPECT_EQ(hottest(loop(2, 16), 9), (Numbers{2, 39, 40, 41}));
  EXPECT_EQ(hottest(loop(2, 17), 9), (Numbers{2, 39}));
}

}  // namespace
}  // namespace ipos::tests
