// What stops and what starts anew: every task and every interrupt routine, by the program, by the unit and by the host
// in the middle of a command.
#include <gtest/gtest.h>

#include "tests/vm/assembled.hpp"
#include "vm/exec/interrupts.hpp"

namespace ipos::vm {
namespace {

using tests::Assembled;

// Lets every MOVLNK wait, and notes whose wait was cancelled.
struct NeverDone {
  std::vector<int> cancelled;
  Host host() {
    return {this, [](void*, Machine&, int, const Instruction&) noexcept { return HostReply{Answer::Wait}; },
            [](void* self, Machine&, int context) noexcept {
              static_cast<NeverDone*>(self)->cancelled.push_back(context);
            }};
  }
};

// All ten contexts are in the same command: three tasks, their interrupts one above the other. Structures of the
// variable interrupts at H10, H20, H30, H40 (IPOSplus p. 347): the first two of task 2, the others of task 3.
class AllWait {
 public:
  explicit AllWait(const std::string& command) : run_(program(command), host_.host()) {
    for (int32_t n = 0; n < kVariableInterrupts; ++n)
      run_.set(static_cast<size_t>(10 + 10 * n), {n / 2 + 1, n, 50, 0, 0, n + 1});
    run_.tick();
    for (const Event event : {Event::Timer0, Event::TouchProbe, Event::Error}) {
      run_->raise_event(event);
      for (int n = 0; n < kEvents; ++n) run_.tick(1);
    }
    for (int n = 0; n < kVariableInterrupts; ++n) {
      run_.h(kVarIntReq) = 1 << n;
      run_.tick(1);
    }
    for (int number = 1; number <= kContexts; ++number)
      EXPECT_EQ(run_->context(number).state, TaskState::Waiting) << context_name(number);
  }
  Machine* operator->() { return run_.operator->(); }
  std::vector<int>& cancelled() { return host_.cancelled; }
  std::vector<int> stopped() {
    std::vector<int> out;
    for (int number = 1; number <= kContexts; ++number)
      if (run_->context(number).state == TaskState::Stopped) out.push_back(number);
    return out;
  }

