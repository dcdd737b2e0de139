// Runs a program with other tasks and with interrupts breaking in after every single command and in every
// millisecond of a wait: what a task computes must not depend on when that happens.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/compiler/backend_test.hpp"
#include "vm/exec/machine.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::compiler::test {
namespace {

// Tasks 2 and 3 of both programs.
const std::string kTasks2And3 = R"(t2() {
  r2 = (in + 1) * (in + 2) - (in + 3) * (in - (in + 4) * 3);
  shared();
  v[in & 3] = r2 * (in - 1) + (r2 > in) * 2;
  r2 = r2 * 3 - (r2 + v[in & 3]) * (r2 - 2) + (in < r2) * (in + 5);
}
t3() {
  r3 = (in + 4) * (in - 2) - ((in ^ 9) + 3) * (in - (in << 1) * 5);
  shared();
  r3 = r3 * 2 - (r3 + 7) * (r3 - 3) + (in == 11) * (r3 - 1);
}
)";

// All three compute with temporaries, through a function they share and through conditions, steps and
// pointers.
const std::string kProgram = R"(
long r1, r2, r3, in, p, v[4], w, q, i, sum;
// Reached by all three: each has a copy with temporaries of its own.
shared() { if ((in + 3) * (in - 5) - (in << 2) * (7 - in) == 0) sum = (in + 1) * (in + 2); }
)" + kTasks2And3 + R"(main() {
  _SetTask2(T2_START, t2);
  _SetTask(T2_START, t3);
  r1 = (in * 3 + 4) * (in - 7) - (in + 2) * (in - (in + 1) * (in - 3));
  shared();
  p = numof(q);
  *p = (in + r1) * (in - r1);
  w = q++ * (q - in) + *p * (r1 - (w = 3));
  for (i = 0; i < 3; i++) w += (i + w) * (i - w) ? w * i - (i == 1) : (r1 + 1) * (r1 - 1);
  switch ((w & 3) * (w | 1)) {
    case 0: w = 1; break;
    case 1: w += 7;
    default: w = w * 2 - (w + 1) * (w - 1);
  }
}
)";

// Three interrupts of task 1 and a variable interrupt each of tasks 2 and 3; all of them compute as above.
const std::string kInterrupted = R"(
#pragma globals 200 259
#pragma var 260 359
long r1, r2, r3, rt, rp, re, v2, v3, in, p, v[4], w, q, i, sum, e2, e3;
VARINT a2, a3;
shared() { if ((in + 3) * (in - 5) - (in << 2) * (7 - in) == 0) sum = (in + 1) * (in + 2); }
timer() { rt = (in + 1) * (in - 2) - (in + 3) * (in - (in + 4)); shared(); rt = rt * 5 - (rt + 1) * (in == 11); }
probe() { rp = (in + 2) * (in - 3) - (in + 4) * (in - (in + 5)); shared(); rp = rp * 7 - (rp + 2) * (in > 10); }
error() { re = (in + 3) * (in - 4) - (in + 5) * (in - (in + 6)); shared(); re = re * 9 - (re + 3) * (in < 12); }
i2() { v2 = (in + 4) * (in - 5) - (in + 6) * (in - (in + 7)); shared(); v2 = v2 * 3 - (v2 + 4) * (in != 3); }
i3() { v3 = (in + 5) * (in - 6) - (in + 7) * (in - (in + 8)); shared(); v3 = v3 * 2 - (v3 + 5) * (in >= 9); }
)" + kTasks2And3 + R"(main() {
  _SetInterrupt(SI_ERROR, error);
  _SetInterrupt(SI_TOUCHP1, probe);
  _SetInterrupt(SI_TIMER0, timer);
  a2.Control = 1; a2.IntNum = 0; a2.SrcVar = numof(e2); a2.Priority = 1;
  a3.Control = 2; a3.IntNum = 1; a3.SrcVar = numof(e3); a3.Priority = 1;
  _SetVarInterrupt(a2, i2);
  _SetVarInterrupt(a3, i3);
  _SetTask2(T2_START, t2);
  _SetTask(T2_START, t3);
  i = 0;
  r1 = (in * 3 + 4) * (in - 7) - (in + 2) * (in - (in + 1) * (in - 3));
  shared();
  p = numof(q);
  *p = (in + r1) * (in - r1);
  w = q++ * (q - in) + *p * (r1 - (w = 3));
  for (i = 0; i < 3; i++) w += (i + w) * (i - w) ? w * i - (i == 1) : (r1 + 1) * (r1 - 1);
}
)";

vm::HostReply no_host(void*, vm::Machine&, int, const vm::Instruction&) noexcept { return {}; }

class Interruption : public testing::Test {
 protected:
  void SetUp() override { compile_program(kProgram); }

