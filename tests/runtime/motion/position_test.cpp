// The counter is the integral of the speed, 4096 increments a turn, in both directions and over the wrap.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/motion/axis.hpp"

namespace ipos::runtime {
namespace {

AxisOrder order_of(AxisCommand command, int32_t target, uint32_t ms) {
  AxisOrder order;
  order.command = command;
  order.target = target;
  order.ramp = {ms, ms, ms, ms, 0};
  order.stop_ramp_ms = ms;
  return order;
}

constexpr double kPerMs = 4096.0 / 60'000'000;  // increments a millisecond and 1/1000 rpm

TEST(Position, ClosedFormOfARamp) {
  for (const uint32_t ms : {400U, 1'000U, 2'000U, 20'000U})
    for (const int32_t target : {1'500'000, -1'500'000}) {
      Axis axis{{}};
      const AxisOrder order = order_of(AxisCommand::Run, target, ms);
      const double ramp = ms / 2.0;
      for (int n = 1; n <= static_cast<int>(ms); ++n) {
        const double on_ramp = std::min<double>(n, ramp), at_speed = n - on_ramp;
        const double want = target * kPerMs * (on_ramp * on_ramp / ramp / 2 + at_speed);
        ASSERT_NEAR(axis.tick(order).position, want, 1.0) << ms << " " << n;
      }
    }
}

TEST(Position, ConstantSpeedLosesNothing) {
  Axis axis{{}};
  AxisOrder order = order_of(AxisCommand::Follow, 1'234'567, 0);
  order.current_limit = INT32_MAX;
  MachineData light;
  light.rotor_run_up_ms = 1;
  light.inertia = 0;
  axis = Axis(light);
  for (int n = 1; n <= 3'600'000; ++n) axis.tick(order);  // an hour; the first millisecond is a ramp
  const double increments = 1'234'567 * kPerMs * (3'600'000 - 0.5);
  EXPECT_NEAR(static_cast<double>(static_cast<uint32_t>(axis.state().position)),
              std::fmod(increments, 4294967296.0), 1.0);
}

// At the top speed a minute of increments does not fit in 64 bits with its fractions.
TEST(Position, ManyMillisecondsAtOnce) {
  MachineData light;
  light.rotor_run_up_ms = 1;
  light.inertia = 0;
  for (const int32_t speed : {1, -1, 333, 1'234'567, -1'234'567, kTopSpeed, -kTopSpeed}) {
    AxisOrder order = order_of(AxisCommand::Follow, speed, 0);
    order.current_limit = INT32_MAX;
    Axis each(light);
    for (int n = 0; n < 1000; ++n) each.tick(order);
    ASSERT_EQ(each.speed(), speed);
    Axis many = each;
    for (const uint32_t ticks : {1U, 2U, 7U, 31U, 4096U, 4097U, 60'000U}) {
      for (uint32_t n = 0; n < ticks; ++n) each.tick(order);
      many.advance(ticks / 2);
      many.advance(ticks - ticks / 2);  // without a look in between
      ASSERT_EQ(many.position(), each.position()) << speed << ", " << ticks << " ms";
      ASSERT_EQ(many.state().energy, each.state().energy);
      ASSERT_EQ(many == each, true) << "temperatures, and what is left of each division";
    }
    each.tick(order);
    many.tick(order);
    ASSERT_EQ(many.position(), each.position()) << "the part of an increment is the same";
  }
}

TEST(Position, IntegralOfShownSpeeds) {
  std::mt19937_64 random(11);
  Axis axis{{}};
  AxisOrder order;
  double integral = 0;
  int32_t before = 0;
  for (int n = 0; n < 20'000; ++n) {
    if (n % 173 == 0)
      order = order_of(static_cast<AxisCommand>(random() % 5),
                       static_cast<int32_t>(random() % 4'000'000) - 2'000'000,
                       static_cast<uint32_t>(random() % 3'000));
    const AxisState& state = axis.tick(order);
    integral += (before + state.speed) / 2.0 * kPerMs;
    before = state.speed;
    // The shown speeds are rounded: half a step each, 0.00004 increments.
    ASSERT_NEAR(state.position, integral, 1.0 + n * 0.00004) << n;
  }
}

TEST(Position, ForwardAndBackIsNothing) {
  Axis axis{{}};
  for (const int32_t speed : {1'500'000, -1'500'000}) {
    for (int n = 0; n < 2'000; ++n) axis.tick(order_of(AxisCommand::Run, speed, 777));
    for (int n = 0; n < 2'000; ++n) axis.tick(order_of(AxisCommand::Stop, 0, 777));
  }
  EXPECT_NEAR(axis.state().position, 0, 1);
}

// The counter is the whole increments below the exact way, in both directions. An axis that follows has its speed from
// the first millisecond on; in the units of the speed a millisecond is worth 8 / 234375 increments of twice the mean.
TEST(Position, IsRoundedDownInBothDirections) {
  for (const int32_t speed : {1, -1, 700, -700, 12'345, -12'345, 999'999, -999'999}) {
    MachineData machine;
    machine.inertia = 0;
    machine.rotor_run_up_ms = 1;
    Axis axis{machine};
    AxisOrder order = order_of(AxisCommand::Follow, speed, 0);
    order.current_limit = 150'000;
    int64_t twice_the_way = 0;
    int32_t before = 0;
    for (int n = 1; n <= 3'000; ++n) {
      const AxisState& state = axis.tick(order);
      twice_the_way += before + state.speed;
      before = state.speed;
      const int64_t exact = twice_the_way * 8;
      const int64_t down = exact >= 0 ? exact / 234'375 : -((-exact + 234'374) / 234'375);
      ASSERT_EQ(state.position, down) << speed << " after " << n << " ms";
    }
    ASSERT_EQ(before, speed);
  }
}

TEST(Position, WrapsLikeTheCounter) {
  Axis axis{{}};
  axis.set_position(INT32_MAX);
  EXPECT_EQ(axis.state().position, INT32_MAX);
  AxisOrder order = order_of(AxisCommand::Run, 1'500'000, 2'000);
  for (int n = 0; n < 1'000; ++n) axis.tick(order);
  // 0.5 s at 1500 rpm on average half: 12.5 turns
  EXPECT_NEAR(axis.state().position, int64_t{INT32_MAX} + 51'200 - (int64_t{1} << 32), 1);
  axis.set_position(INT32_MIN);
  order.target = -1'500'000;
  for (int n = 0; n < 5'000; ++n) axis.tick(order);
  EXPECT_GT(axis.state().position, 0);
}

// Positive speed words turn clockwise and count up (M07-PD-04 in the drive's part).
TEST(Position, ClockwiseCountsUp) {
  Axis axis{{}};
  for (int n = 0; n < 500; ++n) axis.tick(order_of(AxisCommand::Run, 400'000, 1'000));
  EXPECT_GT(axis.state().position, 0);
  EXPECT_GT(axis.state().frequency, 0);
  axis.reset();
  for (int n = 0; n < 500; ++n) axis.tick(order_of(AxisCommand::Run, -400'000, 1'000));
  EXPECT_LT(axis.state().position, 0);
  EXPECT_LT(axis.state().frequency, 0);
}

}  // namespace
}  // namespace ipos::runtime