 private:
  static std::string program(const std::string& command) {
    return "TASK2 START , M01\nTASK START , M01\nSETINT ERROR , M01\nSETINT TOUCHP1 , M01\nSETINT TIMER0 , "
           "M01\n"
           "VARINT H10 , M01\nVARINT H20 , M01\nVARINT H30 , M01\nVARINT H40 , M01\nM01 : " +
           command + "\nRET\n";
  }
  NeverDone host_;
  Assembled run_;
};

using ContextNumbers = std::vector<int>;
const ContextNumbers kAllContexts{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
// The task with its routines.
const ContextNumbers kContextsOfTask[] = {{1, 4, 5, 6}, {2, 7, 8}, {3, 9, 10}};

// The host hears of each wait for it that ends so; a WAIT is nothing of his.
TEST(Stopping, EndsEveryRoutineAndCancelsTheWaitsForTheHost) {
  for (const bool host_waits : {true, false}) {
    const char* const command = host_waits ? "MOVLNK H60" : "WAIT 1000";
    const auto expect = [&](AllWait& all, const ContextNumbers& numbers) {
      EXPECT_EQ(all.stopped(), numbers);
      EXPECT_EQ(all.cancelled(), host_waits ? numbers : ContextNumbers{});
    };
    AllWait all(command);
    all->stop_all();
    expect(all, kAllContexts);
    for (int task = 1; task <= kTasks; ++task) {
      AllWait one(command);
      one->stop_task(task);
      expect(one, kContextsOfTask[task - 1]);
      EXPECT_EQ(one->active_context(task), task);
      one->stop_task(task);
      expect(one, kContextsOfTask[task - 1]);  // once
    }
    AllWait fault(command);
    fault->raise_fault(17, "watchdog");
    expect(fault, kAllContexts);
    EXPECT_EQ(fault->fault().context, context_of(Event::Error)) << "what executed of the first task";
    AllWait anew(command);
    anew->start();
    EXPECT_EQ(anew->task(1).state, TaskState::Ready);
    EXPECT_EQ(anew.stopped(), ContextNumbers(kAllContexts.begin() + 1, kAllContexts.end()));
    EXPECT_EQ(anew.cancelled(), host_waits ? kAllContexts : ContextNumbers{});
  }
}

TEST(Stopping, AStartEndsTheRoutinesOfTheTaskAndBeginsAtItsBeginning) {
  for (int task = 1; task <= kTasks; ++task) {
    AllWait all("MOVLNK H60");
    all->start_task(task, 2);
    ContextNumbers routines = kContextsOfTask[task - 1];
    EXPECT_EQ(all.cancelled(), routines);
    routines.erase(routines.begin());
    EXPECT_EQ(all.stopped(), routines);
    const TaskContext& t = all->task(task);
    EXPECT_EQ(t.state, TaskState::Ready);
    EXPECT_EQ(t.pc, 2U);
    EXPECT_EQ(t.depth, 0);
    EXPECT_EQ(t.task, task);
    EXPECT_EQ(t.commands, 0U);
    EXPECT_EQ(t.wait_ms, 0U);
    EXPECT_EQ(all->active_context(task), task);
  }
}

// A restart has no fault, no interrupt and no call left over.
TEST(Stopping, ARestartForgetsEverythingButTheVariables) {
  Assembled run(R"(
      SETINT TIMER0 , M02
      CALL M01
M01 : ADD H0 + 1
      DIV H0 / H1
M02 : RET
)");
  EXPECT_EQ(run.run().stop, Stop::Faulted);
  EXPECT_EQ(run->fault().number, kFaultIllop);
  run->start();
  EXPECT_EQ(run->fault().number, 0);
  EXPECT_EQ(run->fault().reason, nullptr);
  EXPECT_EQ(run->task(1).pc, 0U);
  EXPECT_EQ(run->task(1).depth, 0);
  EXPECT_EQ(run->task(1).commands, 0U);
  EXPECT_FALSE(run->interrupts().events[static_cast<size_t>(Event::Timer0)].installed);
  EXPECT_EQ(run.h(0), 1);
}

// Both commands, from the task itself and from its interrupt routine: what comes behind is not executed.
TEST(Stopping, ATaskThatStartsOrStopsItselfDoesNothingBehindIt) {
  struct Row {
    const char* command;
    int32_t control;  // of VARINT: 1 task 2, 2 task 3
  };
  for (const Row& row : {Row{"TASK2", 1}, Row{"TASK", 2}})
    for (const bool starts : {true, false})
      for (const bool in_routine : {true, false}) {
        const int task = row.control + 1;
        SCOPED_TRACE(testing::Message() << row.command << " " << starts << " " << in_routine);
        const std::string itself = std::string(row.command) + (starts ? " START" : " STOP") + " , M03\n";
        Assembled run(std::string("VARINT H10 , M02\n") + row.command + " START , M01\nEND\n" +
                      "M01 : ADD H0 + 1\n" + (in_routine ? "M04 : JMP M04\n" : itself) + "ADD H1 + 1\nEND\n" +
                      "M02 : ADD H2 + 1\n" + itself + "ADD H1 + 1\nRET\nM03 : ADD H3 + 1\nM05 : JMP M05\n");
        run.set(10, {row.control, 0, 50, 0, 0, 5});
        run.tick(6);
        run.h(kVarIntReq) = in_routine ? 1 : 0;
        run.tick(6);
        EXPECT_EQ(run.h(0), 1);
        EXPECT_EQ(run.h(1), 0) << "behind it";
        EXPECT_EQ(run.h(2), in_routine ? 1 : 0);
        EXPECT_EQ(run.h(3), starts ? 1 : 0);
        EXPECT_EQ(run->task(task).state, starts ? TaskState::Ready : TaskState::Stopped);
        EXPECT_EQ(run->active_context(task), task);
        EXPECT_EQ(run->context(context_of_variable_interrupt(0)).state, TaskState::Stopped);
      }
}

// The host may stop and start tasks while it carries out a command, that of the command among them.
TEST(Stopping, ByTheHostInTheMiddleOfACommand) {
  struct Carried {
    int stops = 0, starts = 0;  // tasks
    Answer answer = Answer::Done;
    Host host() {
      return {this, [](void* self, Machine& machine, int, const Instruction&) noexcept {
                const auto& carried = *static_cast<Carried*>(self);
                if (carried.stops != 0) machine.stop_task(carried.stops);
                if (carried.starts != 0) machine.start_task(carried.starts, 4);
                return HostReply{carried.answer};
              }};
    }
  };
  constexpr int32_t kBehind = 7, kStarted = 9;
  const std::string text = "NOP\nMOVLNK H60\nSET H1 = 7\nSET H2 = 9\nEND\n";  // at 0, 1, 2, 4, 6
  for (const Answer answer : {Answer::Done, Answer::Wait}) {
    Carried stops{1, 0, answer};
    Assembled stopped(text, stops.host());
    EXPECT_EQ(stopped.run().stop, Stop::Ended);
    EXPECT_EQ(stopped->task(1).state, TaskState::Stopped);
    EXPECT_EQ(stopped.h(1), 0);

    Carried starts{0, 1, answer};
    Assembled started(text, starts.host());
    EXPECT_EQ(started.run(2).stop, Stop::Budget);
    EXPECT_EQ(started->task(1).state, TaskState::Ready);
    EXPECT_EQ(started->task(1).pc, 4U);
    EXPECT_EQ(started.run().stop, Stop::Ended);
    EXPECT_EQ(started.h(1), 0);
    EXPECT_EQ(started.h(2), kStarted);
  }
  for (const int other : {2, 3}) {
    Carried starts{0, other};
    Assembled both(text, starts.host());
    EXPECT_EQ(both.run().stop, Stop::Ended);
    EXPECT_EQ(both.h(1), kBehind) << "the task of the command goes on behind it";
    EXPECT_EQ(both->task(other).pc, 4U);
  }
}

TEST(Contexts, HaveTheirNames) {
  const char* const names[] = {"task 1",
                               "task 2",
                               "task 3",
                               "interrupt ERROR",
                               "interrupt TOUCH PROBE",
                               "interrupt TIMER 0",
                               "variable interrupt 0",
                               "variable interrupt 1",
                               "variable interrupt 2",
                               "variable interrupt 3"};
  ASSERT_EQ(std::size(names), static_cast<size_t>(kContexts));
  for (int context = 1; context <= kContexts; ++context)
    EXPECT_STREQ(context_name(context), names[context - 1]);
  EXPECT_STREQ(context_name(context_of(Event::Error)), "interrupt ERROR");
  EXPECT_STREQ(context_name(context_of(Event::TouchProbe)), "interrupt TOUCH PROBE");
  for (int number = 0; number < kVariableInterrupts; ++number)
    EXPECT_EQ(context_name(context_of_variable_interrupt(number)),
              "variable interrupt " + std::to_string(number));
}

}  // namespace
}  // namespace ipos::vm
