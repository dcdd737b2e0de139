// Linear ramps against the closed form: speed after n ms = start + n x reference / time, cut at the target.
#include "runtime/motion/ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/motion/axis.hpp"

namespace ipos::runtime {
namespace {

constexpr int32_t kMovidrive = 3'000'000;  // ramp times of MOVIDRIVE mean 3000 rpm
constexpr int32_t kMovitrac = 1'500'000;   // of MOVITRAC 07 50 Hz

RampTimes all(uint32_t ms) { return {ms, ms, ms, ms, 0}; }

// The ramp as a function of continuous time, in long double.
struct ClosedForm {
  long double reference;
  RampTimes times;
  // Speed `ms` after `start` on the way to `target`.
  long double at(long double start, long double target, long double ms) const {
    if (start == target || ms <= 0) return start;
    const bool reversal = start * target < 0;
    const bool cw = start > 0 || (start == 0 && target > 0);
    const long double goal = reversal ? 0 : target;
    const bool up = std::abs(goal) > std::abs(start);
    const uint32_t time =
        cw ? (up ? times.up_cw_ms : times.down_cw_ms) : (up ? times.up_ccw_ms : times.down_ccw_ms);
    const long double needed = std::abs(goal - start) * time / reference;
    if (ms <= needed) return start + (goal > start ? 1 : -1) * ms * reference / time;
    return at(goal, target, ms - needed);
  }
};

void follows(Ramp& ramp, int32_t target, const RampTimes& times, int ms, int32_t reference = kMovidrive) {
  const ClosedForm form{static_cast<long double>(reference), times};
  const long double start = static_cast<long double>(ramp.output()) / kFine;
  for (int n = 1; n <= ms; ++n) {
    ramp.step(fine_speed(target), times);
    ASSERT_NEAR(static_cast<double>(whole_speed(ramp.output())),
                static_cast<double>(form.at(start, target, n)), 1.0)
        << "after " << n << " ms to " << target << " with " << times.up_cw_ms;
  }
}

// First millisecond at which the ramp has arrived.
int arrival(Ramp& ramp, int32_t target, const RampTimes& times) {
  for (int n = 1; n <= 10'000'000; ++n) {
    ramp.step(fine_speed(target), times);
    if (ramp.output() == fine_speed(target)) return n;
  }
  return -1;
}

TEST(LinearRamp, EveryMillisecondOfManyTimes) {
  for (const uint32_t ms : {1U, 2U, 3U, 7U, 10U, 99U, 100U, 333U, 997U, 1'000U, 2'000U, 2'009U, 10'000U}) {
    Ramp ramp(kMovidrive);
    follows(ramp, 1'500'000, all(ms), static_cast<int>(ms / 2) + 5);
    follows(ramp, -1'499'999, all(ms), static_cast<int>(ms) + 5);
    follows(ramp, 0, all(ms), static_cast<int>(ms / 2) + 5);
    follows(ramp, 5'500'000, all(ms), static_cast<int>(2 * ms) + 5);
  }
}

TEST(LinearRamp, ArrivesInExactlyItsTime) {
  // 1500 rpm is half of the MOVIDRIVE reference and all of the MOVITRAC 07 one.
  for (const uint32_t ms : {1U, 7U, 300U, 501U, 2'000U, 65'535U, 2'000'000U}) {
    Ramp movidrive(kMovidrive), movitrac(kMovitrac);
    EXPECT_EQ(arrival(movidrive, 1'500'000, all(ms)), static_cast<int>((ms + 1) / 2)) << ms;
    EXPECT_EQ(arrival(movitrac, 1'500'000, all(ms)), static_cast<int>(ms)) << ms;
    EXPECT_EQ(arrival(movitrac, 0, all(ms)), static_cast<int>(ms)) << ms;
  }
}

TEST(LinearRamp, ProcessRampOf25HzTakesHalfItsTime) {
  Ramp ramp(kMovitrac);  // M07-PD-10: ramp 1000, 25 Hz = 750 rpm
  EXPECT_EQ(arrival(ramp, 750'000, all(1'000)), 500);
}

TEST(LinearRamp, ReversalUsesBothRamps) {
  const RampTimes times{700, 301, 457, 999, 0};
  Ramp ramp(kMovidrive);
  follows(ramp, 1'500'000, times, 400);
  follows(ramp, -2'000'000, times, 700);
  follows(ramp, -500'000, times, 600);
  follows(ramp, 1'000'000, times, 700);
}

TEST(LinearRamp, ReversalWithinOneMillisecond) {
  // 3 ms down from 1500 rpm: zero after 1.5 ms, then the slow or the fast other side.
  for (const uint32_t up : {1U, 2U, 5U, 2'000U, 2'000'000U})
    for (const uint32_t down : {1U, 3U, 7U, 1'999'999U}) {
      Ramp ramp(kMovidrive);
      ramp.set(fine_speed(1'500));
      follows(ramp, -3'000'000, {1, down, up, 1, 0}, 50);
    }
}

TEST(LinearRamp, TargetAndTimeChangeOnTheWay) {
  std::mt19937_64 random(1);
  Ramp ramp(kMovidrive);
  for (int change = 0; change < 3'000; ++change) {
    const auto time = [&] { return static_cast<uint32_t>(1 + random() % 3'000); };
    const int32_t target = static_cast<int32_t>(random() % 12'000'001) - 6'000'000;
    follows(ramp, target, {time(), time(), time(), time(), 0}, static_cast<int>(1 + random() % 60));
    if (HasFatalFailure()) return;
  }
}

// From a change of the time on the ramp is what it would be had it begun there: what the old slope has not divided
// yet is not the new one's.
TEST(LinearRamp, AnotherTimeBeginsWithoutARest) {
  for (const uint32_t first : {7U, 333U, 997U, 1'777U, 1'999'999U})
    for (const uint32_t second : {3U, 11U, 701U, 2'009U, 1'999'993U})
      for (const int before : {1, 2, 5, 40}) {
        Ramp ramp(kMovidrive), fresh(kMovidrive);
        for (int n = 0; n < before; ++n) ramp.step(fine_speed(5'500'000), all(first));
        fresh.set(ramp.output());
        for (int n = 1; n <= 3'000; ++n) {
          ramp.step(fine_speed(5'500'000), all(second));
          fresh.step(fine_speed(5'500'000), all(second));
          ASSERT_EQ(ramp.output(), fresh.output()) << first << " then " << second << ", after " << n << " ms";
        }
      }
}

// After n steps of reference / time the speed is the whole part of n times that, to the last of its 32 places: also in
// the step in which nothing is left undivided.
TEST(LinearRamp, StepsAreExactToTheLastPlace) {
  __extension__ using Wide = __int128;
  for (const int32_t reference : {kMovidrive, kMovitrac, 1})
    for (const uint32_t ms : {3U, 7U, 48U, 333U, 1'000U, 1'777U, 2'009U, 1'999'999U}) {
      Ramp ramp(reference);
      for (int n = 1; n <= 3'000; ++n) {
        const auto want = static_cast<FineSpeed>(Wide{reference} * kFine * n / ms);
        if (want > kTopFine / 2) break;
        ramp.step(kTopFine, all(ms));
        ASSERT_EQ(ramp.output(), want) << reference << " in " << ms << " ms, step " << n;
      }
    }
}

TEST(LinearRamp, NoDriftOn2000Seconds) {
  Ramp ramp(kMovidrive);
  const RampTimes times = all(1'999'999);
  for (int n = 1; n <= 1'999'998; ++n) {
    ramp.step(fine_speed(3'000'000), times);
    if (n % 100'000 == 0) {
      ASSERT_EQ(whole_speed(ramp.output()), std::llround(3e6L * n / 1'999'999)) << n;
    }
  }
  EXPECT_LT(ramp.output(), fine_speed(3'000'000));
  ramp.step(fine_speed(3'000'000), times);
  EXPECT_EQ(ramp.output(), fine_speed(3'000'000));
}

TEST(LinearRamp, TimeZeroJumps) {
  Ramp ramp(kMovidrive);
  ramp.step(fine_speed(INT32_MAX), {});
  EXPECT_EQ(whole_speed(ramp.output()), kTopSpeed);
  ramp.step(fine_speed(-1'000), {5, 0, 0, 0, 0});
  EXPECT_EQ(whole_speed(ramp.output()), -1'000);
  ramp.step(fine_speed(600'000), {5, 0, 0, 0, 0});  // zero at once, then 600 rpm a millisecond
  EXPECT_EQ(whole_speed(ramp.output()), 600'000);
}

TEST(LinearRamp, SmallestChange) {
  Ramp ramp(kMovidrive);
  EXPECT_EQ(arrival(ramp, 1, all(2'000'000)), 1);
  EXPECT_EQ(arrival(ramp, -1, all(2'000'000)), 2);  // 1.5 / 1000 rpm a millisecond
}

// The axis with factory times: the ramp test of a drive that carries its load.
struct Loaded {
  Axis axis{{}};
  AxisOrder order;
  explicit Loaded(uint32_t ms) {
    order.command = AxisCommand::Run;
    order.target = 1'500'000;
    order.ramp = all(ms);
    order.stop_ramp_ms = ms;
  }
  int until_standing() {
    for (int n = 1; n <= 100'000; ++n)
      if (axis.tick(order).standing) return n;
    return -1;
  }
};

TEST(AxisRamp, From0To1500ReversalStopRapidStop) {
  for (const uint32_t t11 : {2'000U, 1'000U, 501U, 1'777U}) {
    Loaded run(t11);
    const ClosedForm form{kMovidrive, all(t11)};
    const auto matches = [&](long double from, long double to, int ms) {
      for (int n = 1; n <= ms; ++n) {
        const AxisState& state = run.axis.tick(run.order);
        const double want = static_cast<double>(form.at(from, to, n));
        ASSERT_NEAR(static_cast<double>(state.speed), want, 1.0) << t11 << ", " << n;
        ASSERT_EQ(state.setpoint, state.speed);
        ASSERT_EQ(state.ramping, std::abs(want - static_cast<double>(to)) > 0.5) << t11 << ", " << n;
      }
    };
    matches(0, 1'500'000, static_cast<int>(t11 / 2) + 10);
    run.order.target = -1'500'000;
    matches(1'500'000, -1'500'000, static_cast<int>(t11) + 10);
    // Stop on the down ramp, then the rapid stop t13 and the emergency stop t14 of several times.
    run.order.command = AxisCommand::Stop;
    EXPECT_EQ(run.until_standing(), static_cast<int>((t11 + 1) / 2));
    for (const uint32_t t13 : {2'000U, 1'001U, 400U, 333U}) {
      run.order.command = AxisCommand::Run;
      for (uint32_t n = 0; n < 2 * t11; ++n) run.axis.tick(run.order);
      EXPECT_EQ(run.axis.state().speed, -1'500'000);
      run.order.command = AxisCommand::Stop;
      run.order.stop_ramp_ms = t13;
      EXPECT_EQ(run.until_standing(), static_cast<int>((t13 + 1) / 2)) << t13;
    }
  }
}

TEST(AxisRamp, FollowTakesTheSetpointAsItIs) {
  Loaded run(2'000);
  run.order.command = AxisCommand::Follow;
  for (int n = 1; n <= 1'000; ++n) {
    run.order.target = 1'000 * n - 3 * (n % 7);
    ASSERT_EQ(run.axis.tick(run.order).speed, run.order.target);
    ASSERT_FALSE(run.axis.state().ramping);
  }
}

}  // namespace
}  // namespace ipos::runtime
