// Interrupts of task 1: priority, latency, return to what was interrupted. Expected values are the manual's
// (IPOSplus p. 45, 342) or follow from the rules docs/inside/cycle.md writes down.
#include "vm/exec/interrupts.hpp"

#include <gtest/gtest.h>

#include "tests/vm/assembled.hpp"
#include "vm/fast/predecode.hpp"

namespace ipos::vm {
namespace {

using tests::Assembled;

// Counts in H0; the routines of ERROR, TOUCH PROBE and TIMER 0 in H1, H2, H3. Three commands install.
const char* const kAllThree = R"(
      SETINT ERROR , M02
      SETINT TOUCHP1 , M03
      SETINT TIMER0 , M04
M01 : ADD H0 + 1
      JMP M01
M02 : ADD H1 + 1
      RET
M03 : ADD H2 + 1
      RET
M04 : ADD H3 + 1
      RET
)";

TEST(Interrupts, RoutineRunsOnceAndTheProgramGoesOn) {
  Assembled run(R"(
      SETINT TIMER0 , M02
M01 : ADD H0 + 1
      JMP M01
M02 : ADD H1 + 1
      RET
)");
  run->raise_event(Event::Timer0);  // nothing is installed yet
  EXPECT_EQ(run.tick(9), 9U);
  EXPECT_EQ(run.h(0), 4);
  EXPECT_EQ(run.h(1), 0);
  run->raise_event(Event::Timer0);
  EXPECT_EQ(run.tick(4), 4U);  // ADD H1, RET, ADD H0, JMP: the routine uses the commands of its task
  EXPECT_EQ(run.h(1), 1);
  EXPECT_EQ(run.h(0), 5);
  EXPECT_EQ(run->task(1).commands, 11U);
  EXPECT_EQ(run->context(context_of(Event::Timer0)).commands, 2U);
  run.tick(4);
  EXPECT_EQ(run.h(1), 1) << "one event, one run";
}

// Each routine notes the order of its beginning and end as decimal digits in H0 and takes three ticks.
TEST(Interrupts, HigherBreaksIntoLowerAndNotTheOtherWay) {
  const char* const program = R"(
      SETINT ERROR , M02
      SETINT TOUCHP1 , M03
      SETINT TIMER0 , M04
M01 : JMP M01
M02 : MUL H0 * 10
      ADD H0 + 1
      WAIT 9
      MUL H0 * 10
      ADD H0 + 2
      RET
M03 : MUL H0 * 10
      ADD H0 + 3
      WAIT 9
      MUL H0 * 10
      ADD H0 + 4
      RET
M04 : MUL H0 * 10
      ADD H0 + 5
      WAIT 9
      MUL H0 * 10
      ADD H0 + 6
      RET
)";
  Assembled rising(program);
  rising.tick();
  for (const Event event : {Event::Timer0, Event::TouchProbe, Event::Error}) {
    rising->raise_event(event);
    for (int n = 0; n < 3; ++n) rising.tick();
  }
  for (int n = 0; n < 60; ++n) rising.tick();
  EXPECT_EQ(rising.h(0), 531'246) << "T0 begins, TP, ERROR, then they end in the other order";

  Assembled falling(program);
  falling.tick();
  for (const Event event : {Event::Error, Event::TouchProbe, Event::Timer0}) {
    falling->raise_event(event);
    for (int n = 0; n < 3; ++n) falling.tick();
  }
  for (int n = 0; n < 60; ++n) falling.tick();
  EXPECT_EQ(falling.h(0), 123'456) << "each one waits for the end of those above it";
}

// One installed interrupt answers within 1 ms, two within 2, three within 3 (p. 45).
TEST(Interrupts, LatencyGrowsWithTheInstalledOnes) {
  for (size_t installed = 1; installed <= 3; ++installed) {
    std::string program;
    const char* const keywords[] = {"ERROR", "TOUCHP1", "TIMER0"};
    for (size_t n = 0; n < installed; ++n) program += std::string("SETINT ") + keywords[n] + " , M02\n";
    program += "M01 : JMP M01\nM02 : ADD H1 + 1\nRET\n";
    int worst = 0;
    for (int phase = 0; phase < 6; ++phase) {
      for (size_t event = 0; event < installed; ++event) {
        Assembled run(program);
        for (int n = 0; n <= phase; ++n) run.tick();
        run->raise_event(static_cast<Event>(event));
        int ticks = 0;
        while (run.h(1) == 0 && ticks < 10) run.tick(), ++ticks;
        worst = std::max(worst, ticks);
      }
    }
    EXPECT_EQ(worst, static_cast<int>(installed));
  }
}

TEST(Interrupts, RepeatedEventIsRememberedOnce) {
  Assembled run(R"(
      SETINT TIMER0 , M02
M01 : JMP M01
M02 : ADD H1 + 1
      WAIT 5
      RET
)");
  run.tick();
  run->raise_event(Event::Timer0);
  run.tick();
  for (int n = 0; n < 3; ++n) run->raise_event(Event::Timer0);
  for (int n = 0; n < 30; ++n) run.tick();
  EXPECT_EQ(run.h(1), 2);
}

TEST(Interrupts, DisableEndsAllThreeAndDropsWhatIsPending) {
  Assembled run(std::string("JMP M05\n") + R"(
M05 : SETINT ERROR , M02
      SETINT TOUCHP1 , M02
      SETINT TIMER0 , M02
M01 : JMP H5 == 0 , M01
      SETINT DISABLE , M02
M06 : JMP M06
M02 : ADD H1 + 1
      RET
)");
  run.tick();
  for (const Event event : {Event::Error, Event::TouchProbe, Event::Timer0}) run->raise_event(event);
  run.h(5) = 1;
  run->run(1, 20);
  for (int n = 0; n < 6; ++n) run.tick();
  for (const Event event : {Event::Error, Event::TouchProbe, Event::Timer0}) run->raise_event(event);
  for (int n = 0; n < 6; ++n) run.tick();
  EXPECT_EQ(run.h(1), 0);
}

TEST(Interrupts, StoppedTaskTakesNone) {
  Assembled run(R"(
      SETINT TIMER0 , M02
      END
M02 : ADD H1 + 1
      RET
)");
  run.tick();
  EXPECT_EQ(run->task(1).state, TaskState::Stopped);
  run->raise_event(Event::Timer0);
  for (int n = 0; n < 5; ++n) run.tick();
  EXPECT_EQ(run.h(1), 0);
}

TEST(Interrupts, EndInARoutineEndsTheTask) {
  Assembled run(R"(
      SETINT TIMER0 , M02
M01 : JMP M01
M02 : END
)");
  run.tick();
  run->raise_event(Event::Timer0);
  run.tick();
  EXPECT_EQ(run->task(1).state, TaskState::Stopped);
  EXPECT_EQ(run->context(context_of(Event::Timer0)).state, TaskState::Stopped);
}

// The program stands in the last call the unit allows; the routine calls as deep again.
TEST(Interrupts, RoutineHasItsOwnCallDepth) {
  const char* const program = R"(
      SETINT TIMER0 , M02
      CALL M01
M03 : JMP M03
M01 : ADD H0 + 1
      JMP H0 == 32 , M04
      CALL M01
      RET
M04 : JMP H9 == 0 , M04
      RET
M02 : ADD H1 + 1
      JMP H1 == H2 , M05
      CALL M02
M05 : RET
)";
  for (const int32_t depth : {33, 34}) {
    Assembled run(program);
    run.h(2) = depth;  // the routine itself and depth - 1 calls
    run.tick(1000);
    EXPECT_EQ(run.h(0), 32);
    EXPECT_EQ(run->task(1).depth, 32);
    run->raise_event(Event::Timer0);
    run.tick(1000);
    if (depth == 33) {
      EXPECT_EQ(run->fault().number, 0);
      run.h(9) = 1;
      run.tick(1000);
      EXPECT_EQ(run->task(1).depth, 0) << "all calls have returned";
    } else {
      EXPECT_EQ(run->fault().number, 32);
      EXPECT_EQ(run->fault().task, 1);
      EXPECT_EQ(run->fault().context, context_of(Event::Timer0));
      EXPECT_STREQ(context_name(run->fault().context), "interrupt TIMER 0");
    }
  }
}

// A wait is over when it would have been without the interrupt; if the routine takes longer, at its end.
TEST(Interrupts, WaitGoesOnBehindTheRoutine) {
  const char* const program = R"(
      SETINT TIMER0 , M02
      WAIT 10
      SET H0 = 1
M01 : JMP M01
M02 : WAIT H5
      RET
)";
  for (const int32_t routine : {0, 1, 4, 20}) {
    for (int at = 1; at <= 9; ++at) {
      Assembled run(program);
      run.h(5) = routine;
      for (int ms = 0; ms <= 40; ++ms) {
        if (ms == at) run->raise_event(Event::Timer0);
        run.tick();
        const bool expected = ms >= std::max(10, at + routine);
        ASSERT_EQ(run.h(0) == 1, expected) << "routine of " << routine << " ms at " << at << ", in " << ms;
      }
    }
  }
}

