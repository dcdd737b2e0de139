// Travels of a whole drive: times and positions, changes on the way, position controller, modes.
#include <gtest/gtest.h>

#include "tests/runtime/positioning/closed_form.hpp"
#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

runtime::AnalogInputs volts(int32_t millivolt) {
  runtime::AnalogInputs analog;
  analog.ai1.millivolt = millivolt;
  return analog;
}

// The job of the issue: trapezoid and triangle, up and down, at three speeds, against the closed form.
TEST(Travel, TakesTheTimeOfTheClosedForm) {
  for (const int32_t rpm : {300, 1000, 1500})
    for (const int32_t way : {200'000, 1'000})
      for (const int sign : {1, -1}) {
        SCOPED_TRACE(testing::Message() << sign * way << " increments at " << rpm << " rpm");
        Rig rig({{"911", 800}, {"912", 500}, {"913", rpm * 1000}, {"914", rpm * 1000}});
        const ClosedForm form(way, rpm, 800, 500);
        EXPECT_EQ(form.triangle(), way == 1'000);
        const int start = rig.ms;
        rig.go(sign * way);
        int end = 0;
        while (rig.ms - start < form.duration() + 200) {
          rig.tick();
          const int t = rig.ms - start;
          ASSERT_NEAR(rig.h[491], sign * form.linear(t), 0.51) << "setpoint after " << t << " ms";
          ASSERT_LT(std::abs(rig.h[495]), 30) << "lag after " << t << " ms";
          if (end == 0 && rig.h[491] == rig.h[492]) end = t;
        }
        // Rounded to whole increments the setpoint is there when less than half of one is left.
        double rounded = form.duration();
        while (form.linear(rounded) > way - 0.5) rounded -= 0.01;
        EXPECT_GE(end, rounded);
        EXPECT_LE(end, form.duration() + 1);
        EXPECT_TRUE(rig.arrived());
        EXPECT_EQ(rig.h[511], sign * way);
        EXPECT_EQ(rig.h[492], sign * way);
      }
}

// IPOSplus p. 34.
TEST(Travel, RelativeIsStoredAsAbsolute) {
  Rig rig;
  rig.go(50'000);
  rig.run(100);
  rig.go_by(-8'000);
  EXPECT_EQ(rig.h[492], 42'000);
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 42'000);
  rig.go_by(-8'000);
  EXPECT_EQ(rig.h[492], 34'000);
}

// IPOSplus p. 34: after a direct write bit 19 is old for up to 1 ms, after a command it is not.
TEST(Travel, InPositionIsStaleAfterADirectWriteOnly) {
  Rig rig;
  ASSERT_TRUE(rig.in_position());
  rig.h[492] = 10'000;
  EXPECT_TRUE(rig.in_position());
  rig.tick();
  EXPECT_FALSE(rig.in_position());
  rig.run_to_target();
  rig.go(0);
  EXPECT_FALSE(rig.in_position());
}

TEST(Travel, InPositionWithinTheWindow) {
  Rig rig({{"922", 200}});
  rig.go(100'000);
  rig.run_until([&] { return rig.in_position(); });
  EXPECT_GE(rig.h[511], 99'800);
  EXPECT_LT(rig.h[491], 100'000);
  rig.run_to_target();
  // A target within the window is reached from the start.
  rig.go(100'150);
  EXPECT_TRUE(rig.in_position());
  rig.h[493] = 10;
  rig.tick();
  EXPECT_FALSE(rig.in_position());
}

TEST(Travel, TargetMayChangeOnTheWay) {
  Rig rig({{"911", 500}, {"912", 500}});
  rig.go(400'000);
  rig.run(600);
  rig.h[492] = 150'000;
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 150'000);
  rig.h[492] = 100'000;
  rig.run(300);
  const int32_t turning_back = rig.h[511];
  rig.h[492] = 150'000;
  rig.run_until([&] { return rig.drive.axis().speed > 0; });
  EXPECT_LT(rig.h[511], turning_back);
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 150'000);
}

TEST(Travel, SpeedMayChangeOnTheWay) {
  Rig rig;
  rig.go(400'000);
  rig.run(1000);
  rig.service.set_parameter("913", 600'000);
  rig.run(400);
  EXPECT_NEAR(rig.drive.axis().speed, 600'000, 3'000);
  EXPECT_EQ(rig.drive.fault(), 0);
}

TEST(Travel, CurvedRampsMustNotChangeOnTheWay) {
  for (const int32_t shape : {1, 2})
    for (const char* parameter : {"911", "912", "913", "916"}) {
      Rig rig({{"916", shape}});
      rig.go(400'000);
      rig.run_to_target();
      rig.service.set_parameter("913", 1'000'000);  // at rest it may
      rig.go(0);
      rig.run(500);
      ASSERT_EQ(rig.drive.fault(), 0);
      rig.service.set_parameter(parameter, parameter[2] == '6' ? 0 : 700);
      rig.run(2);
      EXPECT_EQ(rig.drive.fault(), 99) << parameter;
      EXPECT_FALSE(rig.drive.axis().output_stage) << "immediate stop";
    }
}

// Only speed, ramps and their type are forbidden to change: the target may, and the override waits for the next travel.
TEST(Travel, ACurvedRampTakesAnotherTargetAndKeepsItsOverride) {
  for (const int32_t shape : {1, 2}) {
    Rig rig({{"916", shape}, {"930", 1}, {"302", 3'000'000}});
    rig.drive.set_analog(volts(5'000));
    rig.go(400'000);
    rig.run(1'000);
    EXPECT_NEAR(rig.drive.axis().speed, 1'125'000, 1'000);  // 75 % of 1500 rpm
    rig.drive.set_analog(volts(2'500));
    rig.run(300);
    EXPECT_NEAR(rig.drive.axis().speed, 1'125'000, 1'000);
    rig.go(300'000);
    rig.run(300);
    EXPECT_NEAR(rig.drive.axis().speed, 1'125'000, 1'000);
    rig.run_to_target();
    EXPECT_EQ(rig.h[511], 300'000);
    rig.go(0);
    rig.run(1'000);
    EXPECT_NEAR(rig.drive.axis().speed, -562'500, 1'000);  // 37.5 %
    rig.run_to_target();
    EXPECT_EQ(rig.h[511], 0);
    EXPECT_EQ(rig.drive.fault(), 0);
  }
}

TEST(Travel, FromLinearToCurvedHoldsFromTheNextTravelOn) {
  for (const int32_t shape : {1, 2}) {
    Rig rig({{"911", 1'000}, {"912", 800}});
    rig.go(150'000);
    const ClosedForm form(150'000, 1500, 1000, 800);
    for (int t = 1; t < form.duration(); ++t) {
      if (t == 100) rig.service.set_parameter("916", shape);
      rig.tick();
      ASSERT_NEAR(rig.h[491], form.linear(t), 0.51) << t;
    }
    rig.run_to_target();
    rig.go(0);
    for (int t = 1; t < 200; ++t) {
      rig.tick();
      ASSERT_NEAR(rig.h[491], 150'000 - (shape == 1 ? form.sine(t) : form.squared(t)), 0.51) << t;
    }
    EXPECT_EQ(rig.drive.fault(), 0);
  }
}

TEST(Travel, CurvedRampsTakeTheTimeOfTheLinearOne) {
  for (const int32_t shape : {1, 2}) {
    Rig rig({{"916", shape}, {"911", 1000}, {"912", 800}});
    const ClosedForm form(150'000, 1500, 1000, 800);
    rig.go(150'000);
    for (int t = 1; t < form.duration(); ++t) {
      rig.tick();
      ASSERT_NEAR(rig.h[491], shape == 1 ? form.sine(t) : form.squared(t), 0.51) << t;
      ASSERT_LT(std::abs(rig.h[495]), 30) << t;
    }
    rig.tick();
    EXPECT_EQ(rig.h[491], 150'000);
  }
}

TEST(Travel, OverrideScalesTheSpeed) {
  Rig rig({{"930", 1}, {"302", 3'000'000}});
  rig.drive.set_analog(volts(5'000));
  rig.go(4'000'000);
  rig.run(1500);
  EXPECT_NEAR(rig.drive.axis().speed, 1'125'000, 1'000);  // 75 % of 1500 rpm
  rig.drive.set_analog(volts(10'000));
  rig.run(1500);
  EXPECT_NEAR(rig.drive.axis().speed, 2'250'000, 1'000);
  rig.drive.set_analog({});
  rig.run(1500);
  EXPECT_EQ(rig.drive.axis().speed, 0);
  EXPECT_FALSE(rig.in_position());
  rig.service.set_parameter("930", 0);
  rig.run(1500);
  EXPECT_NEAR(rig.drive.axis().speed, 1'500'000, 1'000);
}

TEST(Travel, NeverFasterThanTheMaximumSpeed) {
  Rig rig({{"302", 900'000}});
  rig.go(400'000);
  rig.run(1000);
  EXPECT_NEAR(rig.drive.axis().speed, 900'000, 1'000);
}

// Without feedforward the lag is speed / gain: 0.5 rpm an increment at 1.000 (ours).
TEST(Travel, GainAndFeedforward) {
  Rig rig({{"915", 0}, {"910", 1'000}, {"913", 600'000}});
  rig.go(400'000);
  rig.run(1500);
  EXPECT_NEAR(rig.h[495], 1'200, 5);
  Rig half({{"915", 50'000}, {"910", 1'000}, {"913", 600'000}});
  half.go(400'000);
  half.run(1500);
  EXPECT_NEAR(half.h[495], 600, 5);
}

// Without gain the axis turns as fast as P915 says, to 1/1000 rpm.
TEST(Travel, FeedforwardAloneIsAShareOfTheSpeed) {
  for (const int32_t share : {0, 1'000, 50'000, 100'000, 33'000})
    for (const int sign : {1, -1}) {
      Rig rig({{"915", share}, {"910", 0}, {"913", 600'000}, {"914", 600'000}, {"923", 0}});
      rig.go(sign * 400'000);
      rig.run(1'000);
      EXPECT_EQ(rig.drive.axis().speed, sign * 6 * share) << share;
    }
}

TEST(Travel, LagError) {
  Rig rig({{"915", 0}, {"923", 2'000}});
  rig.go(400'000);
  rig.run_until([&] { return rig.drive.fault() == 42; });
  EXPECT_GT(rig.h[495], 1'900);
  EXPECT_TRUE(rig.drive.error()) << "P834 from the factory: emergency stop with error";
  EXPECT_TRUE(rig.said("F42"));

  Rig display({{"915", 0}, {"923", 2'000}, {"834", 1}});
  display.go(100'000);
  display.run_to_target();
  EXPECT_EQ(display.drive.fault(), 42);
  EXPECT_FALSE(display.drive.error());

  Rig none({{"915", 0}, {"923", 0}});
  none.go(100'000);
  none.run_to_target();
  EXPECT_EQ(none.drive.fault(), 0);
}

// A load the motor cannot accelerate that fast.
TEST(Travel, TooSteepARampIsALagError) {
  Rig rig({{"911", 10}, {"912", 10}});
  rig.go(400'000);
  rig.run_until([&] { return rig.drive.fault() == 42; });
}

TEST(Travel, OnlyInModesWithIpos) {
  for (const int32_t mode : {9, 13, 18}) {
    Rig rig({{"700", mode}});
    rig.go(10'000);
    rig.run_to_target();
    EXPECT_EQ(rig.h[511], 10'000);
  }
  for (const int32_t mode : {0, 5, 11, 16}) {
    Rig rig({{"700", mode}, {"301", 0}});
    rig.go(10'000);
    rig.run(500);
    EXPECT_EQ(rig.h[511], 0);
    EXPECT_FALSE(rig.in_position());
    EXPECT_TRUE(rig.said("F77"));
    EXPECT_EQ(rig.drive.fault(), 0) << "F77 has no response from the factory";
  }
}

// In modes with IPOS neither setpoint source nor minimum speed turns the motor.
TEST(Travel, TheSetpointOfP100DoesNotCount) {
  Rig rig;
  rig.drive.set_analog(volts(5'000));
  rig.run(1000);
  EXPECT_EQ(rig.h[511], 0);
  EXPECT_TRUE(rig.drive.axis().brake_released);
}

TEST(Travel, PositionedFromTheExternalEncoder) {
  // 3 increments of the motor for 2 of the external encoder.
  Rig rig({{"941", 1}, {"942", 3}, {"943", 2}, {"913", 600'000}, {"911", 500}, {"912", 500}});
  rig.go(20'000);
  const ClosedForm form(30'000, 600, 500, 500);  // in increments of the motor
  const int start = rig.ms;
  rig.run_until([&] { return rig.h[491] == 20'000; });
  EXPECT_NEAR(rig.ms - start, form.duration(), 2.5);  // the last half increment shows as a whole one
  rig.run(500);
  EXPECT_EQ(rig.h[510], 20'000);
  EXPECT_NEAR(rig.h[511], 30'000, 2);
}

TEST(Travel, AbsoluteEncoderIsAlwaysReferenced) {
  Rig rig({{"941", 2}, {"954", 7'000}});
  EXPECT_TRUE(rig.referenced());
  EXPECT_EQ(rig.h[509], 7'000);
  EXPECT_EQ(rig.h[492], 7'000) << "where it is, until a target is given";
  rig.run(200);
  EXPECT_EQ(rig.h[511], 0);
  rig.go(9'000);
  rig.run(2000);
  EXPECT_EQ(rig.h[509], 9'000);
  EXPECT_EQ(rig.h[511], 2'000);
}

TEST(Travel, OutputsShowInPositionAndReferenced) {
  Rig rig({{"620", 19}, {"621", 20}, {"903", 5}});
  EXPECT_EQ(rig.drive.outputs() & 0b110, 0b010);
  rig.positioner().start_reference(false, false);
  rig.run(2);
  EXPECT_EQ(rig.drive.outputs() & 0b110, 0b110);
  rig.go(10'000);
  rig.run(2);
  EXPECT_EQ(rig.drive.outputs() & 0b110, 0b100);
}

TEST(Travel, RelativeBeyondTheRangeIsNotMade) {
  Rig rig;
  rig.go(INT32_MAX);
  rig.go_by(1);
  EXPECT_EQ(rig.h[492], INT32_MAX);
  rig.run(2);
  EXPECT_TRUE(rig.said("F78"));
}

}  // namespace
}  // namespace ipos::tests