  void compile_program(const std::string& text) {
    compilation_ = compile_text(std::string("#include <const.h>") + text, "mdxb");
    ASSERT_TRUE(compilation_.image) << render_text(compilation_.diagnostics.all(), *compilation_.sources,
                                                   false);
    const stdlib::UnitType& unit = *compilation_.unit;
    const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
    verified_ = vm::verify(compilation_.image->code, limits, {}).image;
    ASSERT_TRUE(verified_);
  }

  uint32_t address(std::string_view name) const {
    for (const vm::FunctionEntry& function : compilation_.image->functions)
      if (function.name == name) return function.address;
    return 0;
  }

  int32_t number(std::string_view name) const {
    for (const vm::Symbol& symbol : compilation_.image->symbols)
      if (symbol.name == name) return symbol.variable;
    return 0;
  }

  // r1 w q of main, r2 of task 2, r3 of task 3, when task 2 breaks in after `first` commands of main and task
  // 3 after `second` commands of task 2.
  std::vector<int32_t> run(uint32_t first, uint32_t second) {
    vm::Machine machine(*verified_, vm::Host{nullptr, no_host});
    machine.variables()[static_cast<size_t>(number("in"))] = 11;
    machine.start();
    length1_ = machine.run(1, first).commands;
    machine.start_task(2, address("t2"));
    length2_ = machine.run(2, second).commands;
    machine.start_task(3, address("t3"));
    machine.run(3, 10000);
    length2_ += machine.run(2, 10000).commands;
    length1_ += machine.run(1, 10000).commands;
    EXPECT_EQ(0, machine.fault().number);
    std::vector<int32_t> out;
    for (const char* name : {"r1", "w", "q", "r2", "r3"})
      out.push_back(machine.variables()[static_cast<size_t>(number(name))]);
    return out;
  }

  Compilation compilation_;
  std::optional<vm::VerifiedImage> verified_;
  uint32_t length1_ = 0;
  uint32_t length2_ = 0;
};

TEST_F(Interruption, AfterEveryCommandChangesNothing) {
  const std::vector<int32_t> expected = run(0, 0);
  const uint32_t length1 = length1_;
  const uint32_t length2 = length2_;
  ASSERT_GT(length1, 60U);
  ASSERT_GT(length2, 25U);
  for (uint32_t first = 0; first <= length1; ++first)
    for (uint32_t second = 0; second <= length2; ++second)
      ASSERT_EQ(expected, run(first, second)) << "after " << first << " and " << second << " commands";
}

using vm::Event;
using vm::Machine;

class RealInterrupts : public Interruption {
 protected:
  void SetUp() override { compile_program(kInterrupted); }

  static constexpr uint32_t kToTheEnd = 10'000;

  int32_t& value(Machine& machine, std::string_view name) const {
    return machine.variables()[static_cast<size_t>(number(name))];
  }

  // After main has installed and started everything.
  Machine started() const {
    Machine machine(*verified_, vm::Host{nullptr, no_host});
    value(machine, "in") = 11;
    machine.start();
    while (machine.task(3).state == vm::TaskState::Stopped) machine.run(1, 1);
    return machine;
  }

  // Lets milliseconds pass, in which nothing waits, until the routine has begun.
  static void begin(Machine& machine, int context) {
    for (int ms = 0; ms < 3 && machine.context(context).state == vm::TaskState::Stopped; ++ms) machine.tick();
    ASSERT_EQ(machine.context(context).state, vm::TaskState::Ready);
  }

  std::vector<int32_t> results(Machine& machine, std::initializer_list<const char*> names) const {
    EXPECT_EQ(0, machine.fault().number);
    std::vector<int32_t> out;
    for (const char* name : names) out.push_back(value(machine, name));
    return out;
  }

  // Commands a context takes from here to its end.
  static uint32_t length(Machine machine, int task) { return machine.run(task, kToTheEnd).commands; }
};

// ERROR into TOUCH PROBE into TIMER 0 into main, each after every command.
TEST_F(RealInterrupts, OfTask1NestedAfterEveryCommandChangeNothing) {
  const auto all = {"r1", "w", "q", "rt", "rp", "re"};
  const Machine fresh = started();
  Machine alone = fresh;
  for (const Event event : {Event::Timer0, Event::TouchProbe, Event::Error}) {
    alone.raise_event(event);
    begin(alone, context_of(event));
    alone.run(1, length(alone, 1) == 0 ? 0 : 1);  // as soon as possible
  }
  alone.run(1, kToTheEnd);
  const std::vector<int32_t> expected = results(alone, all);
  EXPECT_NE(std::count(expected.begin(), expected.end(), 0), static_cast<int>(expected.size()));

  uint64_t interruptions = 0;
  Machine main = fresh;
  const uint32_t main_length = length(main, 1);
  ASSERT_GT(main_length, 60U);
  for (uint32_t first = 0; first < main_length; ++first, main.run(1, 1)) {
    Machine timer = main;
    timer.raise_event(Event::Timer0);
    begin(timer, context_of(Event::Timer0));
    const uint32_t timer_length = length(timer, 1) - length(main, 1);
    for (uint32_t second = 0; second < timer_length; ++second, timer.run(1, 1)) {
      Machine probe = timer;
      probe.raise_event(Event::TouchProbe);
      begin(probe, context_of(Event::TouchProbe));
      const uint32_t probe_length = length(probe, 1) - length(timer, 1);
      for (uint32_t third = 0; third < probe_length; ++third, probe.run(1, 1)) {
        Machine error = probe;
        error.raise_event(Event::Error);
        begin(error, context_of(Event::Error));
        error.run(1, kToTheEnd);
        ++interruptions;
        ASSERT_EQ(expected, results(error, all)) << first << ", " << second << ", " << third << " commands";
      }
    }
  }
  std::printf("main interrupted after each of %u commands, with nested interrupts: %llu runs\n", main_length,
              static_cast<unsigned long long>(interruptions));
}