// A host that lets every MOVLNK wait, and notes who waits and whose wait was cancelled.
struct WaitingHost {
  std::vector<int> waits;
  std::vector<int> cancelled;
  Host host() {
    return {this,
            [](void* self, Machine&, int context, const Instruction&) noexcept {
              static_cast<WaitingHost*>(self)->waits.push_back(context);
              return HostReply{Answer::Wait};
            },
            [](void* self, Machine&, int context) noexcept {
              static_cast<WaitingHost*>(self)->cancelled.push_back(context);
            }};
  }
};

TEST(Interrupts, HostWaitsOfProgramAndRoutineAreApart) {
  WaitingHost host;
  Assembled run(R"(
      SETINT TIMER0 , M02
      MOVLNK H10
      SET H0 = 1
M01 : JMP M01
M02 : MOVLNK H20
      SET H1 = 1
      RET
)",
                host.host());
  run.tick();
  run->raise_event(Event::Timer0);
  run.tick();
  const int routine = context_of(Event::Timer0);
  EXPECT_EQ(host.waits, (std::vector<int>{1, routine}));
  run->resume(1);  // the program's answer comes first; it goes on when the routine is over
  run.tick();
  EXPECT_EQ(run.h(0), 0);
  run->resume(routine);
  run.tick();
  EXPECT_EQ(run.h(1), 1);
  EXPECT_EQ(run.h(0), 1);
  EXPECT_TRUE(host.cancelled.empty());
}

