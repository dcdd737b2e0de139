// Leaving out milliseconds (Machine::idle_ticks, skip_ticks): the machine that executes every command is the expected
// value. docs/inside/cycle.md has the rules.
#include <gtest/gtest.h>

#include "tests/vm/assembled.hpp"

namespace ipos::vm {
namespace {

using tests::Assembled;

// What of a machine a skip may change, task by task.
void expect_equal_machines(const Machine& skips, const Machine& runs) {
  for (int number = 1; number <= kContexts; ++number) {
    const TaskContext &is = skips.context(number), &should = runs.context(number);
    EXPECT_EQ(is.state, should.state) << number;
    EXPECT_EQ(is.pc, should.pc) << number;
    EXPECT_EQ(is.wait_ms, should.wait_ms) << number;
    EXPECT_EQ(is.commands, should.commands) << number;
  }
  for (size_t n = 0; n < runs.variables().size(); ++n)
    ASSERT_EQ(skips.variables()[n], runs.variables()[n]) << "H" << n;
  EXPECT_EQ(skips.interrupts().turn, runs.interrupts().turn);
}

// Loops of 2, 3 and 5 commands, one for each task.
const char* const kThreeLoops = R"(
      TASK2 START , M02
      TASK START , M03
M01 : NOP
      JMP M01
M02 : NOP
      NOP
      JMP M02
M03 : SET H3 = H4
      ADD H3 + 1
      SET H3 = H4
      NOP
      JMP M03
)";

// Each task has a number of commands of its own, so each stands elsewhere in its loop after each millisecond. A task
// without commands stays where it is.
TEST(IdleSkip, EachTaskExecutesItsOwnNumberOfCommands) {
  for (const std::array<uint32_t, kTasks>& budgets : {std::array<uint32_t, kTasks>{1, 2, 4},
                                                      {7, 1, 3},
                                                      {4, 7, 1},
                                                      {0, 4, 9},
                                                      {3, 0, 8},
                                                      {5, 4, 0},
                                                      {0, 0, 0}})
    for (const uint64_t ticks : {1, 2, 3, 7, 100}) {
      SCOPED_TRACE(testing::Message()
                   << budgets[0] << " " << budgets[1] << " " << budgets[2] << ", " << ticks);
      Assembled run(kThreeLoops);
      for (int n = 0; n < 5; ++n) run.tick(10);
      Machine runs = run.machine();
      EXPECT_EQ(run->idle_ticks(budgets), kIdleForever);
      EXPECT_EQ(run->skip_ticks(budgets, ticks), ticks * (budgets[0] + budgets[1] + budgets[2]));
      for (uint64_t n = 0; n < ticks; ++n) run_tick(runs, Rates{budgets});
      expect_equal_machines(run.machine(), runs);
    }
}

// Waits count down meanwhile, each by as many ms; the first one that ends bounds the skip.
TEST(IdleSkip, WaitsGoOn) {
  Assembled run(R"(
      TASK2 START , M02
      WAIT 100
      END
M02 : WAIT 40
      SET H0 = 7
      END
)");
  run.tick();
  run.tick(0);
  Machine runs = run.machine();
  constexpr std::array<uint32_t, kTasks> kBudgets{10, 10, 10};
  EXPECT_EQ(run->idle_ticks(kBudgets), 38U) << "one of the 40 has passed, with the last one the task goes on";
  EXPECT_EQ(run->skip_ticks(kBudgets, 38), 0U);
  for (int n = 0; n < 38; ++n) run_tick(runs, Rates{kBudgets});
  expect_equal_machines(run.machine(), runs);
  EXPECT_EQ(run->idle_ticks(kBudgets), 0U);
  run.tick();
  EXPECT_EQ(run.h(0), 7);
}

// One of the installed interrupts is looked at in a millisecond (IPOSplus p. 45), so the turn goes on with the skip.
TEST(IdleSkip, TheTurnOfTheInterruptsGoesOn) {
  for (int installed = 0; installed <= 3; ++installed)
    for (const uint64_t ticks : {1, 2, 3, 4, 5, 6, 7}) {
      const char* const rows[] = {"SETINT ERROR , M02\n", "SETINT TOUCHP1 , M02\n", "SETINT TIMER0 , M02\n"};
      std::string text;
      for (int n = 0; n < installed; ++n) text += rows[n];
      Assembled run(text + "M01 : JMP M01\nM02 : RET\n");
      for (int n = 0; n < 2; ++n) run.tick(10);
      Machine runs = run.machine();
      constexpr std::array<uint32_t, kTasks> kBudgets{2, 2, 2};
      EXPECT_EQ(run->idle_ticks(kBudgets), kIdleForever);
      run->skip_ticks(kBudgets, ticks);
      for (uint64_t n = 0; n < ticks; ++n) run_tick(runs, Rates{kBudgets});
      expect_equal_machines(run.machine(), runs);
    }
}

}  // namespace
}  // namespace ipos::vm
