// What a program can still do, and tasks that run ahead: many milliseconds of one task behind those of
// another. The machine that executes every millisecond is the expected value.
#include <gtest/gtest.h>

#include <random>

#include "compiler/compile.hpp"
#include "vm/exec/machine.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/jit/jit.hpp"
#include "vm/sched/outlook.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::tests {
namespace {

using vm::Opcode;
using vm::Outlook;

constexpr vm::Limits kLimits{1024, 16384, 3, 32};

// A compiled program, the machine that runs it and its twin.
class Ahead : public testing::Test {
 protected:
  vm::Machine machine(const std::string& source, bool native = false) {
    compiler::CompileOptions options;
    options.unit = stdlib::find_unit(std::string_view("mdxb"));
    const compiler::Compilation made =
        compiler::compile("ahead.IPC", "", "#include <constb.h>\n" + source, options);
    EXPECT_TRUE(made.image) << source;
    code_ = made.image ? made.image->code : std::vector<uint32_t>{};
    const vm::VerifiedImage program = *vm::verify(code_, kLimits, {}).image;
    slots_.assign(vm::fast::Predecoded::slots_needed(code_.size()), {});
    predecoded_.emplace(program, slots_);
    native_ = native ? vm::jit::compile(program) : nullptr;
    vm::Machine out(program, {});
    out.use(&*predecoded_, native_ ? &native_->native() : nullptr);
    out.start();
    return out;
  }
  void ticks(vm::Machine& m, uint32_t count) {
    for (uint32_t n = 0; n < count; ++n) vm::run_tick(m, rates_);
  }
  static std::vector<uint16_t> written(const vm::Machine& m) {
    const Outlook outlook(m);
    std::vector<uint16_t> numbers;
    for (size_t n = 0; n < outlook.written().size(); ++n)
      if (outlook.written()[n]) numbers.push_back(static_cast<uint16_t>(n));
    return numbers;
  }
  static void expect_same(const vm::Machine& a, const vm::Machine& b) {
    for (uint32_t n = 0; n < kLimits.variables; ++n)
      ASSERT_EQ(a.variables()[n], b.variables()[n]) << "H" << n;
    for (int number = 1; number <= vm::kContexts; ++number) {
      const vm::TaskContext &x = a.context(number), &y = b.context(number);
      ASSERT_EQ(x.state, y.state);
      ASSERT_EQ(x.pc, y.pc);
      ASSERT_EQ(x.wait_ms, y.wait_ms);
      ASSERT_EQ(x.commands, y.commands);
      ASSERT_EQ(x.depth, y.depth);
      for (size_t n = 0; n < x.depth; ++n) ASSERT_EQ(x.calls[n], y.calls[n]);
    }
    ASSERT_EQ(a.fault().number, b.fault().number);
  }