TEST(Interrupts, StoppedWaitIsCancelledAndNotResumed) {
  WaitingHost host;
  Assembled run(R"(
      TASK2 START , M02
M01 : JMP H5 == 0 , M01
      TASK2 STOP , M02
      TASK2 START , M03
      END
M02 : MOVLNK H10
      END
M03 : WAIT 10
      SET H0 = 1
      END
)",
                host.host());
  run.tick();
  EXPECT_EQ(host.waits, std::vector<int>{2});
  run.h(5) = 1;
  run.tick();
  EXPECT_EQ(host.cancelled, std::vector<int>{2});
  run->resume(2);  // a late answer must not end another wait
  for (int n = 0; n < 9; ++n) run.tick();
  EXPECT_EQ(run.h(0), 0);
  run.tick();
  EXPECT_EQ(run.h(0), 1);
}

TEST(Interrupts, CopyOfTheMachineIsASnapshot) {
  Assembled run(kAllThree);
  for (int n = 0; n < 7; ++n) {
    run->raise_event(static_cast<Event>(n % 3));
    run.tick(3);
  }
  Machine copy = run.machine();
  for (int n = 0; n < 50; ++n) {
    for (Machine* machine : {&run.machine(), &copy}) {
      machine->raise_event(static_cast<Event>(n % 3));
      run_tick(*machine, Rates{{3, 3, 3}});
    }
  }
  EXPECT_TRUE(std::equal(run->variables().begin(), run->variables().end(), copy.variables().begin()));
  EXPECT_GT(run.h(1) * run.h(2) * run.h(3), 0);
}

TEST(Tasks, AreStartedStoppedAndRestartedByTheProgram) {
  Assembled run(R"(
      TASK2 START , M02
      TASK START , M03
M01 : JMP H5 == 0 , M01
      TASK2 STOP , M02
M04 : JMP H5 == 1 , M04
      TASK2 START , M02
M05 : JMP M05
M02 : SET H0 = 0
M06 : ADD H0 + 1
      JMP M06
M03 : ADD H1 + 1
      RET
)");
  run.tick(4);  // task 1 starts both, then each has 4 commands
  EXPECT_EQ(run.h(0), 2);
  EXPECT_EQ(run.h(1), 1);
  EXPECT_EQ(run->task(3).state, TaskState::Stopped) << "the end of its function ends a task";
  run.tick(4);
  EXPECT_EQ(run.h(0), 4);
  run.h(5) = 1;
  run.tick(4);
  EXPECT_EQ(run.h(0), 4);
  EXPECT_EQ(run->task(2).state, TaskState::Stopped);
  run.h(5) = 2;
  run.tick(4);
  EXPECT_EQ(run.h(0), 2) << "from its beginning";
}

