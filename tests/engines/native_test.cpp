// Machine code where random programs seldom go: constants of every shape, division by constants, indexes that
// lead to variables in registers, calls and returns around system commands, protection of its memory.
// Expected values are computed here.
#include <gtest/gtest.h>

#ifdef _WIN32
#include <windows.h>
#endif

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "vm/context/arithmetic.hpp"
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
  static int32_t words(Opcode opcode) { return vm::info(opcode).words; }

  // Executes with machine code, these in H500.., and leaves the machine in machine_.
  vm::RunResult run(const std::vector<int32_t>& numbers = {}) {
    const vm::Verification verified = vm::verify(code_, limits_, {});
    EXPECT_TRUE(verified.image);
    slots_.resize(vm::fast::Predecoded::slots_needed(code_.size()));
    predecoded_.emplace(*verified.image, slots_);
    native_ = vm::jit::compile(*verified.image);
    EXPECT_NE(native_, nullptr);
    machine_.emplace(*verified.image, vm::Host{});
    machine_->use(&*predecoded_, native_ ? &native_->native() : nullptr);
    std::copy(numbers.begin(), numbers.end(), machine_->variables().begin() + 500);
    machine_->start();
    return machine_->run(1, kBudget);
  }
  int32_t h(size_t number) const { return machine_->variables()[number]; }

  vm::Limits limits_ = kLimits;
  std::vector<uint32_t> code_;
  std::vector<vm::fast::Slot> slots_;
  std::optional<vm::fast::Predecoded> predecoded_;
  std::unique_ptr<vm::jit::Code> native_;
  std::optional<vm::Machine> machine_;
};

// Numbers around which processors change their mind: powers of 2, what they can hold in an instruction.
std::vector<int32_t> telling_numbers() {
  constexpr int32_t kLeast = std::numeric_limits<int32_t>::min();
  constexpr int32_t kMost = std::numeric_limits<int32_t>::max();
  std::vector<int32_t> numbers = {kLeast, kLeast + 1, kMost, kMost - 1, 0};
  for (int32_t bit = 0; bit < 31; ++bit)
    for (int32_t beside = -1; beside <= 1; ++beside) {
      numbers.push_back((1 << bit) + beside);
      numbers.push_back(-(1 << bit) + beside);
    }
  for (const int32_t other : {7, 10, 100, 641, 1000, 3600, 0xFFF000, 0x555555, 715827883}) {
    numbers.push_back(other);
    numbers.push_back(-other);
  }
  return numbers;
}

TEST_F(Native, DividesByConstantsTowardZero) {
  const std::vector<int32_t> numbers = telling_numbers();
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
    ASSERT_EQ(run(numbers).stop, vm::Stop::Ended);
    for (size_t n = 0; n < numbers.size(); ++n) {
      const int64_t x = numbers[n];
      EXPECT_EQ(h(500 + n), static_cast<int32_t>(x / divisor)) << x << " / " << divisor;
      EXPECT_EQ(h(750 + n), static_cast<int32_t>(x % divisor)) << x << " % " << divisor;
    }
  }
}

// What a command with a constant does, in 64 bits.
struct WithConstant {
  Opcode opcode;
  int64_t (*result)(int64_t x, int64_t k);
};
uint32_t low(int64_t x) { return static_cast<uint32_t>(x); }
constexpr WithConstant kWithConstant[] = {
    {Opcode::AddHK, [](int64_t x, int64_t k) { return x + k; }},
    {Opcode::SubHK, [](int64_t x, int64_t k) { return x - k; }},
    {Opcode::MulHK, [](int64_t x, int64_t k) { return x * k; }},
    {Opcode::AndHK, [](int64_t x, int64_t k) { return x & k; }},
    {Opcode::OrHK, [](int64_t x, int64_t k) { return x | k; }},
    {Opcode::XorHK, [](int64_t x, int64_t k) { return x ^ k; }},
    {Opcode::ShlHK, [](int64_t x, int64_t k) { return x * (int64_t{1} << (k & 31)); }},
    {Opcode::ShrHK, [](int64_t x, int64_t k) -> int64_t { return low(x) >> (k & 31); }},
    {Opcode::AshrHK, [](int64_t x, int64_t k) { return x >> (k & 31); }},
};
constexpr WithConstant kTests[] = {
    {Opcode::JmpEqHK, [](int64_t x, int64_t k) -> int64_t { return x == k; }},
    {Opcode::JmpNeHK, [](int64_t x, int64_t k) -> int64_t { return x != k; }},
    {Opcode::JmpLtHK, [](int64_t x, int64_t k) -> int64_t { return x < k; }},
    {Opcode::JmpLeHK, [](int64_t x, int64_t k) -> int64_t { return x <= k; }},
    {Opcode::JmpGtHK, [](int64_t x, int64_t k) -> int64_t { return x > k; }},
    {Opcode::JmpGeHK, [](int64_t x, int64_t k) -> int64_t { return x >= k; }},
};

