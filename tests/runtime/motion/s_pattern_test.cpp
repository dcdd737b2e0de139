// The S pattern against its closed form. The slope rises by d = reference / (time x N) each millisecond to
// N x d and falls alike, N = time / 8, / 4, / 2. A change by D takes D x time / reference + N - 1 ms, and as
// it is symmetric, the mean speed on the way is half of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "runtime/motion/ramp.hpp"

namespace ipos::runtime {
namespace {

constexpr int32_t kReference = 3'000'000;

RampTimes pattern(uint32_t ms, int grade) { return {ms, ms, ms, ms, static_cast<uint8_t>(grade)}; }
int rounding(uint32_t ms, int grade) { return std::max(1, static_cast<int>(ms) / (16 >> grade)); }

double mrpm(FineSpeed speed) { return static_cast<double>(speed) / static_cast<double>(kFine); }

struct Change {
  int ms = 0;
  double distance = 0;  // 1/1000 rpm x ms
};

Change change(Ramp& ramp, int32_t target, const RampTimes& times) {
  Change result;
  while (ramp.output() != fine_speed(target) && result.ms < 20'000'000) {
    const FineSpeed before = ramp.output();
    ramp.step(fine_speed(target), times);
    result.distance += (mrpm(before) + mrpm(ramp.output())) / 2;
    ++result.ms;
  }
  return result;
}

TEST(SPattern, SpeedAfterEachMillisecond) {
  for (const int grade : {1, 2, 3}) {
    const int ms = 2'000;
    const int levels = rounding(ms, grade);
    const double step = double{kReference} / (ms * levels);
    const int flat = static_cast<int>(1'500'000 / (step * levels)) - levels;  // whole for these figures
    Ramp ramp(kReference);
    double want = 0;
    for (int n = 1; n <= 2 * levels - 1 + flat; ++n) {
      const int level = std::min({n, levels, 2 * levels + flat - n});
      want += level * step;
      ramp.step(fine_speed(1'500'000), pattern(ms, grade));
      ASSERT_NEAR(mrpm(ramp.output()), want, 0.01) << grade << " " << n;
    }
    EXPECT_EQ(whole_speed(ramp.output()), 1'500'000);
  }
}

// The same to the last of the 32 places: the levels gone through are an exact share of the reference.
TEST(SPattern, StepsAreExactToTheLastPlace) {
  __extension__ using Wide = __int128;
  for (const int grade : {1, 2, 3})
    for (const uint32_t ms : {8U, 30U, 96U, 333U, 1'000U, 2'009U}) {
      const int levels = rounding(ms, grade);
      Ramp ramp(kReference);
      Wide gone = 0;
      for (int n = 1; n <= 2'000 && ramp.output() < kTopFine / 2; ++n) {
        gone += std::min(n, levels);
        ramp.step(kTopFine, pattern(ms, grade));
        const Wide want = Wide{kReference} * kFine * gone / (int64_t{ms} * levels);
        ASSERT_EQ(ramp.output(), static_cast<FineSpeed>(want)) << grade << ", " << ms << " ms, step " << n;
      }
    }
}

TEST(SPattern, DurationAndDistance) {
  for (const int grade : {1, 2, 3})
    for (const uint32_t ms : {8U, 100U, 333U, 1'000U, 2'000U, 9'999U, 100'000U, 2'000'000U})
      for (const int32_t from : {0, -1'500'000})
        for (const int32_t to : {1'500'000, 2'999'999}) {
          Ramp ramp(kReference);
          ramp.set(fine_speed(from));
          const Change result = change(ramp, to, pattern(ms, grade));
          const double size = static_cast<double>(to) - static_cast<double>(from);
          const double levels = std::min(rounding(ms, grade), 16'000);
          const double want = size * ms / kReference + levels - 1;
          EXPECT_GE(result.ms, want - 0.01) << grade << " " << ms;
          EXPECT_LE(result.ms, want + 2)
              << grade << " " << ms;  // what does not divide is driven at low slope
          const double half = (static_cast<double>(from) + static_cast<double>(to)) / 2 * result.ms;
          EXPECT_NEAR(result.distance, half, size * 2) << grade << " " << ms;
        }
}

// Below N x N x d the full slope is not reached: up and down in equal parts, 2 x sqrt(D / d) ms.
TEST(SPattern, SmallChange) {
  for (const int grade : {1, 2, 3})
    for (const int32_t size : {1'000, 10'000, 33'333}) {
      const int ms = 2'000;
      const double step = double{kReference} / (ms * rounding(ms, grade));
      Ramp ramp(kReference);
      EXPECT_NEAR(change(ramp, size, pattern(ms, grade)).ms, 2 * std::sqrt(size / step), 2.5) << grade;
    }
}

TEST(SPattern, SlopeIsBuiltUpAndDownEvenly) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 300; ++round) {
    const uint32_t ms = 8 + static_cast<uint32_t>(random() % 3'000);
    const int grade = 1 + static_cast<int>(random() % 3);
    const double step = double{kReference} / (static_cast<double>(ms) * rounding(ms, grade));
    Ramp ramp(kReference);
    double slope = 0;
    for (int leg = 0; leg < 5; ++leg) {
      const int32_t target = static_cast<int32_t>(random() % 6'000'001) - 3'000'000;
      const int patience = leg < 4 ? static_cast<int>(random() % 2'000) : 20'000;
      for (int n = 0; n < patience && (ramp.output() != fine_speed(target) || slope != 0); ++n) {
        const FineSpeed before = ramp.output();
        ramp.step(fine_speed(target), pattern(ms, grade));
        const double now = mrpm(ramp.output() - before);
        ASSERT_LE(std::abs(now - slope), step * 1.001 + 0.001) << round << " " << leg;
        ASSERT_LE(std::abs(now), double{kReference} / ms + 0.001);
        slope = now;
      }
      if (leg == 4) {
        ASSERT_EQ(ramp.output(), fine_speed(target)) << round;
      }
    }
  }
}

TEST(SPattern, TargetTakenBackIsPassedOnce) {
  Ramp ramp(kReference);
  const RampTimes times = pattern(2'000, 3);
  for (int n = 0; n < 700; ++n) ramp.step(fine_speed(3'000'000), times);
  const FineSpeed seen = ramp.output();  // the slope is at 0.7 of its greatest
  FineSpeed greatest = seen, before = seen;
  bool falling = false;
  for (int n = 0; n < 5'000; ++n) {
    ramp.step(seen, times);
    greatest = std::max(greatest, ramp.output());
    if (ramp.output() < before) falling = true;
    ASSERT_FALSE(falling && ramp.output() > before) << n;
    before = ramp.output();
  }
  // 699 + 698 + .. + 1 steps of 1.5 until the slope is built down.
  EXPECT_NEAR(mrpm(greatest - seen), 1.5 * 699 * 700 / 2, 1);
  EXPECT_EQ(ramp.output(), seen);
}

TEST(SPattern, LinearRampInterruptsItAtOnce) {
  Ramp ramp(kReference);
  for (int n = 0; n < 500; ++n) ramp.step(fine_speed(3'000'000), pattern(2'000, 2));
  const double before = mrpm(ramp.output());
  ramp.step(0, {300, 300, 300, 300, 0});
  EXPECT_NEAR(mrpm(ramp.output()), before - 10'000, 0.01);
}

TEST(SPattern, AnotherTimeGoesOnWithTheSlope) {
  Ramp ramp(kReference);
  for (int n = 0; n < 600; ++n)
    ramp.step(fine_speed(3'000'000), pattern(2'000, 2));  // full slope, 1.5 rpm/ms
  FineSpeed before = ramp.output();
  ramp.step(fine_speed(3'000'000), pattern(1'000, 2));  // steeper is allowed: slope grows by 3000 / 250
  EXPECT_NEAR(mrpm(ramp.output() - before), 1'500 + 12, 0.01);
  before = ramp.output();
  ramp.step(fine_speed(3'000'000), pattern(4'000, 2));  // flatter: at once
  EXPECT_NEAR(mrpm(ramp.output() - before), 750, 0.01);
}

TEST(SPattern, TimeZeroJumps) {
  Ramp ramp(kReference);
  ramp.step(fine_speed(-750'000), pattern(0, 3));
  EXPECT_EQ(whole_speed(ramp.output()), -750'000);
}

}  // namespace
}  // namespace ipos::runtime