  vm::Rates rates_{{2, 3, 20}};
  std::vector<uint32_t> code_;
  std::vector<vm::fast::Slot> slots_;
  std::optional<vm::fast::Predecoded> predecoded_;
  std::unique_ptr<vm::jit::Code> native_;
};

TEST_F(Ahead, WhatIsBehindATaskItCannotReachAgain) {
  vm::Machine m = machine("main() { _SBusCommOn(); _Wait(3); while (1) H1 = H1 + 1; }");
  EXPECT_TRUE(Outlook(m).reaches(Opcode::ScomOn));
  m.start_task(1, 1);  // as if SCOMON were done: the next command
  EXPECT_FALSE(Outlook(m).reaches(Opcode::ScomOn));
  EXPECT_TRUE(Outlook(m).reaches(Opcode::WaitK));
  ticks(m, 10);
  EXPECT_FALSE(Outlook(m).reaches(Opcode::WaitK));
  EXPECT_TRUE(Outlook(m).reaches(Opcode::AddHK));
  EXPECT_EQ(written(m), std::vector<uint16_t>{1});
}

// Return addresses, tasks that are started, interrupts: all ways count.
TEST_F(Ahead, EveryWayIsFollowed) {
  vm::Machine m = machine(
      "wait() { _Wait(100); } t2() { while (1) H2 = H2 ^ 5; } t3() { H3 = ~H3; }\n"
      "timer() { H4 = H4 >> 1; }\n"
      "main() { wait(); H1 = H1 << 2; if (H1 == 3) { _SetTask2(T2_START, t2); _SetTask(T2_START, t3);\n"
      "_SetInterrupt(SI_TIMER0, timer); } while (1); }");
  ticks(m, 1);
  ASSERT_EQ(m.task(1).state, vm::TaskState::Waiting);
  const Outlook outlook(m);
  for (const Opcode opcode : {Opcode::ShlHK, Opcode::XorHK, Opcode::NotH, Opcode::AshrHK})
    EXPECT_TRUE(outlook.reaches(opcode)) << vm::info(opcode).text;
  EXPECT_FALSE(outlook.reaches(Opcode::Call)) << "called already";
  for (const size_t n : {1u, 2u, 3u, 4u}) EXPECT_TRUE(outlook.written()[n]) << n;
  EXPECT_TRUE(outlook.apart());
  ticks(m, 300);
  EXPECT_FALSE(Outlook(m).reaches(Opcode::ShlHK));
}

TEST_F(Ahead, FaultsAreWhatVariablesDecide) {
  const std::pair<const char*, bool> kRows[] = {{"H1 = H1 + H2;", false},
                                                {"H1 = H1 / 3;", false},
                                                {"H1 = H1 / H2;", true},
                                                {"H1 = H1 % H2;", true},
                                                {"H1 = *H2;", true},
                                                {"*H1 = 4;", true},
                                                {"_Wait(H1);", false},
                                                {"f();", true},
                                                {"_GetSys(H1, GS_ACTSPEED);", true},
                                                {"H1 = H2 << H3; _BitSet(H1, 3);", false}};
  for (const auto& [body, faults] : kRows) {
    vm::Machine m = machine(std::string("f() { H9 = 1; } main() { while (1) { ") + body + " } }");
    EXPECT_EQ(Outlook(m).may_fault(), faults) << body;
  }
}

TEST_F(Ahead, TasksAreApartThatShareNothingWritten) {
  const auto apart = [&](const std::string& two, const std::string& three) {
    vm::Machine m =
        machine("t2() { while (1) { " + two + " } } t3() { while (1) { " + three + " } }\n" +
                "main() { _SetTask2(T2_START, t2); _SetTask(T2_START, t3); while (1) H1 = H1 + H9; }");
    ticks(m, 5);
    return Outlook(m).apart();
  };
  EXPECT_TRUE(apart("H2 = H2 + H9;", "H3 = H9;"));
  EXPECT_FALSE(apart("H2 = H2 + H9;", "H3 = H2;")) << "read";
  EXPECT_FALSE(apart("H2 = 1;", "H2 = 2;")) << "written";
  EXPECT_FALSE(apart("H2 = H1;", "H3 = 1;")) << "of the other task";
  EXPECT_FALSE(apart("H2 = *H9;", "H3 = 1;")) << "any variable read";
  EXPECT_FALSE(apart("*H9 = H2;", "H3 = H9;")) << "any variable written";
}

TEST_F(Ahead, RunsAsIfTakingTurns) {
  std::mt19937 random(11);
  const std::string source =
      "f() { H21 = H21 * 5 + H90; if (H21 & 16) H22 = H22 + 1; }\n"
      "t2() { while (1) { f(); H23 = H23 ^ H21; } }\n"
      "t3() { while (1) { H30 = (H30 * 7 + H91) / 8; if (H30 > H91) H31 = H31 + 1; else H32 = H30; } }\n"
      "main() { _SetTask2(T2_START, t2); _SetTask(T2_START, t3); while (1) { H10 = H10 + 1;\n"
      "switch (H10 & 3) { case 0: H11 = H11 + H90; break; case 2: H12 = H10; break; } } }";
  for (const bool native : {false, true}) {
    if (native && !vm::jit::available()) continue;
    vm::Machine turns = machine(source, native);
    ticks(turns, 3);
    vm::Machine ahead = turns;
    const std::vector<uint16_t> numbers = written(ahead);
    for (int round = 0; round < 2000; ++round) {
      const auto count = static_cast<uint32_t>(1 + random() % 33);
      ticks(turns, count);
      ASSERT_TRUE(ahead.run_ahead(rates_.commands, count, numbers));
      ASSERT_NO_FATAL_FAILURE(expect_same(ahead, turns)) << "after round " << round;
      for (vm::Machine* m : {&turns, &ahead}) m->variables()[90] = m->variables()[91] = round * 37;
    }
  }
}

// It goes as far as only variables and jumps are in the way, and else it does nothing at all.
TEST_F(Ahead, WhatElseComesInBetweenIsForTheTurns) {
  const std::string source =
      "f() { H21 = H21 + 1; if (H21 % 50 == 0) _Wait(4); }\n"
      "t2() { while (1) { f(); } }\n"
      "t3() { while (1) { H30 = H30 + 1000 / (400 - H31); if (H90) H31 = H31 + 1; } }\n"
      "main() { _SetTask2(T2_START, t2); _SetTask(T2_START, t3); while (1) H10 = H10 + 1; }";
  std::mt19937 random(12);
  vm::Machine turns = machine(source);
  ticks(turns, 3);
  vm::Machine ahead = turns;
  const std::vector<uint16_t> numbers = written(ahead);
  int done = 0, refused = 0;
  for (int round = 0; round < 400; ++round) {
    const auto count = static_cast<uint32_t>(2 + random() % 12);
    const vm::Machine before = ahead;
    if (ahead.run_ahead(rates_.commands, count, numbers)) {
      ++done;
    } else {
      ++refused;
      ASSERT_NO_FATAL_FAILURE(expect_same(ahead, before));
      ticks(ahead, count);
    }
    ticks(turns, count);
    ASSERT_NO_FATAL_FAILURE(expect_same(ahead, turns)) << "after round " << round;
    if (round == 200) ahead.variables()[90] = turns.variables()[90] = 1;  // and so to the division by zero
  }
  EXPECT_EQ(ahead.fault().number, vm::kFaultIllop);
  EXPECT_GT(done, 20);
  EXPECT_GT(refused, 20);
}

// What has run ahead can be taken back: the machine is what it was, waits and calls included.
TEST_F(Ahead, CanBeTakenBack) {
  const std::string source =
      "f() { H21 = H21 + H90; }\n"
      "t2() { while (1) { f(); f(); } }\n"
      "t3() { while (1) { H30 = H30 + 1; _Wait(40); } }\n"
      "main() { _SetTask2(T2_START, t2); _SetTask(T2_START, t3); while (1) H10 = H10 * 3 + 1; }";
  std::mt19937 random(13);
  vm::Machine turns = machine(source);
  ticks(turns, 3);
  vm::Machine ahead = turns;
  const std::vector<uint16_t> numbers = written(ahead);
  int taken_back = 0;
  for (int round = 0; round < 300; ++round) {
    const uint32_t most = ahead.waits_on();
    if (most < 2) {
      for (vm::Machine* m : {&turns, &ahead}) ticks(*m, 2);
      continue;
    }
    const auto count = static_cast<uint32_t>(1 + random() % std::min(most, 12U));
    const vm::Machine before = ahead;
    vm::Machine::BeforeAhead stand;
    ASSERT_TRUE(ahead.run_ahead(rates_.commands, count, numbers, stand));
    EXPECT_FALSE(ahead.waits_on() == most) << "the waits go on";
    ahead.take_back(numbers, stand);
    ASSERT_NO_FATAL_FAILURE(expect_same(ahead, before)) << "in round " << round;
    ++taken_back;
    ticks(turns, count);
    ticks(ahead, count);
    ASSERT_NO_FATAL_FAILURE(expect_same(ahead, turns)) << "after round " << round;
    for (vm::Machine* m : {&turns, &ahead}) m->variables()[90] = round * 41;
  }
  EXPECT_GT(taken_back, 100);
  // An end of a wait is for the turns.
  ASSERT_LT(ahead.waits_on(), 40U);
  vm::Machine::BeforeAhead stand;
  EXPECT_FALSE(ahead.run_ahead(rates_.commands, ahead.waits_on() + 1, numbers, stand));
}

TEST_F(Ahead, NotWithInterruptsAndNotByTheReference) {
  vm::Machine m =
      machine("timer() { H2 = 1; } main() { _SetInterrupt(SI_TIMER0, timer); while (1) H1 = H1 + 1; }");
  ticks(m, 3);
  EXPECT_FALSE(m.run_ahead(rates_.commands, 2, written(m)));
  vm::Machine plain = machine("main() { while (1) H1 = H1 + 1; }");
  EXPECT_TRUE(plain.run_ahead(rates_.commands, 2, written(plain)));
  plain.use(nullptr);
  EXPECT_FALSE(plain.run_ahead(rates_.commands, 2, written(plain)));
}

}  // namespace
}  // namespace ipos::tests
