// Generated programs against both oracles. The expected values come from the reference evaluator and from
// gcc.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/generated/campaign.hpp"
#include "tests/generated/evaluator.hpp"
#include "tests/generated/gcc_oracle.hpp"
#include "tests/generated/program_generator.hpp"
#include "tests/generated/source_text.hpp"

namespace ipos::tests {
namespace {

void expect_none(Oracle oracle, const Campaign& campaign) {
  std::printf("%s\n", summary(campaign).c_str());
  EXPECT_EQ(campaign.trouble, "");
  EXPECT_TRUE(campaign.differences.empty()) << first_difference(oracle, campaign);
}

TEST(Generated, AgreesWithTheReferenceEvaluator) {
  const Campaign campaign = run_campaign(Oracle::Tree, 1, 3000);
  expect_none(Oracle::Tree, campaign);
  EXPECT_EQ(campaign.programs, 3000U);
  EXPECT_GT(campaign.faults, 100U) << "unguarded programs have to reach F10";
}

TEST(Generated, AgreesWithGcc) {
  if (!gcc_present()) GTEST_SKIP() << "there is no gcc to compile the programs as C";
  const Campaign campaign = run_campaign(Oracle::Gcc, 1'000'001, 400);
  expect_none(Oracle::Gcc, campaign);
  EXPECT_EQ(campaign.programs, 400U);
}

// The oracle itself: C's rules on corner values, worked out by hand.
TEST(Evaluator, Arithmetic) {
  constexpr int32_t kMin = INT32_MIN, kMax = INT32_MAX;
  const auto value = [](Op op, int32_t a, int32_t b) { return apply(op, a, b).value; };
  EXPECT_EQ(value(Op::Add, kMax, 1), kMin);
  EXPECT_EQ(value(Op::Sub, kMin, 1), kMax);
  EXPECT_EQ(value(Op::Mul, 65536, 65536), 0);
  EXPECT_EQ(value(Op::Mul, kMin, -1), kMin);
  EXPECT_EQ(value(Op::Div, kMin, -1), kMin);
  EXPECT_EQ(value(Op::Mod, kMin, -1), 0);
  EXPECT_EQ(value(Op::Div, -7, 2), -3);
  EXPECT_EQ(value(Op::Mod, -7, 2), -1);
  EXPECT_EQ(value(Op::Shl, 1, 33), 2);
  EXPECT_EQ(value(Op::Shl, 1, 31), kMin);
  EXPECT_EQ(value(Op::Shr, -5, 1), -3);
  EXPECT_EQ(value(Op::Shr, kMin, -1), -1);
  EXPECT_TRUE(apply(Op::Div, 1, 0).fault);
  EXPECT_TRUE(apply(Op::Mod, 0, 0).fault);
}

// Same seed, same text: a difference can be reported by its seed.
TEST(Generator, IsDeterministic) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    Program a = generate_program(seed), b = generate_program(seed);
    EXPECT_EQ(source_text(a), source_text(b));
  }
}

}  // namespace
}  // namespace ipos::tests
