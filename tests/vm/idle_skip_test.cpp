// Leaving out milliseconds (Machine::idle_ticks, skip_ticks): the machine that executes every command is the expected
// value. docs/inside/cycle.md has the rules.
#include <gtest/gtest.h>

#include "tests/vm/assembled.hpp"
#include "vm/exec/saved_state.hpp"

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
  for (size_t n = 0; n < kEvents; ++n)
    EXPECT_EQ(skips.interrupts().events[n].installed, runs.interrupts().events[n].installed) << n;
  for (size_t n = 0; n < kVariableInterrupts; ++n)
    EXPECT_EQ(skips.interrupts().variables[n].installed, runs.interrupts().variables[n].installed) << n;
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
    for (const uint64_t ticks : {1U, 2U, 3U, 7U, 100U}) {
      SCOPED_TRACE(testing::Message()
                   << budgets[0] << " " << budgets[1] << " " << budgets[2] << ", " << ticks);
      Assembled run(kThreeLoops);
      for (int n = 0; n < 5; ++n) run.tick(10);
      Machine runs = run.machine();
      Idle idle;
      EXPECT_EQ(run->idle_ticks(budgets, idle), kIdleForever);
      EXPECT_EQ(run->skip_ticks(budgets, idle, ticks), ticks * (budgets[0] + budgets[1] + budgets[2]));
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
  Idle idle;
  EXPECT_EQ(run->idle_ticks(kBudgets, idle), 38U)
      << "one of the 40 has passed, with the last one the task goes on";
  EXPECT_EQ(run->skip_ticks(kBudgets, idle, 38), 0U);
  for (int n = 0; n < 38; ++n) run_tick(runs, Rates{kBudgets});
  expect_equal_machines(run.machine(), runs);
  EXPECT_EQ(run->idle_ticks(kBudgets), 0U);
  run.tick();
  EXPECT_EQ(run.h(0), 7);
}

