// Machine code where random programs seldom go: division by constants, indexes that lead to variables in
// registers, calls and returns around system commands, protection of its memory. Expected values are computed
// here.
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

#include "compiler/codegen/compile.hpp"
#include "tests/engines/pair.hpp"
#include "vm/exec/machine.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/jit/jit.hpp"

namespace ipos::tests {
namespace {

using vm::Opcode;

constexpr vm::Limits kLimits{1024, 16384, 3, 6};
constexpr uint32_t kBudget = 1'000'000;

class Native : public testing::Test {
 protected:
  void SetUp() override {
    if (!vm::jit::available()) GTEST_SKIP() << "this build has no machine code";
  }

  void add(Opcode opcode, std::array<int32_t, vm::kMaxOperands> operands) {
    std::array<uint32_t, vm::kMaxWords> words{};
    const uint32_t length = vm::encode({opcode, operands}, words);
    code_.insert(code_.end(), words.begin(), words.begin() + length);
  }
  int32_t here() const { return static_cast<int32_t>(code_.size()); }

  void compile(const std::string& source) {
    compiler::CompileOptions options;
    options.unit = stdlib::find_unit(std::string_view("mdxb"));
    const compiler::Compilation made = compiler::compile("native.IPC", "", source, options);
    ASSERT_TRUE(made.image);
    code_ = made.image->code;
  }

  // Executes with machine code and leaves the machine in machine_.
  vm::RunResult run() {
    const vm::Verification verified = vm::verify(code_, kLimits, {});
    EXPECT_TRUE(verified.image);
    slots_.resize(vm::fast::Predecoded::slots_needed(code_.size()));
    predecoded_.emplace(*verified.image, slots_);
    native_ = vm::jit::compile(*verified.image);
    machine_.emplace(*verified.image, vm::Host{});
    machine_->use(&*predecoded_, &native_->native());
    machine_->start();
    return machine_->run(1, kBudget);
  }
  int32_t h(size_t number) const { return machine_->variables()[number]; }

