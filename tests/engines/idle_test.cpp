// Idle skipping: a machine that skips is at every moment what one is that executes every command. The run
// without skipping is the expected value.
#include <gtest/gtest.h>

#include "compiler/compile.hpp"
#include "tests/engines/pair.hpp"
#include "vm/exec/machine.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::tests {
namespace {

std::vector<uint32_t> compiled(const std::string& source) {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view("mdxb"));
  const compiler::Compilation made =
      compiler::compile("idle.IPC", "", "#include <constb.h>\n" + source, options);
  return made.image ? made.image->code : std::vector<uint32_t>{};
}

constexpr vm::Limits kLimits{1024, 16384, 3, 32};

class Idle : public testing::Test {
 protected:
  vm::Machine machine(const std::string& source) {
    code_ = compiled(source);
    vm::Machine out(*vm::verify(code_, kLimits, {}).image, {});
    out.start();
    return out;
  }
  std::vector<uint32_t> code_;
  vm::Rates rates_{{3, 5, 20}};
};

TEST_F(Idle, AWaitIsIdleUntilItsLastTick) {
  vm::Machine m = machine("main() { _Wait(100); H0 = 1; while (1) H1++; }");
  vm::run_tick(m, rates_);
  EXPECT_EQ(m.idle_ticks(rates_.commands), 99U);
  uint64_t executed = 0;
  EXPECT_EQ(skip_idle(m, rates_, 1000, executed), 99U);
  EXPECT_EQ(executed, 0U);
  EXPECT_EQ(m.idle_ticks(rates_.commands), 0U);
  vm::run_tick(m, rates_);
  EXPECT_EQ(m.variables()[0], 1);
  EXPECT_EQ(m.idle_ticks(rates_.commands), 0U) << "the loop counts";
}

TEST_F(Idle, ALoopThatLooksIsIdleForEver) {
  vm::Machine m = machine("main() { while (1) { if (H5 & 8) H0++; H1 = H5 + 1; } }");
  vm::run_tick(m, rates_);
  vm::run_tick(m, rates_);
  vm::run_tick(m, rates_);
  EXPECT_EQ(m.idle_ticks(rates_.commands), vm::kIdleForever);
  uint64_t executed = 0;
  const uint64_t before = m.task(1).commands;
  EXPECT_EQ(skip_idle(m, rates_, 1'000'000'000'000, executed), 1'000'000'000'000U);
  EXPECT_EQ(executed, 3'000'000'000'000U);
  EXPECT_EQ(m.task(1).commands, before + 3'000'000'000'000U);
  m.variables()[5] = 8;
  EXPECT_EQ(m.idle_ticks(rates_.commands), 0U);
}

// It passes the same command many times before everything is as it was.
TEST_F(Idle, ALoopOfManyTurnsIsIdleWhereverItStands) {
  vm::Machine skips = machine("main() { while (1) { H1 = H1 + 1; if (H1 == 30) H1 = 0; } }");
  vm::Machine runs = skips;
  for (uint64_t ticks = 1; ticks < 200; ++ticks) {
    uint64_t executed = 0;
    EXPECT_EQ(skip_idle(skips, rates_, ticks, executed), ticks);
    for (uint64_t n = 0; n < ticks; ++n) vm::run_tick(runs, rates_);
    ASSERT_EQ(skips.variables()[1], runs.variables()[1]) << "after " << ticks;
    ASSERT_EQ(skips.task(1).pc, runs.task(1).pc);
    ASSERT_EQ(skips.task(1).commands, runs.task(1).commands);
  }
}

// And it may call functions, from several places.
TEST_F(Idle, ALoopIsIdleInItsFunctionsToo) {
  vm::Machine skips = machine(
      "g() { H3 = H2; } f() { H1 = H2 * 3; g(); } main() { while (1) { f(); g(); f(); if (H4) H5++; } }");
  for (int n = 0; n < 20; ++n) vm::run_tick(skips, rates_);
  vm::Machine runs = skips;
  for (uint64_t ticks = 1; ticks < 200; ++ticks) {
    uint64_t executed = 0;
    EXPECT_EQ(skip_idle(skips, rates_, ticks, executed), ticks);
    for (uint64_t n = 0; n < ticks; ++n) vm::run_tick(runs, rates_);
    ASSERT_EQ(skips.task(1).pc, runs.task(1).pc) << "after " << ticks;
    ASSERT_EQ(skips.task(1).depth, runs.task(1).depth);
    ASSERT_EQ(skips.task(1).calls[0], runs.task(1).calls[0]);
    ASSERT_EQ(skips.task(1).commands, runs.task(1).commands);
  }
}