// In registers, as a loop has its variables: the result in place, whether the test jumps in H750..; then the
// same in memory, as nothing else than loops has registers.
TEST_F(Native, ConstantsOfEveryShape) {
  const std::vector<int32_t> numbers = telling_numbers();
  for (const int32_t constant : numbers)
    for (const bool loop : {true, false}) {
      const int32_t count = loop ? static_cast<int32_t>(numbers.size()) : 8;
      for (size_t pair = 0; pair < std::size(kWithConstant); ++pair) {
        const WithConstant& operation = kWithConstant[pair];
        const WithConstant& test = kTests[pair % std::size(kTests)];
        code_.clear();
        add(Opcode::SetHK, {10, 500, 0, 0});
        add(Opcode::SetHK, {11, 750, 0, 0});
        const int32_t again = here();
        for (int32_t n = 0; n < (loop ? 1 : count); ++n) {
          const int32_t value = loop ? 12 : 500 + n;
          const int32_t taken = loop ? 13 : 750 + n;
          if (loop) add(Opcode::SetiLoad, {12, 10, 0, 0});
          add(Opcode::SetHK, {taken, 1, 0, 0});
          add(test.opcode, {value, constant, here() + words(test.opcode) + words(Opcode::SetHK), 0});
          add(Opcode::SetHK, {taken, 0, 0, 0});
          add(operation.opcode, {value, constant, 0, 0});
        }
        if (loop) {
          add(Opcode::SetiStore, {10, 12, 0, 0});
          add(Opcode::SetiStore, {11, 13, 0, 0});
          add(Opcode::AddHK, {10, 1, 0, 0});
          add(Opcode::AddHK, {11, 1, 0, 0});
          add(Opcode::JmpLtHK, {10, 500 + count, again, 0});
        }
        add(Opcode::End, {});
        ASSERT_EQ(run(numbers).stop, vm::Stop::Ended);
        for (size_t n = 0; n < static_cast<size_t>(count); ++n) {
          const int64_t x = numbers[n];
          ASSERT_EQ(vm::bits(h(500 + n)), low(operation.result(x, constant)))
              << vm::info(operation.opcode).name << " " << x << ", " << constant << (loop ? ", loop" : "");
          ASSERT_EQ(h(750 + n), test.result(x, constant))
              << vm::info(test.opcode).name << " " << x << ", " << constant << (loop ? ", loop" : "");
        }
      }
    }
}

// Two sums on one variable, and the tests for 0 behind them, of it and of another.
TEST_F(Native, SumsOfTwo) {
  const std::vector<int32_t> numbers = telling_numbers();
  const auto count = static_cast<int32_t>(numbers.size());
  constexpr int32_t kSum = 13, kX = 12, kOther = 14, kTaken = 15, kFirst = 5, kSecond = -5;
  for (const Opcode one : {Opcode::AddHH, Opcode::SubHH})
    for (const Opcode two : {Opcode::AddHH, Opcode::SubHH})
      for (const int32_t tested : {kSum, kX})
        for (const Opcode test : {Opcode::JmpEqHK, Opcode::JmpNeHK, Opcode::JmpLtHK, Opcode::JmpGeHK}) {
          code_.clear();
          add(Opcode::SetHK, {10, 500, 0, 0});
          const int32_t again = here();
          add(Opcode::SetiLoad, {kX, 10, 0, 0});
          add(Opcode::SetHK, {kOther, kSecond, 0, 0});
          add(Opcode::SetHK, {kTaken, 1, 0, 0});
          add(Opcode::SetHK, {kSum, kFirst, 0, 0});
          add(one, {kSum, kX, 0, 0});
          add(two, {kSum, kOther, 0, 0});
          add(test, {tested, 0, here() + words(test) + words(Opcode::SetHK), 0});
          add(Opcode::SetHK, {kTaken, 0, 0, 0});
          add(Opcode::SetHH, {kX, 10, 0, 0});
          add(Opcode::SetiStore, {10, kSum, 0, 0});
          add(Opcode::AddHK, {kX, 250, 0, 0});
          add(Opcode::SetiStore, {kX, kTaken, 0, 0});
          add(Opcode::AddHK, {10, 1, 0, 0});
          add(Opcode::JmpLtHK, {10, 500 + count, again, 0});
          add(Opcode::End, {});
          ASSERT_EQ(run(numbers).stop, vm::Stop::Ended);
          for (size_t n = 0; n < numbers.size(); ++n) {
            const int64_t x = numbers[n];
            const int64_t sum =
                kFirst + (one == Opcode::AddHH ? x : -x) + (two == Opcode::AddHH ? kSecond : -kSecond);
            ASSERT_EQ(vm::bits(h(500 + n)), low(sum)) << x;
            const int64_t y = tested == kX ? x : static_cast<int32_t>(low(sum));
            const bool taken = test == Opcode::JmpEqHK   ? y == 0
                               : test == Opcode::JmpNeHK ? y != 0
                               : test == Opcode::JmpLtHK ? y < 0
                                                         : y >= 0;
            ASSERT_EQ(h(750 + n), taken)
                << vm::info(test).name << " " << x << (tested == kX ? ", not the sum" : "");
          }
        }
}