// One of the installed interrupts is looked at in a millisecond (IPOSplus p. 45), so the turn goes on with the skip.
TEST(IdleSkip, TheTurnOfTheInterruptsGoesOn) {
  for (int installed = 0; installed <= 3; ++installed)
    for (const uint64_t ticks : {1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
      const char* const rows[] = {"SETINT ERROR , M02\n", "SETINT TOUCHP1 , M02\n", "SETINT TIMER0 , M02\n"};
      std::string text;
      for (int n = 0; n < installed; ++n) text += rows[n];
      Assembled run(text + "M01 : JMP M01\nM02 : RET\n");
      for (int n = 0; n < 2; ++n) run.tick(10);
      Machine runs = run.machine();
      constexpr std::array<uint32_t, kTasks> kBudgets{2, 2, 2};
      Idle idle;
      EXPECT_EQ(run->idle_ticks(kBudgets, idle), kIdleForever);
      run->skip_ticks(kBudgets, idle, ticks);
      for (uint64_t n = 0; n < ticks; ++n) run_tick(runs, Rates{kBudgets});
      expect_equal_machines(run.machine(), runs);
    }
}

// Whether a loop is idle is tried out, and nothing of that stays: neither of a command that ends the task, nor of one
// that waits, in a task as in a routine that has broken into it.
TEST(IdleSkip, LookingChangesNothing) {
  for (const char* const last : {"END", "RET", "WAIT 5", "JMP M03", "DIV H0 / H1", "SETI [H9] = H0",
                                 "CALL M03", "MOVLNK H30", "TASK2 START , M03", "TASK START , M03",
                                 "SETINT ERROR , M03", "SETINT DISABLE , M03", "VARINT H10 , M03"})
    for (const bool in_routine : {false, true}) {
      SCOPED_TRACE(testing::Message() << last << " " << in_routine);
      Assembled run(std::string("SETINT TIMER0 , M03\n") + (in_routine ? "" : "JMP M03\n") +
                    "M01 : JMP M01\nM03 : ADD H2 + 1\nSUB H2 - 1\n" + last + "\nRET\n");
      run.h(9) = -1;  // no variable
      run.set(10, {1, 0, 20, 0, 1, 5});
      run.run(1);
      if (in_routine) {
        run.run(3);
        run->raise_event(Event::Timer0);
        run->tick();
        EXPECT_EQ(run->active_context(1), context_of(Event::Timer0));
      }
      run.run(2);
      const Machine before = run.machine();
      const bool loops = std::string(last) == "JMP M03";
      EXPECT_EQ(run->idle_ticks({5, 5, 5}), loops ? kIdleForever : 0);
      expect_equal_machines(run.machine(), before);
      EXPECT_EQ(run->active_context(1), before.active_context(1));
      EXPECT_EQ(run->fault().number, 0);
    }
}

// Task 1 goes round with one command, task 2 changes H6 for a moment: idle as long as task 1 does not use H6.
TEST(IdleSkip, OnlyWhatALoopUsesCounts) {
  struct Row {
    const char* command;
    int32_t index;  // in H1
    bool idle;
  };
  for (const Row& row :
       {Row{"SETI [H1] = H2", 5, true}, Row{"SETI [H1] = H2", 6, false}, Row{"SETI [H1] = H2", 7, true},
        Row{"SETI H2 = [H1]", 5, true}, Row{"SETI H2 = [H1]", 6, false}, Row{"SETI H2 = [H1]", 7, true},
        Row{"SETI [H6] = H2", 9, false}, Row{"COPY H10 = H3 , 3", 0, true},
        Row{"COPY H10 = H4 , 3", 0, false}, Row{"COPY H10 = H7 , 3", 0, true},
        Row{"COPY H3 = H10 , 3", 0, true}, Row{"COPY H4 = H10 , 3", 0, false}, Row{"SET H2 = H6", 0, false},
        Row{"SET H2 = H7", 0, true}, Row{"NOP", 0, true}}) {
    SCOPED_TRACE(testing::Message() << row.command << " " << row.index);
    Assembled run(std::string("TASK2 START , M02\nM01 : ") + row.command +
                  "\nJMP M01\nM02 : ADD H6 + 1\nSUB H6 - 1\nJMP M02\n");
    run.h(1) = row.index;
    run.run(5);
    EXPECT_EQ(run->idle_ticks({4, 4, 4}), row.idle ? kIdleForever : 0);
  }
}

// The unit looks at its system variables, H453 to H564, in every millisecond, and so it does at the variable that a
// variable interrupt watches.
TEST(IdleSkip, WhatTheUnitLooksAtDoesNotChangeForAMoment) {
  for (const int number : {452, 453, 454, 500, 563, 564, 565}) {
    const std::string h = "H" + std::to_string(number);
    Assembled run("M01 : ADD " + h + " + 1\nSUB " + h + " - 1\nJMP M01\n");
    EXPECT_EQ(run->idle_ticks({4, 4, 4}), number < 453 || number > 564 ? kIdleForever : 0) << h;
  }
  for (const int watched : {19, 20, 21}) {
    Assembled run(
        "TASK2 START , M02\nVARINT H10 , M02\nM01 : ADD H20 + 1\nSUB H20 - 1\nJMP M01\nM02 : JMP M02\n");
    run.set(10, {1, 0, watched, 0, 1, 5});
    run.run(2);
    EXPECT_EQ(run->idle_ticks({3, 3, 3}), watched == 20 ? 0 : kIdleForever) << watched;
  }
}

// A loop may change up to 64 variables for a moment, in blocks and one by one; with more it is executed. In every case
// looking changes nothing, and what is left out is what would have been.
TEST(IdleSkip, VariablesThatChangeForAMomentAreAtMost64) {
  for (const bool blocks : {true, false})
    for (const int count : {1, 2, 5, 63, 64, 65, 66, 100}) {
      SCOPED_TRACE(testing::Message() << blocks << " " << count);
      std::string text = "M01 : NOP\n";
      if (blocks) {
        const std::string size = " , " + std::to_string(count) + "\n";
        text += "COPY H100 = H200" + size + "COPY H100 = H300" + size;
      } else {
        for (int n = 0; n < count; ++n) text += "ADD H" + std::to_string(100 + n) + " + 1\n";
        for (int n = 0; n < count; ++n) text += "SUB H" + std::to_string(100 + n) + " - 1\n";
      }
      Assembled run(text + "JMP M01\n");
      for (size_t n = 0; n < 100; ++n) {
        run.h(200 + n) = static_cast<int32_t>(1000 + n);
        run.h(100 + n) = run.h(300 + n) = static_cast<int32_t>(2000 + n);
      }
      const uint32_t round = blocks ? 4 : 2 * static_cast<uint32_t>(count) + 2;
      for (const uint32_t budget : {1U, 2U, 3U, round - 1, round + 1}) {
        const std::array<uint32_t, kTasks> budgets{budget, 0, 0};
        Machine runs = run.machine();
        Idle idle;
        const uint64_t ticks = run->idle_ticks(budgets, idle);
        EXPECT_EQ(ticks, count <= 64 ? kIdleForever : 0);
        expect_equal_machines(run.machine(), runs);
        for (int n = 0; n < 3; ++n) run_tick(runs, Rates{budgets});
        if (ticks != 0)
          run->skip_ticks(budgets, idle, 3);
        else
          for (int n = 0; n < 3; ++n) run.tick(budget);
        ASSERT_NO_FATAL_FAILURE(expect_equal_machines(run.machine(), runs));
      }
    }
}

// A program with a loop that reads, one that calls, one that changes a variable for a moment, a wait, and interrupts of
// both kinds. Task 1 may be told by H8 to leave its loop.
const char* const kWatched = R"(
      TASK2 START , M04
      TASK START , M05
      SETINT TIMER0 , M07
      VARINT H10 , M08
M01 : SET H1 = H2
      JMP H8 == 0 , M01
M02 : WAIT 20
      ADD H3 + 1
      JMP M01
M04 : CALL M06
      JMP M04
M05 : SET H5 = H6
      ADD H5 + 1
      SET H5 = H6
      JMP M05
M06 : SET H7 = H6
      RET
M07 : ADD H4 + 1
      RET
M08 : ADD H9 + 1
      RET
)";

