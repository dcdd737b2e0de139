// What a program can still do (vm/sched/outlook.hpp): which commands each way through the code reaches, which variables
// they use and write, and whether tasks are apart.
#include "vm/sched/outlook.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/vm/assembled.hpp"

namespace ipos::vm {
namespace {

using tests::Assembled;

std::set<uint32_t> numbers_of(const Outlook::Variables& variables) {
  std::set<uint32_t> out;
  for (uint32_t n = 0; n < variables.size(); ++n)
    if (variables[n]) out.insert(n);
  return out;
}
using VariableNumbers = std::set<uint32_t>;

// What is behind a command and what is at its label.
TEST(Outlook, FollowsEveryWayOfACommand) {
  struct Row {
    const char* command;
    bool behind, label;
  };
  for (const Row& row : {Row{"NOP", true, false},
                         {"WAIT 5", true, false},
                         {"SCOMON", true, false},
                         {"END", false, false},
                         {"RET", false, false},
                         {"JMP M02", false, true},
                         {"JMP H9 == 0 , M02", true, true},
                         {"JMP H9 < H8 , M02", true, true},
                         {"CALL M02", true, true},
                         {"INPCALL HIGH 12 , M02", true, true},
                         {"SYSCALL STANDSTILL , M02", true, true},
                         {"TASK2 START , M02", true, true},
                         {"TASK2 STOP , M02", true, false},
                         {"TASK START , M02", true, true},
                         {"TASK STOP , M02", true, false},
                         {"SETINT ERROR , M02", true, true},
                         {"SETINT TIMER0 , M02", true, true},
                         {"SETINT TOUCHP1 , M02", true, true},
                         {"SETINT DISABLE , M02", true, false},
                         {"VARINT H20 , M02", true, true}}) {
    Assembled run(std::string("M01 : ") + row.command +
                  "\nADD H1 + 1\nEND\nM02 : SUB H2 - 1\nEND\nMUL H3 * 2\nEND\n");
    const Outlook outlook(run.machine());
    EXPECT_EQ(outlook.reaches(Opcode::AddHK), row.behind) << row.command;
    EXPECT_EQ(outlook.reaches(Opcode::SubHK), row.label) << row.command;
    EXPECT_FALSE(outlook.reaches(Opcode::MulHK)) << row.command;
  }
}

// Where a task stands, where its calls return to, and the routines that are installed or run.
TEST(Outlook, BeginsWhereTheMachineIs) {
  Assembled run(R"(
      ADD H1 + 1
      SETINT TIMER0 , M02
      VARINT H20 , M03
      TASK2 START , M04
      CALL M05
      ADD H2 + 1
M01 : JMP M01
M02 : ADD H3 + 1
      RET
M03 : ADD H4 + 1
      RET
M04 : ADD H5 + 1
      END
M05 : ADD H6 + 1
      RET
)");
  run.set(20, {1, 2, 30, 0, 1, 5});
  const auto written = [&] { return numbers_of(Outlook(run.machine()).written()); };
  EXPECT_EQ(written().size(), kMaxVariables) << "VARINT is to come, and its structure may be any";
  run.run(5);  // in the function
  EXPECT_EQ(written(), (VariableNumbers{2, 3, 4, 5, 6}));
  run.run(2);
  EXPECT_EQ(written(), (VariableNumbers{2, 3, 4, 5}));
  run.run(1);
  EXPECT_EQ(written(), (VariableNumbers{3, 4, 5}));
  run->run(2, 10);
  EXPECT_EQ(written(), (VariableNumbers{3, 4})) << "task 2 has ended, the interrupts stay";
  run->raise_event(Event::Timer0);
  run->tick();
  run->stop_task(1);
  EXPECT_EQ(written(), (VariableNumbers{3, 4}));
  run->start();
  run->stop_all();
  EXPECT_EQ(written(), VariableNumbers{}) << "nothing runs, nothing is installed";
}

// Behind each call that is open the program goes on.
TEST(Outlook, KnowsAllOpenCalls) {
  Assembled run(R"(
      CALL M01
      ADD H1 + 1
      END
M01 : CALL M02
      ADD H2 + 1
      RET
M02 : CALL M03
      ADD H3 + 1
      RET
M03 : ADD H4 + 1
      RET
)");
  const auto written = [&] { return numbers_of(Outlook(run.machine()).written()); };
  run.run(3);
  EXPECT_EQ(written(), (VariableNumbers{1, 2, 3, 4}));
  run.run(2);
  EXPECT_EQ(written(), (VariableNumbers{1, 2, 3}));
  run.run(2);
  EXPECT_EQ(written(), (VariableNumbers{1, 2}));
  run.run(2);
  EXPECT_EQ(written(), (VariableNumbers{1}));
}

// A routine that runs goes on also when its interrupt is gone.
TEST(Outlook, ARoutineThatRunsCounts) {
  Assembled run(R"(
      SETINT TIMER0 , M02
M01 : JMP H9 == 0 , M01
      END
M02 : SETINT DISABLE , M02
      ADD H3 + 1
      RET
)");
  run.tick();
  run->raise_event(Event::Timer0);
  run->tick();
  run.run(1);
  EXPECT_EQ(numbers_of(Outlook(run.machine()).written()), (VariableNumbers{3}));
  run.run(2);
  EXPECT_EQ(numbers_of(Outlook(run.machine()).written()), VariableNumbers{});
}

// What a command reads and writes, and whether it can fault, stop the loop or ask the host.
TEST(Outlook, KnowsWhatCommandsDo) {
  VariableNumbers all;
  for (uint32_t n = 0; n < kMaxVariables; ++n) all.insert(n);
  struct Row {
    const char* command;
    VariableNumbers used, written;
    bool faults, stops, calls;
  };
  for (const Row& row : {Row{"NOP", {}, {}, false, false, false},
                         {"SET H1 = 5", {1}, {1}, false, false, false},
                         {"SET H1 = H2", {1, 2}, {1}, false, false, false},
                         {"ADD H1 + H2", {1, 2}, {1}, false, false, false},
                         {"JMP H3 == H4 , M01", {3, 4}, {}, false, false, false},
                         {"JMP H3 == 4 , M01", {3}, {}, false, false, false},
                         {"BMOV H1.2 = H7.3", {1, 7}, {1}, false, false, false},
                         {"COPY H10 = H20 , 3", {10, 11, 12, 20, 21, 22}, {10, 11, 12}, false, false, false},
                         {"COPY H10 = H20 , 1", {10, 20}, {10}, false, false, false},
                         {"DIV H1 / 3", {1}, {1}, false, false, false},
                         {"DIV H1 / 0", {1}, {1}, true, true, false},
                         {"MOD H1 MOD H2", {1, 2}, {1}, true, true, false},
                         {"SETI [H1] = H2", all, all, true, true, false},
                         {"SETI H1 = [H2]", all, {1}, true, true, false},
                         {"CALL M02", {}, {}, true, true, false},
                         {"WAIT 5", {}, {}, false, true, false},
                         {"WAIT H1", {1}, {}, false, true, false},
                         {"SCOMON", {}, {}, true, true, true},
                         {"MOVLNK H30", {30}, {}, true, true, true},
                         {"SYSCALL STANDSTILL , M02", {}, {}, true, true, true}}) {
    Assembled run(std::string("M01 : ") + row.command + "\nJMP M01\nM02 : JMP M02\n");
    const Outlook outlook(run.machine());
    EXPECT_EQ(numbers_of(outlook.used()), row.used) << row.command;
    EXPECT_EQ(numbers_of(outlook.written()), row.written) << row.command;
    EXPECT_EQ(outlook.may_fault(), row.faults) << row.command;
    EXPECT_EQ(outlook.may_stop(), row.stops) << row.command;
    EXPECT_EQ(outlook.calls(), row.calls) << row.command;
    EXPECT_TRUE(outlook.apart()) << "one task";
  }
  for (const char* const last : {"END", "RET", "WAIT 5\nJMP M01", "TASK2 STOP , M01\nJMP M01"}) {
    Assembled run(std::string("M01 : ") + last + "\n");
    EXPECT_TRUE(Outlook(run.machine()).may_stop()) << last;
    EXPECT_FALSE(Outlook(run.machine()).may_fault()) << last;
  }
}

// Each pair of tasks, and the interrupts of each: apart as long as none writes what another one uses.
TEST(Outlook, TasksAreApartThatDoNotShareWhatIsWritten) {
  struct Row {
    const char *one, *other;
    bool apart;
  };
  const Row rows[] = {
      {"ADD H1 + 1", "ADD H2 + 1", true},           {"ADD H1 + 1", "ADD H1 + 1", false},
      {"SET H1 = H5", "SET H2 = H5", true},         {"SET H1 = H5", "SET H2 = H1", false},
      {"SET H1 = H5", "JMP H1 == 0 , M05", false},  {"SET H1 = H5", "JMP H5 == 0 , M05", true},
      {"COPY H10 = H20 , 3", "ADD H12 + 1", false}, {"COPY H10 = H20 , 3", "ADD H13 + 1", true},
      {"COPY H10 = H20 , 3", "ADD H22 + 1", false}, {"SETI H1 = [H5]", "NOP", true},
      {"SETI H1 = [H5]", "ADD H2 + 1", false},      {"SETI [H5] = H1", "JMP H2 == 0 , M05", false}};
  for (const Row& row : rows)
    for (const bool exchanged : {false, true})
      for (const auto& [first, second] : {std::pair(1, 2), std::pair(1, 3), std::pair(2, 3)}) {
        const char* const bodies[] = {exchanged ? row.other : row.one, exchanged ? row.one : row.other};
        std::string body[3] = {"NOP", "NOP", "NOP"};
        body[first - 1] = bodies[0];
        body[second - 1] = bodies[1];
        Assembled run("TASK2 START , M02\nTASK START , M03\nM01 : " + body[0] + "\nJMP M01\nM02 : " +
                      body[1] + "\nJMP M02\nM03 : " + body[2] + "\nJMP M03\nM05 : JMP M05\n");
        EXPECT_EQ(Outlook(run.machine()).apart(), row.apart)
            << row.one << ", " << row.other << " " << first << second;
      }
  // An interrupt is of its task: with what that shares it is not apart from itself.
  for (const bool shares : {false, true}) {
    Assembled run(
        std::string(
            "SETINT TIMER0 , M02\nTASK2 START , M03\nM01 : ADD H1 + 1\nJMP M01\nM02 : ADD H1 + 1\nRET\n") +
        "M03 : ADD " + (shares ? "H1" : "H2") + " + 1\nJMP M03\n");
    run.run(2);
    EXPECT_EQ(Outlook(run.machine()).apart(), !shares);
  }
}

}  // namespace
}  // namespace ipos::vm
