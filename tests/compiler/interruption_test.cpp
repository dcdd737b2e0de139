// Runs a program with two other tasks breaking in after every single command: what a task computes must not
// depend on when that happens.
#include <gtest/gtest.h>

#include "tests/compiler/backend_test.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::compiler::test {
namespace {

// All three compute with temporaries, through a function they share and through conditions, steps and
// pointers.
const char* const kProgram = R"(
long r1, r2, r3, in, p, v[4], w, q, i, sum;
// Reached by all three: each has a copy with temporaries of its own.
shared() { if ((in + 3) * (in - 5) - (in << 2) * (7 - in) == 0) sum = (in + 1) * (in + 2); }
t2() {
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
main() {
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

vm::HostReply no_host(void*, vm::Machine&, int, const vm::Instruction&) noexcept { return {}; }

class Interruption : public testing::Test {
 protected:
  void SetUp() override {
    compilation_ = compile_text(std::string("#include <const.h>") + kProgram, "mdxb");
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

}  // namespace
}  // namespace ipos::compiler::test