// What somebody may do to a machine between the moment at which it was found idle and that at which the ticks are left out.
using Deed = void (*)(Assembled&);
constexpr Deed kDeeds[] = {
    [](Assembled&) {},
    [](Assembled& run) { run.h(2) = 5; },
    [](Assembled& run) { run.h(6) = 5; },
    [](Assembled& run) { run.h(1) = 5; },
    [](Assembled& run) { run.h(8) = 1; },
    [](Assembled& run) { run.h(20) = 3; },
    [](Assembled& run) { run.h(kVarIntReq) = 2; },
    [](Assembled& run) { run->raise_event(Event::Timer0); },
    [](Assembled& run) { run->run(1, 1); },
    [](Assembled& run) { run->run(2, 3); },
    [](Assembled& run) { run.tick(1); },
    [](Assembled& run) { run->stop_task(2); },
    [](Assembled& run) { run->start_task(3, run->task(3).pc); },
    [](Assembled& run) { run->stop_all(); },
    [](Assembled& run) { run->start(); },
};

// What was found of a state is of use for that state alone: whatever was done meanwhile, and however often the same finding
// is used, the machine is what one is that executes every tick.
TEST(IdleSkip, WhatWasFoundHoldsForItsStateAlone) {
  constexpr std::array<uint32_t, kTasks> kBudgets{1, 2, 5};
  for (const bool waits : {false, true})
    for (size_t deed = 0; deed < std::size(kDeeds); ++deed)
      for (const uint64_t ticks : {1U, 2U, 7U, 18U, 19U, 40U}) {
        SCOPED_TRACE(testing::Message() << waits << ", deed " << deed << ", " << ticks);
        Assembled skips(kWatched), runs(kWatched);
        Idle idle;
        for (Assembled* run : {&skips, &runs}) {
          run->set(10, {1, 1, 20, 3, 4, 5});
          run->h(8) = waits ? 1 : 0;
          for (int n = 0; n < 9; ++n) run_tick(run->machine(), Rates{{8, 8, 8}});
        }
        const uint64_t found = skips->idle_ticks(kBudgets, idle);
        EXPECT_EQ(found, waits ? 11U : kIdleForever);
        for (int time = 0; time < 3; ++time) {
          for (Assembled* run : {&skips, &runs}) kDeeds[deed](*run);
          uint64_t commands = 0;
          for (uint64_t n = 0; n < ticks; ++n) commands += run_tick(runs.machine(), Rates{kBudgets});
          EXPECT_EQ(skips->skip_ticks(kBudgets, idle, ticks), commands);
          ASSERT_NO_FATAL_FAILURE(expect_equal_machines(skips.machine(), runs.machine()));
        }
        if (deed == 0 && !waits) {
          EXPECT_EQ(idle.ticks, kIdleForever) << "it is of use again and again";
        }
        if (deed == 1 && !waits) {
          EXPECT_EQ(idle.ticks, 0U) << "it is of no use any more";
        }
      }
}