TEST(Tasks, RestartOfTheirOwn) {
  Assembled run(R"(
      TASK2 START , M02
      END
M02 : ADD H0 + 1
      JMP H0 < 5 , M03
      TASK2 STOP , M02
      ADD H1 + 1
M03 : TASK2 START , M02
      ADD H1 + 1
      RET
)");
  run.tick();
  EXPECT_EQ(run.h(0), 5);
  EXPECT_EQ(run.h(1), 0) << "behind the restart nothing runs";
  EXPECT_EQ(run->task(2).state, TaskState::Stopped);
}

// With interrupts installed every millisecond has to be looked at, so nothing runs ahead. A restart removes them.
TEST(Interrupts, ARestartedMachineRunsAheadAgain) {
  for (const char* const install : {"SETINT TIMER0 , M02", "VARINT H10 , M02"}) {
    Assembled run(std::string("JMP H1 != 0 , M01\n") + install + R"(
M01 : ADD H0 + 1
      JMP M01
M02 : RET
)");
    run.set(10, {1, 0, 20, 0, 1, 5});
    std::vector<fast::Slot> slots(fast::Predecoded::slots_needed(run->program().code().size()));
    const fast::Predecoded predecoded(run->program(), slots);
    run->use(&predecoded);
    const std::array<uint16_t, 1> written{0};
    run.run(2);
    EXPECT_EQ(run.h(0), 0);
    EXPECT_FALSE(run->run_ahead({4, 0, 0}, 3, written)) << install;
    EXPECT_EQ(run.h(0), 0);
    run.h(1) = 1;
    run->start();
    run.run(1);
    EXPECT_TRUE(run->run_ahead({4, 0, 0}, 3, written)) << install;
    EXPECT_EQ(run.h(0), 6) << "of 12 commands every other one";
  }
}

// An event that was pending when the task ended is not made up for, by whatever the task has ended.
TEST(Interrupts, WhatIsPendingEndsWithTheTask) {
  for (const bool by_host : {false, true}) {
    Assembled run(R"(
      SETINT ERROR , M02
      SETINT TIMER0 , M02
M01 : JMP H5 == 0 , M01
      END
M02 : ADD H1 + 1
      RET
)");
    run.tick();
    run->raise_event(Event::Error);
    run->raise_event(Event::Timer0);
    run.h(5) = 1;
    if (by_host)
      run->stop_task(1);
    else
      run.run();
    EXPECT_EQ(run->task(1).state, TaskState::Stopped);
    for (int n = 0; n < 4; ++n) run.tick();
    EXPECT_EQ(run.h(1), 0);
    run.h(5) = 0;
    run->start_task(1, 4);
    for (int n = 0; n < 4; ++n) run.tick();
    EXPECT_EQ(run.h(1), 0) << "the events were those of the task that ended";
    run->raise_event(Event::Error);
    for (int n = 0; n < 2; ++n) run.tick();
    EXPECT_EQ(run.h(1), 1) << "the interrupt is installed still";
  }
}

// However many there were before, the ones that are installed now answer within as many milliseconds (p. 45).
TEST(Interrupts, LatencyIsThatOfTheInstalledOnesAfterADisable) {
  const char* const keywords[] = {"ERROR", "TOUCHP1", "TIMER0"};
  for (int phase = 1; phase <= 3; ++phase)
    for (size_t installed = 1; installed <= 3; ++installed) {
      std::string program =
          "SETINT ERROR , M02\nSETINT TOUCHP1 , M02\nSETINT TIMER0 , M02\n"
          "M01 : JMP H5 == 0 , M01\nSETINT DISABLE , M02\n";
      for (size_t n = 0; n < installed; ++n) program += std::string("SETINT ") + keywords[n] + " , M02\n";
      for (size_t event = 0; event < installed; ++event) {
        Assembled run(program + "M03 : JMP M03\nM02 : ADD H1 + 1\nRET\n");
        for (int n = 0; n < phase; ++n) run.tick();
        run.h(5) = 1;
        run.run();
        run->raise_event(static_cast<Event>(event));
        size_t ticks = 0;
        while (run.h(1) == 0 && ticks < 10) run.tick(), ++ticks;
        EXPECT_LE(ticks, installed) << phase << " " << event;
        // And each of them in each round.
        for (int round = 0; round < 6; ++round) {
          const int32_t before = run.h(1);
          run->raise_event(static_cast<Event>(event));
          for (size_t n = 0; n < installed; ++n) run.tick();
          EXPECT_EQ(run.h(1), before + 1);
        }
      }
    }
}

}  // namespace
}  // namespace ipos::vm
