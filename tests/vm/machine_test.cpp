// What each command does, and how tasks stop: budget, wait, end, fault. Expected values are the manual's
// (IPOSplus p. 28, 305, 306, 342) or follow from 32-bit two's complement.
#include "vm/exec/machine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/vm/code.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::vm {
namespace {

using tests::code_of;
using tests::I;

constexpr Limits kLimits{1024, 16384, 3, 4};
constexpr int32_t kMin = INT32_MIN;
constexpr int32_t kMax = INT32_MAX;

// A program with the machine that runs it.
class Program {
 public:
  Program(std::initializer_list<Instruction> commands, Host host = {})
      : code_(code_of(commands)), machine_(verify(code_, kLimits, {}).image.value(), host) {
    machine_.start();
  }
  Machine* operator->() { return &machine_; }
  int32_t& h(size_t n) { return machine_.variables()[n]; }
  RunResult run(uint32_t budget = 1000) { return machine_.run(1, budget); }

 private:
  std::vector<uint32_t> code_;
  Machine machine_;
};

// The result of one two-operand command in its H,H and H,K form.
int32_t both(Opcode hh, Opcode hk, int32_t a, int32_t b) {
  Program variable({I(hh, 0, 1), I(Opcode::End)});
  variable.h(0) = a;
  variable.h(1) = b;
  EXPECT_EQ(variable.run().stop, Stop::Ended);
  Program constant({I(hk, 0, b), I(Opcode::End)});
  constant.h(0) = a;
  EXPECT_EQ(constant.run().stop, Stop::Ended);
  EXPECT_EQ(variable.h(0), constant.h(0));
  EXPECT_EQ(variable.h(1), b) << "the right operand must stay";
  return variable.h(0);
}

TEST(Arithmetic, WrapsOnTheNumberCircle) {
  EXPECT_EQ(both(Opcode::AddHH, Opcode::AddHK, kMax, 1), kMin);
  EXPECT_EQ(both(Opcode::SubHH, Opcode::SubHK, kMin, 1), kMax);
  EXPECT_EQ(both(Opcode::MulHH, Opcode::MulHK, 65536, 65536), 0);
  EXPECT_EQ(both(Opcode::MulHH, Opcode::MulHK, kMin, -1), kMin);
  EXPECT_EQ(both(Opcode::MulHH, Opcode::MulHK, -7, 6), -42);
}

TEST(Arithmetic, DivisionTruncatesTowardZero) {
  EXPECT_EQ(both(Opcode::DivHH, Opcode::DivHK, 2, 3), 0);  // IPOSplus p. 196
  EXPECT_EQ(both(Opcode::DivHH, Opcode::DivHK, -7, 2), -3);
  EXPECT_EQ(both(Opcode::DivHH, Opcode::DivHK, 7, -2), -3);
  EXPECT_EQ(both(Opcode::DivHH, Opcode::DivHK, kMin, -1), kMin);
  EXPECT_EQ(both(Opcode::ModHH, Opcode::ModHK, 2, 3), 2);
  EXPECT_EQ(both(Opcode::ModHH, Opcode::ModHK, -7, 2), -1);
  EXPECT_EQ(both(Opcode::ModHH, Opcode::ModHK, 7, -2), 1);
  EXPECT_EQ(both(Opcode::ModHH, Opcode::ModHK, kMin, -1), 0);
}

TEST(Arithmetic, BitwiseAndShifts) {
  EXPECT_EQ(both(Opcode::AndHH, Opcode::AndHK, 0b10, 0b11), 0b10);  // IPOSplus p. 196
  EXPECT_EQ(both(Opcode::OrHH, Opcode::OrHK, 0b10, 0b11), 0b11);
  EXPECT_EQ(both(Opcode::XorHH, Opcode::XorHK, 0x0FFF, 0xF0F0), 0xFF0F);  // p. 305
  EXPECT_EQ(both(Opcode::ShlHH, Opcode::ShlHK, 31, 1), 62);               // p. 305
  EXPECT_EQ(both(Opcode::ShlHH, Opcode::ShlHK, 15, 6), 960);
  EXPECT_EQ(both(Opcode::ShlHH, Opcode::ShlHK, 1, 33), 2);
  EXPECT_EQ(both(Opcode::ShrHH, Opcode::ShrHK, 62, 1), 31);  // p. 306
  EXPECT_EQ(both(Opcode::ShrHH, Opcode::ShrHK, 960, 6), 15);
  EXPECT_EQ(both(Opcode::ShrHH, Opcode::ShrHK, -1, 28), 15);
  EXPECT_EQ(both(Opcode::AshrHH, Opcode::AshrHK, 7, 2), 1);  // p. 306
  EXPECT_EQ(both(Opcode::AshrHH, Opcode::AshrHK, -7, 1), -4);
  EXPECT_EQ(both(Opcode::AshrHH, Opcode::AshrHK, kMin, 31), -1);
  Program complement({I(Opcode::NotH, 0, 1), I(Opcode::End)});
  complement.h(1) = 0x0F;
  complement.run();
  EXPECT_EQ(complement.h(0), -16);
}

TEST(Arithmetic, DivisionByZeroIsF10) {
  for (const Instruction& command :
       {I(Opcode::DivHH, 0, 1), I(Opcode::ModHH, 0, 1), I(Opcode::DivHK, 0, 0), I(Opcode::ModHK, 0, 0)}) {
    Program run({I(Opcode::Nop), command, I(Opcode::End)});
    run.h(0) = 5;
    EXPECT_EQ(run.run().stop, Stop::Faulted);
    EXPECT_EQ(run->fault().number, 10);
    EXPECT_EQ(run->fault().address, 1U);
    EXPECT_EQ(run->fault().task, 1);
    EXPECT_EQ(run.h(0), 5);
  }
}

TEST(Bits, SetClearMove) {
  Program run({I(Opcode::BitSet, 0, 31), I(Opcode::BitClear, 1, 0), I(Opcode::BitMove, 2, 4, 0, 31),
               I(Opcode::BitMoveNeg, 3, 5, 0, 31), I(Opcode::BitMoveNeg, 4, 6, 5, 1), I(Opcode::End)});
  run.h(1) = 3;
  run.h(3) = -1;
  run.run();
  EXPECT_EQ(run.h(0), kMin);
  EXPECT_EQ(run.h(1), 2);
  EXPECT_EQ(run.h(2), 16);
  EXPECT_EQ(run.h(3), ~32);
  EXPECT_EQ(run.h(4), 64);
}

TEST(Jumps, EveryConditionOnBothForms) {
  struct Row {
    Opcode hh, hk;
    bool less, equal, greater;
  };
  const Row rows[] = {{Opcode::JmpEqHH, Opcode::JmpEqHK, false, true, false},
                      {Opcode::JmpNeHH, Opcode::JmpNeHK, true, false, true},
                      {Opcode::JmpLtHH, Opcode::JmpLtHK, true, false, false},
                      {Opcode::JmpLeHH, Opcode::JmpLeHK, true, true, false},
                      {Opcode::JmpGtHH, Opcode::JmpGtHK, false, false, true},
                      {Opcode::JmpGeHH, Opcode::JmpGeHK, false, true, true}};
  const auto taken = [](Instruction jump, int32_t a, int32_t b) {
    Program run({jump, I(Opcode::SetHK, 9, 1), I(Opcode::End)});
    run.h(0) = a;
    run.h(1) = b;
    run.run();
    return run.h(9) == 0;
  };
  for (const Row& row : rows)
    for (const auto& [a, b, expected] :
         {std::tuple(kMin, kMax, row.less), std::tuple(-5, -5, row.equal), std::tuple(1, -1, row.greater)}) {
      EXPECT_EQ(taken(I(row.hh, 0, 1, 4), a, b), expected) << info(row.hh).text << a << " " << b;
      EXPECT_EQ(taken(I(row.hk, 0, b, 5), a, b), expected) << info(row.hk).text << a << " " << b;
    }
}

// The SETI loop of IPOSplus p. 342: H10..H15 take 50, 60, .. 100.
TEST(Indirect, ManualLoop) {
  Program run({I(Opcode::SetHK, 0, 10), I(Opcode::SetHK, 1, 50), I(Opcode::SetiStore, 0, 1),
               I(Opcode::AddHK, 0, 1), I(Opcode::AddHK, 1, 10), I(Opcode::JmpLeHK, 0, 15, 4),
               I(Opcode::End)});
  run.run();
  for (int32_t n = 0; n < 6; ++n) EXPECT_EQ(run.h(static_cast<size_t>(10 + n)), 50 + 10 * n);
  EXPECT_EQ(run.h(0), 16);
  EXPECT_EQ(run.h(1), 110);
}

TEST(Indirect, NumbersOutsideAreF10) {
  for (const int32_t number : {-1, 1024, kMin, kMax}) {
    Program store({I(Opcode::SetiStore, 0, 1), I(Opcode::End)});
    store.h(0) = number;
    EXPECT_EQ(store.run().stop, Stop::Faulted);
    EXPECT_EQ(store->fault().number, 10);
    Program load({I(Opcode::SetiLoad, 1, 0), I(Opcode::End)});
    load.h(0) = number;
    EXPECT_EQ(load.run().stop, Stop::Faulted);
  }
  Program edge({I(Opcode::SetiStore, 0, 1), I(Opcode::SetiLoad, 2, 0), I(Opcode::End)});
  edge.h(0) = 1023;
  edge.h(1) = 77;
  EXPECT_EQ(edge.run().stop, Stop::Ended);
  EXPECT_EQ(edge.h(1023), 77);
  EXPECT_EQ(edge.h(2), 77);
}

TEST(Blocks, CopyOverlapping) {
  Program up({I(Opcode::Copy, 1, 0, 3), I(Opcode::End)});
  Program down({I(Opcode::Copy, 0, 1, 3), I(Opcode::End)});
  for (size_t n = 0; n < 4; ++n) up.h(n) = down.h(n) = static_cast<int32_t>(n + 1);
  up.run();
  down.run();
  EXPECT_EQ((std::array{up.h(0), up.h(1), up.h(2), up.h(3)}), (std::array{1, 1, 2, 3}));
  EXPECT_EQ((std::array{down.h(0), down.h(1), down.h(2), down.h(3)}), (std::array{2, 3, 4, 4}));
}

TEST(Calls, ReturnBehindTheCallAndDepthLimit) {
  Program run({I(Opcode::Call, 4), I(Opcode::SetHK, 1, 7), I(Opcode::SetHK, 0, 5), I(Opcode::Ret)});
  EXPECT_EQ(run.run().stop, Stop::Ended);  // CALL, SET H0, RET, SET H1, SET H0, RET of task 1
  EXPECT_EQ(run.h(0), 5);
  EXPECT_EQ(run.h(1), 7);

  Program recursion({I(Opcode::AddHK, 0, 1), I(Opcode::Call, 0), I(Opcode::End)});
  EXPECT_EQ(recursion.run().stop, Stop::Faulted);
  EXPECT_EQ(recursion->fault().number, 32);
  EXPECT_EQ(recursion.h(0), 5) << "four nested calls are the limit given";
}

TEST(Budget, IsExact) {
  Program run({I(Opcode::AddHK, 0, 1), I(Opcode::Jmp, 0)});
  for (int step = 1; step <= 10; ++step) {
    const RunResult result = run.run(1);
    EXPECT_EQ(result.stop, Stop::Budget);
    EXPECT_EQ(result.commands, 1U);
    EXPECT_EQ(run.h(0), (step + 1) / 2);
  }
  EXPECT_EQ(run.run(0).commands, 0U);
  EXPECT_EQ(run.run(7).commands, 7U);
  EXPECT_EQ(run->task(1).commands, 17U);
}

// Any 32-bit number is a budget, of the fast engine too. 1000 turns of ADD and JMP, and the WAIT.
TEST(Budget, AnyNumberIsOne) {
  for (const uint32_t budget : {2001U, 1U << 29, (1U << 30) - 1, 1U << 30, (1U << 30) + 1, (1U << 31) - 1,
                                1U << 31, (1U << 31) + 1, UINT32_MAX})
    for (const bool is_fast : {false, true}) {
      Program run(
          {I(Opcode::AddHK, 0, 1), I(Opcode::JmpLtHK, 0, 1000, 0), I(Opcode::WaitK, 5), I(Opcode::End)});
      std::vector<fast::Slot> slots(fast::Predecoded::slots_needed(run->program().code().size()));
      const fast::Predecoded predecoded(run->program(), slots);
      if (is_fast) run->use(&predecoded);
      const RunResult result = run.run(budget);
      EXPECT_EQ(result.stop, Stop::Waiting) << budget << " " << is_fast;
      EXPECT_EQ(result.commands, 2001U) << budget << " " << is_fast;
      EXPECT_EQ(run.h(0), 1000) << budget << " " << is_fast;
      EXPECT_EQ(run->task(1).commands, 2001U) << budget << " " << is_fast;
    }
}

TEST(Waiting, WaitTakesItsMilliseconds) {
  Program run({I(Opcode::WaitK, 3), I(Opcode::SetHK, 0, 1), I(Opcode::WaitH, 5), I(Opcode::SetHK, 0, 2),
               I(Opcode::End)});
  run.h(5) = 0;  // no wait
  const Rates rates{{10, 0, 0}};
  EXPECT_EQ(run_tick(*run.operator->(), rates), 1U);
  for (int ms = 1; ms < 3; ++ms) {
    EXPECT_EQ(run_tick(*run.operator->(), rates), 0U) << ms;
    EXPECT_EQ(run->task(1).state, TaskState::Waiting);
  }
  EXPECT_EQ(run_tick(*run.operator->(), rates), 4U);
  EXPECT_EQ(run.h(0), 2);
}

// A host that answers what it is told and records what it was asked.
struct Recorder {
  HostReply reply;
  std::vector<Instruction> asked;
  Host host() {
    return {this, [](void* self, Machine&, int, const Instruction& command) noexcept {
              auto& recorder = *static_cast<Recorder*>(self);
              recorder.asked.push_back(command);
              return recorder.reply;
            }};
  }
};

TEST(HostCalls, DoneGoesOn) {
  Recorder recorder;
  Program run({I(Opcode::Scom, 1, 420), I(Opcode::ScomOn), I(Opcode::End)}, recorder.host());
  EXPECT_EQ(run.run().stop, Stop::Ended);
  ASSERT_EQ(recorder.asked.size(), 2U);
  EXPECT_EQ(recorder.asked[0], I(Opcode::Scom, 1, 420));
}

TEST(HostCalls, WaitHoldsTheTaskUntilResume) {
  Recorder recorder{{Answer::Wait}, {}};
  Program run({I(Opcode::Movlnk, 0), I(Opcode::SetHK, 9, 1), I(Opcode::End)}, recorder.host());
  EXPECT_EQ(run.run().stop, Stop::Waiting);
  EXPECT_EQ(run.run().stop, Stop::Waiting);
  run->tick();
  EXPECT_EQ(run->task(1).state, TaskState::Waiting) << "a tick must not end a host's wait";
  run->resume(1);
  EXPECT_EQ(run.run().stop, Stop::Ended);
  EXPECT_EQ(recorder.asked.size(), 1U);
  EXPECT_EQ(run.h(9), 1);
}

TEST(HostCalls, FaultStopsAllTasks) {
  Recorder recorder{{Answer::Fault, 42, "because"}, {}};
  Program run({I(Opcode::Nop), I(Opcode::Movlnk, 0), I(Opcode::End)}, recorder.host());
  run->start_task(2, 0);
  EXPECT_EQ(run.run().stop, Stop::Faulted);
  EXPECT_EQ(run->fault().number, 42);
  EXPECT_STREQ(run->fault().reason, "because");
  EXPECT_EQ(run->task(2).state, TaskState::Stopped);
}

TEST(HostCalls, EventCallsOnlyWhenTaken) {
  Recorder recorder{{Answer::Taken}, {}};
  const auto program = {I(Opcode::InputCall, 1, 8, 4), I(Opcode::End), I(Opcode::SetHK, 0, 1),
                        I(Opcode::Ret)};
  Program taken(program, recorder.host());
  taken.run();
  EXPECT_EQ(taken.h(0), 1);
  recorder.reply = {Answer::Done};
  Program not_taken(program, recorder.host());
  not_taken.run();
  EXPECT_EQ(not_taken.h(0), 0);
}

TEST(HostCalls, WithoutAHostIsF10) {
  Program run({I(Opcode::Movlnk, 0), I(Opcode::End)});
  EXPECT_EQ(run.run().stop, Stop::Faulted);
  EXPECT_EQ(run->fault().number, 10);
}

TEST(Tasks, ShareTheMillisecond) {
  Program run({I(Opcode::AddHK, 1, 1), I(Opcode::Jmp, 0), I(Opcode::AddHK, 2, 1), I(Opcode::Jmp, 4)});
  run->start_task(2, 4);
  const Rates rates{{3, 5, 20}};  // P938 = 2, P939 = 3: the example of IPOSplus p. 44
  for (int tick = 0; tick < 10; ++tick) EXPECT_EQ(run_tick(*run.operator->(), rates), 8U);
  EXPECT_EQ(run->task(1).commands, 30U);
  EXPECT_EQ(run->task(2).commands, 50U);
  run->start();
  EXPECT_EQ(run->task(2).state, TaskState::Stopped);
  EXPECT_EQ(run.h(1), 15) << "variables keep their values over a restart";
}

// What the unit reports from outside is the first running task's; without one it is task 1's.
TEST(Faults, RaisedFromOutsideAreOfTheFirstTaskThatRuns) {
  for (unsigned running = 0; running < 1U << kTasks; ++running) {
    Program run({I(Opcode::Jmp, 0)});
    run->stop_all();
    int first = 1;
    for (int task = kTasks; task >= 1; --task)
      if ((running >> (task - 1) & 1) != 0) {
        run->start_task(task, 0);
        first = task;
      }
    run->raise_fault(17, "watchdog");
    EXPECT_EQ(run->fault().number, 17);
    EXPECT_EQ(run->fault().task, first) << running;
    for (int task = 1; task <= kTasks; ++task) EXPECT_EQ(run->task(task).state, TaskState::Stopped);
  }
}

// A run ahead that meets a wait is given up, from whatever command it began: nothing has changed, not even where
// the functions return to. F is called from three places, one of them a function itself.
TEST(Ahead, GivenUpItLeavesNothingBehind) {
  constexpr int32_t kG = 10, kF = 13;
  Program run({I(Opcode::Call, kF), I(Opcode::Call, kF), I(Opcode::Call, kG), I(Opcode::WaitK, 5),
               I(Opcode::Jmp, 0), I(Opcode::Call, kF), I(Opcode::Ret), I(Opcode::AddHK, 0, 1),
               I(Opcode::AddHK, 0, 1), I(Opcode::Ret)});
  std::vector<fast::Slot> slots(fast::Predecoded::slots_needed(run->program().code().size()));
  const fast::Predecoded predecoded(run->program(), slots);
  int deepest = 0;
  const std::array<uint16_t, 1> written{0};
  while (run->task(1).state == TaskState::Ready && run->task(1).commands < 100) {
    Machine machine = *run.operator->();
    machine.use(&predecoded);
    EXPECT_FALSE(machine.run_ahead({50, 0, 0}, 2, written));
    const TaskContext &is = machine.task(1), &was = run->task(1);
    EXPECT_EQ(machine.variables()[0], run.h(0));
    EXPECT_EQ(is.pc, was.pc);
    EXPECT_EQ(is.depth, was.depth);
    EXPECT_EQ(is.commands, was.commands);
    for (size_t n = 0; n < was.depth; ++n) EXPECT_EQ(is.calls[n], was.calls[n]) << "after " << was.commands;
    deepest = std::max<int>(deepest, was.depth);
    run.run(1);
  }
  EXPECT_EQ(run->task(1).state, TaskState::Waiting);
  EXPECT_EQ(deepest, 2);
}

// What runs ahead of others that wait takes their milliseconds, too. A wait that would end in them is too short. One for
// the host does not end with time.
TEST(Ahead, WaitsOfOtherTasksGoOn) {
  Recorder recorder{{Answer::Wait}, {}};
  Program run(
      {I(Opcode::AddHK, 0, 1), I(Opcode::Jmp, 0), I(Opcode::WaitK, 50), I(Opcode::Movlnk, 0), I(Opcode::End)},
      recorder.host());
  constexpr int32_t kWait = 4, kMovlnk = 6;
  std::vector<fast::Slot> slots(fast::Predecoded::slots_needed(run->program().code().size()));
  const fast::Predecoded predecoded(run->program(), slots);
  run->use(&predecoded);
  run->start_task(2, kWait);
  run->start_task(3, kMovlnk);
  EXPECT_EQ(run->run(2, 1).stop, Stop::Waiting);
  EXPECT_EQ(run->run(3, 1).stop, Stop::Waiting);
  const std::array<uint16_t, 1> written{0};
  const auto waits = [&](uint32_t ms) {
    EXPECT_EQ(run->task(2).wait_ms, ms);
    for (const int task : {2, 3}) EXPECT_EQ(run->task(task).state, TaskState::Waiting);
    EXPECT_EQ(run->task(3).wait_ms, 0U);
  };
  EXPECT_FALSE(run->run_ahead({2, 2, 2}, 50, written));
  waits(50);
  EXPECT_TRUE(run->run_ahead({2, 2, 2}, 20, written));
  waits(30);
  EXPECT_EQ(run.h(0), 20);
  EXPECT_FALSE(run->run_ahead({2, 2, 2}, 30, written));
  EXPECT_TRUE(run->run_ahead({2, 2, 2}, 29, written));
  waits(1);
  run->tick();
  EXPECT_EQ(run->task(2).state, TaskState::Ready);
  EXPECT_EQ(run->task(3).state, TaskState::Waiting);
}

// Looking whether a loop is idle does not cause the fault of its calls; a loop whose calls return goes on for ever.
TEST(Calls, IdleLoopsReturnAndOthersAreLeftToTheirFault) {
  Program recursion({I(Opcode::Call, 0), I(Opcode::End)});
  recursion.run(4);
  EXPECT_EQ(recursion->task(1).depth, 4);
  EXPECT_EQ(recursion->idle_ticks({5, 0, 0}), 0U);
  EXPECT_EQ(recursion->fault().number, 0);
  EXPECT_EQ(recursion->task(1).state, TaskState::Ready);
  EXPECT_EQ(recursion.run(1).stop, Stop::Faulted);
  EXPECT_EQ(recursion->fault().number, 32);
  constexpr int32_t kRet = 4;
  Program returns({I(Opcode::Call, kRet), I(Opcode::Jmp, 0), I(Opcode::Ret)});
  EXPECT_EQ(returns->idle_ticks({5, 0, 0}), kIdleForever);
}

// The depth of calls is the unit's, at most that of the machine. So many calls are open when the next one faults.
TEST(Calls, AreAsDeepAsTheUnitAllowsAndTheMachineHas) {
  const std::vector<uint32_t> code = code_of({I(Opcode::AddHK, 0, 1), I(Opcode::Call, 0), I(Opcode::End)});
  for (const uint8_t limit : std::initializer_list<uint8_t>{0, 1, 31, 32, 33, 255}) {
    Machine machine(verify(code, Limits{1024, 16384, 3, limit}, {}).image.value(), {});
    machine.start();
    EXPECT_EQ(machine.run(1, 1000).stop, Stop::Faulted);
    EXPECT_EQ(machine.fault().number, 32);
    const int depth = std::min<int>(limit, 32);
    EXPECT_EQ(machine.task(1).depth, depth) << int{limit};
    EXPECT_EQ(machine.variables()[0], depth + 1) << int{limit};
    EXPECT_EQ(machine.idle_ticks({5, 5, 5}), kIdleForever) << "nothing runs";
  }
}

// Each distance between the two blocks, each length: as if all had been read before anything is written.
TEST(Blocks, CopyIsAsIfEverythingWereReadFirst) {
  for (int32_t from = 0; from <= 8; ++from)
    for (int32_t to = 0; to <= 8; ++to)
      for (const int32_t count : {1, 2, 3, 8}) {
        Program run({I(Opcode::Copy, to, from, count), I(Opcode::End)});
        std::array<int32_t, 20> wanted{};
        for (size_t n = 0; n < wanted.size(); ++n) run.h(n) = wanted[n] = 100 + static_cast<int32_t>(n);
        for (int32_t n = 0; n < count; ++n) wanted[static_cast<size_t>(to + n)] = 100 + from + n;
        run.run();
        for (size_t n = 0; n < wanted.size(); ++n)
          ASSERT_EQ(run.h(n), wanted[n]) << from << " " << to << " " << count << " H" << n;
      }
}

// Waits of nothing and less are none (ours); others last as many ticks as they say.
TEST(Waiting, OnlyPositiveTimesAreWaitedFor) {
  for (const int32_t ms : {kMin, -1, 0, 1, 2, 7}) {
    Program constant({I(Opcode::WaitK, ms), I(Opcode::SetHK, 0, 1), I(Opcode::End)});
    Program variable({I(Opcode::WaitH, 5), I(Opcode::SetHK, 0, 1), I(Opcode::End)});
    variable.h(5) = ms;
    for (Program* run : {&constant, &variable}) {
      EXPECT_EQ(run->run().stop, ms > 0 ? Stop::Waiting : Stop::Ended) << ms;
      int ticks = 0;
      for (; run->h(0) == 0 && ticks < 10; ++ticks) {
        (*run)->tick();
        run->run();
      }
      EXPECT_EQ(ticks, std::max(0, ms)) << ms;
    }
  }
}

// The call goes to the label, which is the last operand, and comes back behind the command.
TEST(HostCalls, EveryEventCommandCallsItsLabel) {
  for (const Instruction& command : {I(Opcode::InputCall, 1, 0, 6), I(Opcode::SystemCall, 1, 6)}) {
    Recorder recorder{{Answer::Taken}, {}};
    Program run({command, I(Opcode::SetHK, 1, 2), I(Opcode::End), I(Opcode::Nop), I(Opcode::SetHK, 0, 1),
                 I(Opcode::Ret)},
                recorder.host());
    const uint32_t length = coding(command.opcode).words;
    run.run(1);
    EXPECT_EQ(run->task(1).pc, 6U);
    EXPECT_EQ(run->task(1).depth, 1);
    EXPECT_EQ(run->task(1).calls[0], length);
    EXPECT_EQ(recorder.asked.at(0), command);
  }
  // Deeper than the unit allows it does not call either.
  Recorder recorder{{Answer::Taken}, {}};
  Program recursion({I(Opcode::AddHK, 0, 1), I(Opcode::SystemCall, 1, 0), I(Opcode::End)}, recorder.host());
  EXPECT_EQ(recursion.run().stop, Stop::Faulted);
  EXPECT_EQ(recursion->fault().number, 32);
  EXPECT_EQ(recursion.h(0), 5) << "four nested calls are the limit given";
}

// What a run says of itself: why it stopped and how many commands it took, with each budget.
TEST(Budget, ARunSaysWhyItStopped) {
  const struct {
    Instruction last;
    Stop stop;
  } rows[] = {{I(Opcode::End), Stop::Ended},
              {I(Opcode::Ret), Stop::Ended},
              {I(Opcode::WaitK, 5), Stop::Waiting},
              {I(Opcode::Movlnk, 0), Stop::Waiting},
              {I(Opcode::DivHK, 0, 0), Stop::Faulted}};
  for (const auto& row : rows)
    for (const bool is_fast : {false, true})
      for (uint32_t budget = 0; budget <= 5; ++budget) {
        Recorder recorder{{Answer::Wait}, {}};
        Program run({I(Opcode::Nop), I(Opcode::AddHK, 1, 1), row.last, I(Opcode::End)}, recorder.host());
        std::vector<fast::Slot> slots(fast::Predecoded::slots_needed(run->program().code().size()));
        const fast::Predecoded predecoded(run->program(), slots);
        if (is_fast) run->use(&predecoded);
        const RunResult result = run.run(budget);
        EXPECT_EQ(result.commands, std::min(budget, 3U)) << info(row.last.opcode).text;
        EXPECT_EQ(result.stop, budget < 3 ? Stop::Budget : row.stop) << info(row.last.opcode).text << budget;
        EXPECT_EQ(run->task(1).commands, result.commands);
        EXPECT_EQ(run.h(1), budget > 1 ? 1 : 0);
        if (budget < 3) continue;
        const RunResult again = run.run(budget);
        EXPECT_EQ(again.commands, 0U);
        EXPECT_EQ(again.stop, row.stop == Stop::Faulted ? Stop::Ended : row.stop);
      }
}

// As many variables as it keeps aside, and not one more.
TEST(Ahead, WritesAtMostAsManyVariablesAsItKeeps) {
  Program run({I(Opcode::AddHK, 0, 1), I(Opcode::Jmp, 0)});
  std::vector<fast::Slot> slots(fast::Predecoded::slots_needed(run->program().code().size()));
  const fast::Predecoded predecoded(run->program(), slots);
  run->use(&predecoded);
  for (const size_t count : {size_t{1}, size_t{255}, size_t{256}, size_t{257}, size_t{1000}}) {
    std::vector<uint16_t> written(count);
    for (size_t n = 0; n < count; ++n) written[n] = static_cast<uint16_t>(n);
    EXPECT_EQ(run->run_ahead({2, 2, 2}, 1, written), count <= Machine::kMostRollback) << count;
  }
  EXPECT_EQ(run.h(0), 3);
}

// Milliseconds in single steps: the same commands in the same order as in one go, whatever budgets and steps are.
TEST(Steps, AreTheCommandsOfTheMillisecond) {
  const auto program = {I(Opcode::AddHK, 1, 1),
                        I(Opcode::MulHK, 9, 3),
                        I(Opcode::AddHK, 9, 1),
                        I(Opcode::Jmp, 0),
                        I(Opcode::AddHK, 2, 1),
                        I(Opcode::MulHK, 9, 5),
                        I(Opcode::AddHK, 9, 2),
                        I(Opcode::WaitK, 2),
                        I(Opcode::Jmp, 8),
                        I(Opcode::AddHK, 3, 1),
                        I(Opcode::MulHK, 9, 7),
                        I(Opcode::AddHK, 9, 3),
                        I(Opcode::JmpLtHK, 3, 6, 18),
                        I(Opcode::End)};
  for (const std::array<uint32_t, kTasks>& budgets :
       {std::array<uint32_t, kTasks>{1, 2, 20}, {3, 1, 1}, {0, 4, 5}, {5, 0, 5}, {5, 5, 0}, {0, 0, 0}})
    for (const uint32_t most : {1U, 2U, 3U, 100U}) {
      Program whole(program), steps(program);
      for (Program* run : {&whole, &steps}) {
        (*run)->start_task(2, 8);
        (*run)->start_task(3, 18);
      }
      TickSteps step;
      EXPECT_EQ(step.task(), 0) << "before the first millisecond";
      for (int ms = 0; ms < 20; ++ms) {
        const uint32_t executed = run_tick(*whole.operator->(), Rates{budgets});
        step.begin(*steps.operator->(), Rates{budgets});
        uint32_t sum = 0;
        int last = 1;
        while (step.task() != 0) {
          const int task = step.task();
          EXPECT_GE(task, last) << "in turn";
          EXPECT_EQ(steps->task(task).state, TaskState::Ready);
          const uint64_t before = steps->task(task).commands;
          const uint32_t count = step.step(*steps.operator->(), most);
          EXPECT_GE(count, 1U);
          EXPECT_LE(count, most);
          EXPECT_EQ(steps->task(task).commands, before + count);
          sum += count;
          last = task;
        }
        ASSERT_EQ(sum, executed) << ms;
        for (const size_t n : {1U, 2U, 3U, 9U}) ASSERT_EQ(steps.h(n), whole.h(n)) << ms;
        for (int task = 1; task <= kTasks; ++task) {
          ASSERT_EQ(steps->task(task).pc, whole->task(task).pc);
          ASSERT_EQ(steps->task(task).state, whole->task(task).state);
        }
      }
    }
}

}  // namespace
}  // namespace ipos::vm