  std::vector<uint32_t> code_;
  std::vector<vm::fast::Slot> slots_;
  std::optional<vm::fast::Predecoded> predecoded_;
  std::unique_ptr<vm::jit::Code> native_;
  std::optional<vm::Machine> machine_;
};

TEST_F(Native, DividesByConstantsTowardZero) {
  constexpr int32_t kLeast = std::numeric_limits<int32_t>::min();
  constexpr int32_t kMost = std::numeric_limits<int32_t>::max();
  std::vector<int32_t> numbers = {kLeast, kLeast + 1, kMost, kMost - 1, 0};
  for (int32_t bit = 0; bit < 31; ++bit)
    for (int32_t near = -1; near <= 1; ++near) {
      numbers.push_back((1 << bit) + near);
      numbers.push_back(-(1 << bit) + near);
    }
  for (const int32_t odd : {7, 10, 100, 641, 1000, 3600, 65537, 1'000'000, 715827883}) {
    numbers.push_back(odd);
    numbers.push_back(-odd);
  }
  for (const int32_t divisor : numbers) {
    if (divisor == 0) continue;
    code_.clear();
    // A loop over a table of dividends, in place: H500.. quotients, H750.. remainders.
    add(Opcode::SetHK, {10, 500, 0, 0});
    add(Opcode::SetHK, {11, 750, 0, 0});
    const int32_t again = here();
    add(Opcode::SetiLoad, {12, 10, 0, 0});
    add(Opcode::SetHH, {13, 12, 0, 0});
    add(Opcode::DivHK, {12, divisor, 0, 0});
    add(Opcode::ModHK, {13, divisor, 0, 0});
    add(Opcode::SetiStore, {10, 12, 0, 0});
    add(Opcode::SetiStore, {11, 13, 0, 0});
    add(Opcode::AddHK, {10, 1, 0, 0});
    add(Opcode::AddHK, {11, 1, 0, 0});
    add(Opcode::JmpLtHK, {10, 500 + static_cast<int32_t>(numbers.size()), again, 0});
    add(Opcode::End, {});
    const vm::Verification verified = vm::verify(code_, kLimits, {});
    ASSERT_TRUE(verified.image);
    slots_.resize(vm::fast::Predecoded::slots_needed(code_.size()));
    predecoded_.emplace(*verified.image, slots_);
    native_ = vm::jit::compile(*verified.image);
    vm::Machine machine(*verified.image, {});
    machine.use(&*predecoded_, &native_->native());
    for (size_t n = 0; n < numbers.size(); ++n) machine.variables()[500 + n] = numbers[n];
    machine.start();
    ASSERT_EQ(machine.run(1, kBudget).stop, vm::Stop::Ended);
    for (size_t n = 0; n < numbers.size(); ++n) {
      const int64_t x = numbers[n];
      EXPECT_EQ(machine.variables()[500 + n], static_cast<int32_t>(x / divisor)) << x << " / " << divisor;
      EXPECT_EQ(machine.variables()[750 + n], static_cast<int32_t>(x % divisor)) << x << " % " << divisor;
    }
  }
}

// The loop's own variables lie in the table it writes: k jumps from 12 over 13 and 14 to 99.
TEST_F(Native, AnIndexReachesVariablesInRegisters) {
  compile(R"(#pragma globals 12 30
             long k, sum, turns;
             main() {
               for (k = 10; k < 99; k++) {
                 *k = k + 80;
                 sum += *k;
                 turns++;
               }
             })");
  EXPECT_EQ(run().stop, vm::Stop::Ended);
  // k = 10 and 11 write H10 and H11; k = 12 writes itself: 92, then adds *92, which is still 0.
  EXPECT_EQ(h(10), 90);
  EXPECT_EQ(h(11), 91);
  int32_t k = 92, sum = 90 + 91, turns = 3;
  for (++k; k < 99; ++k) sum += k + 80, ++turns;
  EXPECT_EQ(h(12), 99);
  EXPECT_EQ(h(13), sum);
  EXPECT_EQ(h(14), turns);
  EXPECT_EQ(h(98), 178);
}

// A budget ends anywhere, in any depth of calls; the machine goes on as if nothing had been.
TEST_F(Native, AnyBudgetGivesTheSameEnd) {
  compile(R"(long result, i, n;
             add() { result += n; }
             twice() { add(); n++; add(); }
             main() { for (i = 0; i < 40; i++) { n = i; twice(); if (i == 20) continue; result ^= i; } })");
  const uint32_t commands = run().commands;
  const std::vector<int32_t> end(machine_->variables().begin(), machine_->variables().end());
  int32_t expected = 0;
  for (int32_t i = 0; i < 40; ++i) {
    expected += i + i + 1;
    if (i != 20) expected ^= i;
  }
  EXPECT_NE(std::find(end.begin(), end.end(), expected), end.end());
  for (uint32_t budget = 1; budget < 200; ++budget) {
    machine_.emplace(machine_->program(), vm::Host{});
    machine_->use(&*predecoded_, &native_->native());
    machine_->start();
    uint32_t executed = 0;
    vm::RunResult result{};
    do {
      result = machine_->run(1, budget);
      executed += result.commands;
      ASSERT_TRUE(result.stop != vm::Stop::Budget || result.commands == budget);
    } while (result.stop == vm::Stop::Budget);
    EXPECT_EQ(executed, commands) << budget;
    EXPECT_TRUE(std::equal(end.begin(), end.end(), machine_->variables().begin())) << budget;
  }
}

TEST_F(Native, CallsTooDeepAreAFault) {
  compile("long n; down() { n++; down(); } main() { down(); }");
  const vm::RunResult result = run();
  EXPECT_EQ(result.stop, vm::Stop::Faulted);
  EXPECT_EQ(machine_->fault().number, vm::kFaultIndexOverflow);
  EXPECT_EQ(machine_->task(1).depth, kLimits.call_depth);
  EXPECT_EQ(
      std::count(machine_->variables().begin(), machine_->variables().end(), int32_t{kLimits.call_depth}), 1);
}

TEST_F(Native, NoPageIsWritableAndExecutable) {
  compile("long n; main() { for (n = 0; n < 100; n++); }");
  run();
  std::ifstream maps("/proc/self/maps");
  if (!maps) GTEST_SKIP() << "no /proc";
  for (std::string line; std::getline(maps, line);) EXPECT_EQ(line.find("rwx"), std::string::npos) << line;
}

}  // namespace
}  // namespace ipos::tests
