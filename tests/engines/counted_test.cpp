// Loops along tables whose indexes need no look (vm/jit/counted.hpp): which are found, and what must hold at their
// beginning. That all indexes are good then is tried by counting: each loop is executed by hand. Labels are numbers of
// commands.
#include "vm/jit/counted.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/engines/pair.hpp"
#include "tests/vm/code.hpp"

namespace ipos::tests {
namespace {

using vm::Instruction;
using vm::Opcode;
using vm::jit::CountedLoop;
using Lines = std::vector<Instruction>;

constexpr vm::Limits kCountedLimits{256, 2048, 3, 6};
constexpr int32_t kFar = 1 << 20;  // steps and constants are at most so far

// The loop that begins at command `first`.
std::optional<CountedLoop> found(const Lines& commands, uint32_t first = 1) {
  const std::vector<uint32_t> code = assembled(commands);
  const auto image = vm::verify(code, kCountedLimits, {}).image;
  EXPECT_TRUE(image);
  return vm::jit::counted_loop(vm::jit::Program(*image), first);
}

Instruction store(int32_t index, int32_t value) { return I(Opcode::SetiStore, index, value); }
Instruction load(int32_t to, int32_t index) { return I(Opcode::SetiLoad, to, index); }
Instruction add(int32_t to, int32_t k) { return I(Opcode::AddHK, to, k); }
Instruction copy(int32_t to, int32_t from) { return I(Opcode::SetHH, to, from); }
const Instruction kNothing = I(Opcode::Nop), kTheEnd = I(Opcode::End);

// A command in front, these in the loop, step and test, the end. The counter is k.
Lines loop_of(const Lines& body, const Instruction& step, Instruction test) {
  Lines out{kNothing};
  out.insert(out.end(), body.begin(), body.end());
  out.push_back(step);
  test.operands[2] = 1;
  out.push_back(test);
  out.push_back(kTheEnd);
  return out;
}

std::set<int32_t> fixed_of(const CountedLoop& loop) { return {loop.fixed.begin(), loop.fixed.end()}; }

// For counters that have the numbers which stand for "nothing" elsewhere, too.
constexpr int32_t kCounters[] = {0, 1, 2, 200, 255};
constexpr int32_t kT = 20, kV = 21, kS = 22, kN = 23, kOther = 24;

TEST(Counted, LoopsAreWhatStepsAVariableUpToALimit) {
  for (const int32_t k : kCounters) {
    struct Row {
      Instruction step, test;
      bool counted;
    };
    const Instruction up = add(k, 1), below = I(Opcode::JmpLtHK, k, 100);
    for (const Row& row : {Row{up, below, true},
                           {add(k, 7), below, true},
                           {add(k, kFar), below, true},
                           {up, I(Opcode::JmpLeHK, k, 100), true},
                           {up, I(Opcode::JmpLtHH, k, kN), true},
                           {up, I(Opcode::JmpLeHH, k, kN), true},
                           {I(Opcode::AddHH, k, kS), below, true},
                           {I(Opcode::AddHH, k, kS), I(Opcode::JmpLtHH, k, kN), true},
                           {I(Opcode::AddHH, k, kS), I(Opcode::JmpLeHH, k, kN), true},
                           {I(Opcode::AddHH, k, kS), I(Opcode::JmpLeHH, k, kS), true},
                           {add(k, 0), below, false},
                           {add(k, -1), below, false},
                           {add(kOther, 1), below, false},
                           {I(Opcode::SubHK, k, -1), below, false},
                           {I(Opcode::SubHH, k, kS), below, false},
                           {I(Opcode::AddHH, kOther, kS), below, false},
                           {I(Opcode::AddHH, k, k), below, false},
                           {I(Opcode::MulHK, k, 2), below, false},
                           {up, I(Opcode::JmpNeHK, k, 100), false},
                           {up, I(Opcode::JmpEqHK, k, 100), false},
                           {up, I(Opcode::JmpGtHK, k, 100), false},
                           {up, I(Opcode::JmpGeHK, k, 100), false},
                           {up, I(Opcode::JmpNeHH, k, kN), false},
                           {up, I(Opcode::JmpGtHH, k, kN), false},
                           {up, I(Opcode::JmpGeHH, k, kN), false},
                           {up, I(Opcode::JmpLeHH, k, k), false},
                           {up, I(Opcode::JmpLtHK, kOther, 100), false},
                           {up, I(Opcode::JmpLtHH, kOther, k), false}}) {
      const Lines commands = loop_of({store(k, kV)}, row.step, row.test);
      const auto loop = found(commands);
      ASSERT_EQ(loop.has_value(), row.counted)
          << vm::info(row.step.opcode).text << ", " << vm::info(row.test.opcode).text << ", H" << k;
      if (!loop) continue;
      EXPECT_EQ(loop->first, 1U);
      EXPECT_EQ(loop->last, 3U);
      EXPECT_EQ(loop->counter, k);
      EXPECT_EQ(loop->access, 1U);
      EXPECT_EQ(loop->lowest, 0);
      EXPECT_EQ(loop->highest, 0);
      EXPECT_EQ(loop->step, row.step);
      EXPECT_EQ(loop->test.opcode, row.test.opcode);
      // All that it depends on has to be looked at.
      std::set<int32_t> fixed{k};
      if (row.step.opcode == Opcode::AddHH) fixed.insert(kS);
      if (row.test.opcode == Opcode::JmpLtHH || row.test.opcode == Opcode::JmpLeHH)
        fixed.insert(row.test.operands[1]);
      EXPECT_EQ(fixed_of(*loop), fixed);
    }
  }
}

// What stands in the loop: nothing else changes the counter, the step or the limit, and each index is the counter and a
// constant.
TEST(Counted, IndexesAreTheCounterAndAConstant) {
  for (const int32_t k : kCounters) {
    struct Row {
      const char* what;
      Lines body;
      int32_t lowest = 0, highest = 0;
      bool counted = true;
      std::set<int32_t> fixed{};  // further ones
    };
    const Row rows[] = {
        {"load", {load(kV, k)}},
        {"load and store", {load(kV, k), store(k, kV)}},
        {"a constant", {copy(kT, k), add(kT, 40), store(kT, kV)}, 40, 40, true, {kT}},
        {"for a load", {copy(kT, k), add(kT, 40), load(kT, kT)}, 40, 40, true, {kT}},
        {"taken away", {copy(kT, k), I(Opcode::SubHK, kT, 3), load(kV, kT)}, -3, -3, true, {kT}},
        {"added up",
         {copy(kT, k), add(kT, 40), I(Opcode::SubHK, kT, 3), add(kT, 1), load(kV, kT)},
         38,
         38,
         true,
         {kT}},
        {"the far end", {copy(kT, k), add(kT, kFar), store(kT, kV)}, kFar, kFar, true, {kT}},
        {"the near end", {copy(kT, k), add(kT, -kFar), store(kT, kV)}, -kFar, -kFar, true, {kT}},
        {"behind the far end", {copy(kT, k), add(kT, kFar + 1), store(kT, kV)}, 0, 0, false},
        {"behind the near end", {copy(kT, k), add(kT, -kFar - 1), store(kT, kV)}, 0, 0, false},
        {"far, and back",
         {copy(kT, k), add(kT, INT32_MAX), add(kT, INT32_MAX), I(Opcode::SubHK, kT, INT32_MAX),
          I(Opcode::SubHK, kT, INT32_MAX), store(kT, kV)},
         0,
         0,
         true,
         {kT}},
        {"through another",
         {copy(kT, k), add(kT, 4), copy(kOther, kT), add(kOther, 1), store(kOther, kV)},
         5,
         5,
         true,
         {kOther, kT}},
        {"of several the ends count",
         {load(kV, k), copy(kT, k), add(kT, 9), load(kV, kT), copy(kOther, k), add(kOther, -2),
          store(kOther, kV)},
         -2,
         9,
         true,
         {kT, kOther}},
        {"the lowest first", {copy(kT, k), add(kT, -4), load(kV, kT), store(k, kV)}, -4, 0, true, {kT}},
        {"something else, too", {add(kOther, 5), store(k, kOther), I(Opcode::MulHH, kV, k), kNothing}},
        {"no access", {add(kOther, 5)}, 0, 0, false},
        {"no body", {}, 0, 0, false},
        {"the temporary begins outside", {add(kT, 40), store(kT, kV)}, 0, 0, false},
        {"another variable", {store(kOther, kV)}, 0, 0, false},
        {"a copy of another", {copy(kT, kOther), store(kT, kV)}, 0, 0, false},
        {"multiplied", {copy(kT, k), I(Opcode::MulHK, kT, 2), store(kT, kV)}, 0, 0, false},
        {"set to a constant", {I(Opcode::SetHK, kT, 40), store(kT, kV)}, 0, 0, false},
        {"a variable is added", {copy(kT, k), I(Opcode::AddHH, kT, kV), store(kT, kV)}, 0, 0, false},
        {"loaded from the table", {load(kT, k), store(kT, kV)}, 0, 0, false},
        {"a bit of it", {copy(kT, k), I(Opcode::BitSet, kT, 3), store(kT, kV)}, 0, 0, false},
        {"the second is no such index", {load(kV, k), store(kOther, kV)}, 0, 0, false},
        {"the counter changes", {store(k, kV), I(Opcode::SetHK, k, 1)}, 0, 0, false},
        {"the counter is loaded", {load(k, k)}, 0, 0, false},
        {"the counter is stepped twice", {store(k, kV), add(k, 1)}, 0, 0, false},
        {"a division", {store(k, kV), I(Opcode::DivHH, kOther, kV)}},
        {"a system command", {store(k, kV), I(Opcode::WaitK, 1)}, 0, 0, false},
        {"a block", {store(k, kV), I(Opcode::Copy, kOther, kV, 2)}, 0, 0, false},
        {"a block of one", {store(k, kV), I(Opcode::Copy, kOther, kV, 1)}},
        {"a division by 0", {store(k, kV), I(Opcode::DivHK, kOther, 0)}, 0, 0, false},
    };
    for (const Row& row : rows) {
      const auto loop = found(loop_of(row.body, add(k, 1), I(Opcode::JmpLtHK, k, 100)));
      ASSERT_EQ(loop.has_value(), row.counted) << row.what << ", H" << k;
      if (!loop) continue;
      EXPECT_EQ(loop->lowest, row.lowest) << row.what;
      EXPECT_EQ(loop->highest, row.highest) << row.what;
      std::set<int32_t> fixed = row.fixed;
      fixed.insert(k);
      EXPECT_EQ(fixed_of(*loop), fixed) << row.what;
      const auto is_access = [](const Instruction& command) {
        return command.opcode == Opcode::SetiLoad || command.opcode == Opcode::SetiStore;
      };
      const auto access = std::find_if(row.body.begin(), row.body.end(), is_access) - row.body.begin();
      EXPECT_EQ(loop->access, static_cast<uint32_t>(access + 1)) << row.what;
    }
  }
}

// Step and limit stay as they are.
TEST(Counted, StepAndLimitAreNotChangedInTheLoop) {
  constexpr int32_t k = 2;
  const Instruction step = I(Opcode::AddHH, k, kS), test = I(Opcode::JmpLtHH, k, kN);
  EXPECT_TRUE(found(loop_of({store(k, kV)}, step, test)));
  for (const int32_t changed : {k, kS, kN})
    for (const Instruction& change :
         {add(changed, 1), load(changed, k), copy(changed, kV), I(Opcode::NotH, changed, kV),
          I(Opcode::SetHK, changed, 3), I(Opcode::BitClear, changed, 3), I(Opcode::MulHH, changed, kV)}) {
      EXPECT_FALSE(found(loop_of({store(k, kV), change}, step, test))) << changed;
      EXPECT_FALSE(found(loop_of({change, store(k, kV)}, step, test))) << changed;
    }
  for (const int32_t read : {k, kS, kN})
    EXPECT_TRUE(found(loop_of({store(k, read), copy(kV, read)}, step, test)));
}

// One line of commands that leads back to its first; nobody comes into the middle of it.
TEST(Counted, LoopsAreOneLine) {
  constexpr int32_t k = 2;
  const Instruction body = store(k, kV), step = add(k, 1), test = I(Opcode::JmpLtHK, k, 100, 1);
  EXPECT_TRUE(found({kNothing, body, step, test, kTheEnd}));
  EXPECT_TRUE(found({body, step, I(Opcode::JmpLtHK, k, 100, 0), kTheEnd}, 0)) << "the first command";
  EXPECT_FALSE(found({kNothing, body, step, test, kTheEnd}, 0)) << "in front of it";
  EXPECT_FALSE(found({kNothing, body, step, test, kTheEnd}, 2)) << "in the middle";
  EXPECT_FALSE(found({kNothing, body, step, test, kTheEnd}, 3)) << "its end";
  EXPECT_FALSE(found({kNothing, body, step, test, kTheEnd}, 4)) << "behind it";
  EXPECT_TRUE(found({I(Opcode::JmpEqHK, 9, 9, 1), body, step, test, kTheEnd})) << "a jump to its beginning";
  EXPECT_FALSE(found({I(Opcode::JmpEqHK, 9, 9, 2), body, step, test, kTheEnd})) << "a jump to its step";
  EXPECT_FALSE(found({I(Opcode::JmpEqHK, 9, 9, 3), body, step, test, kTheEnd})) << "a jump to its test";
  EXPECT_TRUE(found({I(Opcode::JmpEqHK, 9, 9, 4), body, step, test, kTheEnd})) << "a jump behind it";
  EXPECT_FALSE(found({I(Opcode::Task2, 1, 2), body, step, test, kTheEnd})) << "a task begins in it";
  EXPECT_FALSE(found({kNothing, body, I(Opcode::JmpEqHK, 9, 9, 5), step, test, kTheEnd})) << "a way out";
  EXPECT_FALSE(found({kNothing, body, step, I(Opcode::JmpLtHK, k, 100, 2), test, kTheEnd})) << "a loop in it";
  EXPECT_FALSE(found({kNothing, body, step, I(Opcode::JmpLtHK, k, 100, 4), kTheEnd})) << "it leads on";
  EXPECT_FALSE(found({kNothing, body, step, I(Opcode::JmpLtHK, k, 100, 0), kTheEnd}))
      << "it leads farther back";
  EXPECT_FALSE(found({I(Opcode::Call, 1), body, step, test, kTheEnd})) << "a subroutine begins here";
  EXPECT_FALSE(found({kNothing, step, test, kTheEnd})) << "no body";
}

// Whether a jump of these is taken.
bool doubted(const std::vector<Instruction>& doubts, int32_t counter, int32_t k, int32_t limit, int32_t by) {
  const auto value = [&](int32_t variable) { return variable == counter ? k : variable == kN ? limit : by; };
  return std::any_of(doubts.begin(), doubts.end(), [&](const Instruction& jump) {
    const int32_t x = value(jump.operands[0]), y = jump.operands[1];
    switch (jump.opcode) {
      case Opcode::JmpLtHK: return x < y;
      case Opcode::JmpLeHK: return x <= y;
      case Opcode::JmpGtHK: return x > y;
      case Opcode::JmpGeHK: return x >= y;
      default: ADD_FAILURE() << "no test of a constant"; return true;
    }
  });
}

// Loops over a table of 50 from 100 on, with two indexes: counted by hand they stay in it exactly when nothing is
// doubted, for values around the ends; a step of more than 2^20 or below 1 is always doubted.
TEST(Counted, WithoutADoubtAllIndexesAreInTheTable) {
  constexpr int32_t k = 2, kIn = 100, kCount = 50;
  size_t sure = 0, unsure = 0;
  for (const int32_t low : {-2, 0, 90})
    for (const int32_t wide : {0, 3})
      for (const Opcode test : {Opcode::JmpLtHK, Opcode::JmpLeHK, Opcode::JmpLtHH, Opcode::JmpLeHH})
        for (const bool by_variable : {false, true})
          for (const int32_t by : {1, 2, 7, 60, kFar, kFar + 1}) {
            const bool by_limit = test == Opcode::JmpLtHH || test == Opcode::JmpLeHH;
            const bool below = test == Opcode::JmpLtHK || test == Opcode::JmpLtHH;
            const int32_t first = kIn - low, end = kIn + kCount - low - wide;  // what the counter may be
            for (int32_t limit = end - 3; limit <= end + 3; ++limit) {
              const auto loop = found(loop_of(
                  {copy(kT, k), add(kT, low), load(kV, kT), add(kT, wide), store(kT, kV)},
                  by_variable ? I(Opcode::AddHH, k, kS) : add(k, by), I(test, k, by_limit ? kN : limit)));
              ASSERT_TRUE(loop);
              ASSERT_EQ(loop->lowest, low);
              ASSERT_EQ(loop->highest, low + wide);
              const auto doubts = loop->doubts(kIn, kCount);
              const bool good_limit = below ? limit <= end : limit < end;
              const bool good_step = by <= kFar;
              if (!by_limit && !good_limit) {
                EXPECT_FALSE(doubts) << "it can be seen already";
                continue;
              }
              if (!by_variable && !good_step) {
                EXPECT_FALSE(doubts) << "it can be seen already";
                continue;
              }
              ASSERT_TRUE(doubts);
              for (const int32_t begin : {first - 1, first, first + 1, end - 2, end - 1, end, end + 1}) {
                const bool doubt = doubted(*doubts, k, begin, limit, by);
                // By hand: each value the counter takes, until the test does not jump.
                bool inside = true;
                for (int64_t i = begin;;) {
                  inside = inside && i >= first && i < end;
                  i += by;
                  if (below ? i >= limit : i > limit) break;
                }
                if (!doubt) {
                  EXPECT_TRUE(inside) << begin << " to " << limit << " by " << by;
                }
                // Nothing is doubted without need.
                EXPECT_EQ(doubt, !(begin >= first && begin < end && good_limit && good_step))
                    << begin << " to " << limit << " by " << by;
                ++(doubt ? unsure : sure);
              }
            }
            if (!by_variable) continue;
            const auto loop =
                found(loop_of({store(k, kV)}, I(Opcode::AddHH, k, kS), I(test, k, by_limit ? kN : 120)));
            for (const int32_t step : {INT32_MIN, -1, 0})
              EXPECT_TRUE(doubted(loop->doubts(kIn, kCount).value(), k, 110, 120, step)) << step;
          }
  EXPECT_GT(sure, 500U);
  EXPECT_GT(unsure, 500U);
}

}  // namespace
}  // namespace ipos::tests