TEST_F(Idle, VariablesThatChangeForAMomentAreNotSteady) {
  vm::Idle idle;
  vm::Machine rests = machine("main() { while (1); }");
  for (int n = 0; n < 3; ++n) vm::run_tick(rests, rates_);
  EXPECT_EQ(rests.idle_ticks(rates_.commands, idle), vm::kIdleForever);
  EXPECT_TRUE(idle.steady);
  vm::Machine counts = machine("main() { while (1) { H1 = H5; H1 = H1 + 1; } }");
  for (int n = 0; n < 3; ++n) vm::run_tick(counts, rates_);
  EXPECT_EQ(counts.idle_ticks(rates_.commands, idle), vm::kIdleForever);
  EXPECT_FALSE(idle.steady);
}

TEST_F(Idle, WhatOthersSeeChangeIsNotIdle) {
  const std::string loop = "while (1) { H1 = H5; H1 = H1 + 1; }";
  vm::Machine alone = machine("main() { " + loop + " }");
  for (int n = 0; n < 3; ++n) vm::run_tick(alone, rates_);
  EXPECT_EQ(alone.idle_ticks(rates_.commands), vm::kIdleForever);
  vm::Machine seen = machine("t2() { while (1) H2 = H1; } main() { _SetTask2(T2_START, t2); " + loop + " }");
  for (int n = 0; n < 8; ++n) vm::run_tick(seen, rates_);
  EXPECT_EQ(seen.idle_ticks(rates_.commands), 0U);
  vm::Machine output = machine("main() { while (1) { H481 = H5; H481 = H481 + 1; } }");
  for (int n = 0; n < 3; ++n) vm::run_tick(output, rates_);
  EXPECT_EQ(output.idle_ticks(rates_.commands), 0U) << "the unit looks at system variables in each tick";
}

TEST_F(Idle, AFaultIsNotSkipped) {
  vm::Machine m = machine("main() { while (1) H1 = 7 / H0; }");
  m.variables()[0] = 3;
  for (int n = 0; n < 4; ++n) vm::run_tick(m, rates_);
  EXPECT_EQ(m.idle_ticks(rates_.commands), vm::kIdleForever);
  m.variables()[0] = 0;
  EXPECT_EQ(m.idle_ticks(rates_.commands), 0U);
  vm::run_tick(m, rates_);
  EXPECT_EQ(m.fault().number, vm::kFaultIllop);
}

// Programs that spin, wait and react, with three tasks and interrupts; what one run skips the other executes.
TEST_F(Idle, SkippingChangesNothing) {
  const char* const kSources[] = {
      R"(t2() { while (1) { if (H300 > 5) { H301++; H300 = 0; } } }
         t3() { while (1) { _Wait(7); H302 += H301; } }
         main() { _SetTask2(T2_START, t2); _SetTask(T2_START, t3);
                  while (1) { while (H303 == 0); H304++; H303 = 0; _Wait(20); } })",
      R"(look() { if (H300 == 3) H301 = H302; }
         t2() { while (1) { look(); look(); } }
         t3() { do { H310 = H300 * 3; } while (H310 != 12); H311++; _Wait(50); }
         timer() { H312++; }
         main() { _SetTask2(T2_START, t2); _SetTask(T2_START, t3); _SetInterrupt(SI_TIMER0, timer);
                  while (1) { switch (H303) { case 1: H304 = 5; break; case 2: H304 = H305; break; } } })",
  };
  uint64_t skipped = 0, all = 0;
  for (const char* source : kSources)
    for (uint64_t seed = 1; seed <= 40; ++seed) {
      const std::vector<uint32_t> code = compiled(source);
      ASSERT_FALSE(code.empty());
      const auto program = *vm::verify(code, kLimits, {}).image;
      EXPECT_EQ(run_idle_pair(program, seed, 200, skipped, all), "");
    }
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    const std::vector<uint32_t> code = with_interrupts(sequence_soup(seed), kLimits, seed);
    EXPECT_EQ(run_idle_pair(*vm::verify(code, kLimits, {}).image, seed, 100, skipped, all), "");
  }
  std::printf("%llu of %llu ticks skipped\n", static_cast<unsigned long long>(skipped),
              static_cast<unsigned long long>(all));
  EXPECT_GT(skipped * 2, all);
}

}  // namespace
}  // namespace ipos::tests