// The longest program, of the commands with most machine code a word: H500 and H501 lead to each other.
TEST_F(Native, TheLongestProgram) {
  int32_t loads = 0;
  add(Opcode::SetHK, {10, 500, 0, 0});
  for (; here() + words(Opcode::End) < kLimits.program_words; ++loads) add(Opcode::SetiLoad, {10, 10, 0, 0});
  add(Opcode::End, {});
  EXPECT_EQ(run({501, 500}).stop, vm::Stop::Ended);
  EXPECT_EQ(h(10), 500 + loads % 2);
}

// The loop's own variables lie in the table it writes: k jumps from 12 over 13 and 14 to 99. k is H12.
TEST_F(Native, AnIndexReachesVariablesInRegisters) {
  add(Opcode::SetHK, {12, 10, 0, 0});
  const int32_t again = here();
  add(Opcode::SetHH, {200, 12, 0, 0});  // *k = k + 80
  add(Opcode::AddHK, {200, 80, 0, 0});
  add(Opcode::SetiStore, {12, 200, 0, 0});
  add(Opcode::SetiLoad, {200, 12, 0, 0});  // sum += *k
  add(Opcode::AddHH, {13, 200, 0, 0});
  add(Opcode::AddHK, {14, 1, 0, 0});  // turns++
  add(Opcode::AddHK, {12, 1, 0, 0});
  add(Opcode::JmpLtHK, {12, 99, again, 0});
  add(Opcode::End, {});
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

// In a loop whose indexes all seem to lie in a table, a store changes the variable the next index is in, as
// there are too many others for it to be in a register.
TEST_F(Native, AnIndexInMemoryIsOverwritten) {
  constexpr int32_t kCounter = 10, kValue = 11, kIndex = 150;
  add(Opcode::SetHK, {kCounter, 100, 0, 0});
  add(Opcode::SetHK, {kValue, 2000, 0, 0});
  const int32_t again = here();
  for (int32_t busy = 20; busy < 45; ++busy)
    for (int n = 0; n < 8; ++n) add(Opcode::AddHK, {busy, n, 0, 0});
  for (int n = 0; n < 8; ++n) add(Opcode::AddHH, {20, kCounter, 0, 0});
  add(Opcode::SetHH, {kIndex, kCounter, 0, 0});
  add(Opcode::AddHK, {kIndex, 50, 0, 0});
  add(Opcode::SetiStore, {kCounter, kValue, 0, 0});
  add(Opcode::SetiStore, {kIndex, kCounter, 0, 0});
  add(Opcode::AddHK, {kCounter, 1, 0, 0});
  add(Opcode::JmpLtHK, {kCounter, 160, again, 0});
  add(Opcode::End, {});
  EXPECT_EQ(run().stop, vm::Stop::Faulted);
  EXPECT_EQ(machine_->fault().number, vm::kFaultIllop);
  EXPECT_EQ(h(kCounter), kIndex);
  EXPECT_EQ(h(kIndex), 2000);
  EXPECT_EQ(h(kIndex + 49), kIndex - 1) << "the turn before";
}

// A budget ends anywhere, in any depth of calls; the machine goes on as if nothing had been.
TEST_F(Native, AnyBudgetGivesTheSameEnd) {
  constexpr int32_t kResult = 10, kI = 11, kN = 12;
  const int32_t add_n = words(Opcode::Jmp);
  const int32_t twice = add_n + words(Opcode::AddHH) + words(Opcode::Ret);
  const int32_t main = twice + 2 * words(Opcode::Call) + words(Opcode::AddHK) + words(Opcode::Ret);
  add(Opcode::Jmp, {main, 0, 0, 0});
  add(Opcode::AddHH, {kResult, kN, 0, 0});
  add(Opcode::Ret, {});
  ASSERT_EQ(here(), twice);
  add(Opcode::Call, {add_n, 0, 0, 0});
  add(Opcode::AddHK, {kN, 1, 0, 0});
  add(Opcode::Call, {add_n, 0, 0, 0});
  add(Opcode::Ret, {});
  ASSERT_EQ(here(), main);
  add(Opcode::SetHK, {kI, 0, 0, 0});
  const int32_t again = here();
  add(Opcode::SetHH, {kN, kI, 0, 0});
  add(Opcode::Call, {twice, 0, 0, 0});
  add(Opcode::JmpEqHK, {kI, 20, here() + words(Opcode::JmpEqHK) + words(Opcode::XorHH), 0});
  add(Opcode::XorHH, {kResult, kI, 0, 0});
  add(Opcode::AddHK, {kI, 1, 0, 0});
  add(Opcode::JmpLtHK, {kI, 40, again, 0});
  add(Opcode::End, {});
  const uint32_t commands = run().commands;
  const std::vector<int32_t> end(machine_->variables().begin(), machine_->variables().end());
  int32_t expected = 0;
  for (int32_t i = 0; i < 40; ++i) {
    expected += i + i + 1;
    if (i != 20) expected ^= i;
  }
  EXPECT_EQ(h(kResult), expected);
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
  const int32_t down = words(Opcode::Call) + words(Opcode::End);
  add(Opcode::Call, {down, 0, 0, 0});
  add(Opcode::End, {});
  add(Opcode::AddHK, {10, 1, 0, 0});
  add(Opcode::Call, {down, 0, 0, 0});
  add(Opcode::Ret, {});
  // No unit has a deeper one than 32.
  for (const uint8_t limit : std::initializer_list<uint8_t>{1, 2, 6, 31, 32, 33, 255}) {
    limits_.call_depth = limit;
    const int most = std::min(int{limit}, 32);
    const vm::RunResult result = run();
    EXPECT_EQ(result.stop, vm::Stop::Faulted);
    EXPECT_EQ(machine_->fault().number, vm::kFaultIndexOverflow);
    EXPECT_EQ(machine_->fault().address, static_cast<uint32_t>(down + words(Opcode::AddHK)));
    EXPECT_EQ(machine_->task(1).depth, most);
    EXPECT_EQ(h(10), most);
    EXPECT_EQ(machine_->task(1).commands, 2U * static_cast<uint32_t>(most) + 1) << "what faults counts, too";
    for (int n = 0; n < most; ++n)
      EXPECT_EQ(machine_->task(1).calls[static_cast<size_t>(n)],
                n == 0 ? words(Opcode::Call) : down + words(Opcode::AddHK) + words(Opcode::Call));
  }
}

TEST_F(Native, NoPageIsWritableAndExecutable) {
  const int32_t again = here();
  add(Opcode::AddHK, {10, 1, 0, 0});
  add(Opcode::JmpLtHK, {10, 100, again, 0});
  add(Opcode::End, {});
  run();
#ifdef _WIN32
  size_t executable = 0;
  MEMORY_BASIC_INFORMATION pages;
  for (const char* at = nullptr; VirtualQuery(at, &pages, sizeof pages) != 0;
       at = static_cast<const char*>(pages.BaseAddress) + pages.RegionSize) {
    if (pages.State != MEM_COMMIT || pages.Type != MEM_PRIVATE) continue;  // not those of programs and DLLs
    EXPECT_NE(pages.Protect, DWORD{PAGE_EXECUTE_READWRITE}) << pages.BaseAddress;
    executable += pages.Protect == PAGE_EXECUTE_READ ? 1 : 0;
  }
  EXPECT_GT(executable, 0U) << "where is the machine code?";
#else
  std::ifstream maps("/proc/self/maps");
  if (!maps) GTEST_SKIP() << "no /proc";
  for (std::string line; std::getline(maps, line);) EXPECT_EQ(line.find("rwx"), std::string::npos) << line;
#endif
}

}  // namespace
}  // namespace ipos::tests