// Also a saved state that is read into the machine is another one.
TEST(IdleSkip, ARestoredMachineIsAnotherOne) {
  constexpr std::array<uint32_t, kTasks> kBudgets{1, 2, 5};
  Assembled skips(kWatched), runs(kWatched);
  for (int n = 0; n < 9; ++n) run_tick(skips.machine(), Rates{{8, 8, 8}});
  std::vector<uint8_t> state(SavedState::size(skips->program()));
  SavedState::write(skips.machine(), state.data());
  Idle idle;
  EXPECT_EQ(skips->idle_ticks(kBudgets, idle), kIdleForever);
  for (Assembled* run : {&skips, &runs}) SavedState::read(state.data(), run->machine());
  EXPECT_EQ(skips->skip_ticks(kBudgets, idle, 5), 5U * 8U);
  for (int n = 0; n < 5; ++n) run_tick(runs.machine(), Rates{kBudgets});
  EXPECT_EQ(idle.ticks, 0U);
  ASSERT_NO_FATAL_FAILURE(expect_equal_machines(skips.machine(), runs.machine()));
}

// A loop that is longer than what is looked for, or uses more variables, is executed; each within its bound of commands.
TEST(IdleSkip, LongLoopsAreExecuted) {
  for (const uint32_t length : {2U, 255U, 256U, 257U, 1000U}) {
    std::string text = "M01 : NOP\n";
    for (uint32_t n = 2; n < length; ++n) text += "NOP\n";
    Assembled run(text + "JMP M01\n");
    Idle idle;
    EXPECT_EQ(run->idle_ticks({1, 0, 0}, idle), length <= 256 ? kIdleForever : 0) << length;
    Assembled runs(text + "JMP M01\n");
    EXPECT_EQ(run->skip_ticks({3, 0, 0}, idle, 1'000), 3'000U) << length;
    for (int n = 0; n < 1'000; ++n) run_tick(runs.machine(), Rates{{3, 0, 0}});
    ASSERT_NO_FATAL_FAILURE(expect_equal_machines(run.machine(), runs.machine()));
  }
  // Four blocks of 48 variables, and one variable more.
  for (const bool more : {false, true}) {
    Assembled run(std::string("M01 : COPY H100 = H200 , 48\nCOPY H300 = H700 , 48\n") +
                  (more ? "SET H1 = H1\n" : "") + "JMP M01\n");
    EXPECT_EQ(run->idle_ticks({1, 0, 0}), more ? 0 : kIdleForever);
  }
}

}  // namespace
}  // namespace ipos::vm