TEST_F(RealInterrupts, OfTasks2And3AfterEveryCommandChangeNothing) {
  const auto all = {"r1", "w", "q", "r2", "r3", "v2", "v3"};
  uint64_t interruptions = 0;
  std::vector<int32_t> expected;
  Machine second = started();
  const uint32_t second_length = length(second, 2);
  ASSERT_GT(second_length, 25U);
  for (uint32_t n = 0; n < second_length; ++n, second.run(2, 1)) {
    Machine third = second;
    third.variables()[vm::kVarIntReq] = 0b01;
    begin(third, vm::context_of_variable_interrupt(0));
    third.run(2, n % 7);  // its routine is under way while the other one breaks into task 3
    const uint32_t third_length = length(third, 3);
    for (uint32_t m = 0; m < third_length; ++m, third.run(3, 1)) {
      Machine run = third;
      run.variables()[vm::kVarIntReq] = 0b10;
      begin(run, vm::context_of_variable_interrupt(1));
      for (const int task : {3, 2, 1}) run.run(task, kToTheEnd);
      ++interruptions;
      const std::vector<int32_t> got = results(run, all);
      if (expected.empty()) expected = got;
      ASSERT_EQ(expected, got) << "after " << n << " and " << m << " commands";
    }
  }
  std::printf("tasks 2 and 3 interrupted after each of their commands: %llu runs\n",
              static_cast<unsigned long long>(interruptions));
}

// A program of waits and commands, a routine that waits itself: main ends its waits in the same milliseconds
// as without interrupts, and computes the same.
TEST_F(RealInterrupts, EveryWaitInEveryMillisecondChangesNothing) {
  compile_program(R"(
long in, r, d, rt;
timer() { rt = (in + 1) * (in - 2); _Wait(d); rt = rt * 5 - (rt + 1) * (in == 11); }
main() {
  _SetInterrupt(SI_TIMER0, timer);
  r = (in + 2) * (in - 1);
  _Wait(7);
  r = r * (in + 3) - (r + 1) * (in - 4);
  _Wait(1);
  r += in;
  _Wait(in);
  r = r * (in + 5) - (r - 1) * (in + 6);
}
)");
  // Ticks until main has ended, interrupted in the given one.
  const auto run = [&](int interrupted, int32_t routine_ms, std::vector<int32_t>& out) {
    Machine machine(*verified_, vm::Host{nullptr, no_host});
    value(machine, "in") = 11;
    value(machine, "d") = routine_ms;
    machine.start();
    int ticks = 0;
    for (; machine.task(1).state != vm::TaskState::Stopped && ticks < 100; ++ticks) {
      if (ticks == interrupted) machine.raise_event(Event::Timer0);
      vm::run_tick(machine, vm::Rates{{100, 0, 0}});
    }
    out = results(machine, {"r", "rt"});
    return ticks;
  };
  std::vector<int32_t> expected;
  const int undisturbed = run(1, 0, expected);
  EXPECT_EQ(undisturbed, 7 + 1 + 11 + 1);  // the waits, and the millisecond of the start
  uint64_t interruptions = 0;
  for (int32_t routine_ms = 0; routine_ms <= 25; ++routine_ms)
    for (int at = 1; at < undisturbed; ++at) {
      std::vector<int32_t> got;
      const int ticks = run(at, routine_ms, got);
      ++interruptions;
      ASSERT_EQ(expected, got) << "in millisecond " << at;
      // The wait under way goes on behind the routine with what is left; those after it are waited in full.
      // In a millisecond in which a wait ends the routine comes between two waits.
      const int rest = at <= 7 ? 7 : at == 8 ? 8 : 19;
      ASSERT_EQ(ticks, undisturbed + std::max(0, at + routine_ms - rest)) << at << ", " << routine_ms;
    }
  std::printf("waits interrupted in each millisecond by routines of 0 to 25 ms: %llu runs\n",
              static_cast<unsigned long long>(interruptions));
}

}  // namespace
}  // namespace ipos::compiler::test
