// Enable lost and given back, _AxisStop, and what goes on afterwards.
#include <gtest/gtest.h>

#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Halt;

constexpr uint16_t kNoEnable = kEnabled & ~(1 << 3);   // DI03 rapid stop
constexpr uint16_t kInhibited = kEnabled & ~(1 << 0);  // DI00

TEST(Interruption, ATravelGoesOnWhenEnableComesBack) {
  for (const uint16_t levels : {kNoEnable, kInhibited, uint16_t{kEnabled & ~(1 << 1)}}) {
    Rig rig({{"136", 200}, {"131", 300}});
    rig.go(200'000);
    rig.run(900);
    rig.drive.set_inputs(levels);
    rig.run(3000);
    EXPECT_TRUE(rig.drive.axis().standing);
    EXPECT_EQ(rig.h[491], rig.h[511]) << "without enable the setpoint is where the axis is";
    EXPECT_EQ(rig.h[492], 200'000);
    EXPECT_FALSE(rig.in_position());
    rig.drive.set_inputs(kEnabled);
    rig.run_to_target();
    EXPECT_EQ(rig.h[511], 200'000);
    EXPECT_EQ(rig.drive.fault(), 0);
  }
}

// Nothing jumps when enable comes back while the axis still turns.
TEST(Interruption, TakesOverATurningAxis) {
  Rig rig({{"136", 4'000}});
  rig.go(800'000);
  rig.run(1000);
  rig.drive.set_inputs(kNoEnable);
  rig.run(500);
  const int32_t speed = rig.drive.axis().speed;
  EXPECT_GT(speed, 500'000);
  rig.drive.set_inputs(kEnabled);
  rig.tick();
  EXPECT_NEAR(rig.drive.axis().speed, speed, 10'000);
  EXPECT_LT(std::abs(rig.h[495]), 30);
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 800'000);
  EXPECT_EQ(rig.drive.fault(), 0);
}

TEST(Interruption, WhatWouldOverrunIsF123) {
  Rig rig({{"136", 20'000}, {"912", 1'000}, {"137", 200}});
  rig.go(100'000);
  rig.run_until([&] { return rig.h[511] > 100'000 - 25'600; });  // the way it needs to stop
  rig.drive.set_inputs(kNoEnable);
  rig.run(50);
  rig.drive.set_inputs(kEnabled);
  rig.run(2);
  EXPECT_EQ(rig.drive.fault(), 123);
  rig.run(1000);
  ASSERT_TRUE(rig.drive.axis().standing);
  // Once reset at rest it goes on, back if it must.
  rig.drive.reset_fault();
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 100'000);
}

TEST(Interruption, AFaultOnTheWay) {
  Rig rig;
  rig.go(200'000);
  rig.run(700);
  rig.drive.raise_fault(26);
  rig.run(3000);
  EXPECT_TRUE(rig.drive.axis().standing);
  EXPECT_FALSE(rig.drive.axis().output_stage);
  rig.drive.reset_fault();
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 200'000);
}

TEST(AxisStop, RapidStopHoldsTheAxisUntilEnable) {
  Rig rig({{"136", 100}});
  rig.go(200'000);
  rig.run(900);
  rig.positioner().halt(Halt::RapidStop);
  rig.run(300);
  EXPECT_TRUE(rig.drive.axis().standing);
  EXPECT_EQ(rig.drive.verdict().command, runtime::Command::RapidStop);
  rig.go(150'000);
  rig.run(1000);
  EXPECT_TRUE(rig.drive.axis().standing);
  EXPECT_FALSE(rig.drive.axis().output_stage) << "brake applied, output stage off";
  rig.positioner().halt(Halt::None);
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 150'000);
}

TEST(AxisStop, HoldControlKeepsTheOutputStageOn) {
  Rig rig({{"131", 300}});
  rig.go(200'000);
  rig.run(900);
  rig.positioner().halt(Halt::HoldControl);
  rig.run(1000);
  EXPECT_TRUE(rig.drive.axis().standing);
  EXPECT_TRUE(rig.drive.axis().output_stage);
  EXPECT_EQ(rig.drive.condition(), runtime::UnitCondition::HoldControl);
  rig.positioner().halt(Halt::None);
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 200'000);
}

TEST(AxisStop, ReleasedBeforeStandstillTheAxisGoesOnWithoutAJerk) {
  Rig rig({{"131", 2'000}});
  rig.go(600'000);
  rig.run(900);
  rig.positioner().halt(Halt::HoldControl);
  rig.run(300);
  const int32_t speed = rig.drive.axis().speed;
  ASSERT_GT(speed, 500'000);
  rig.positioner().halt(Halt::None);
  for (int n = 0; n < 5; ++n) {
    rig.tick();
    EXPECT_NEAR(rig.drive.axis().speed, speed, 20'000);
  }
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 600'000);
}

TEST(AxisStop, PositionStopMovesTheTargetToTheStop) {
  Rig rig({{"911", 1'000}, {"912", 1'000}});
  rig.go(400'000);
  rig.run(1000);
  const int32_t setpoint = rig.h[491];
  rig.positioner().stop_here();
  rig.service.show_targets(rig.h);
  EXPECT_NEAR(rig.h[492], setpoint + 25'600, 2);
  rig.run_to_target();
  EXPECT_NEAR(rig.h[511], setpoint + 25'600, 2);
  EXPECT_TRUE(rig.in_position());
  // It does not lock the axis.
  rig.go_by(1'000);
  rig.run_to_target();
  EXPECT_NEAR(rig.h[511], setpoint + 26'600, 2);
}

// Pulled away without enable, the axis returns to its target.
TEST(Interruption, ATargetOnceGivenIsKept) {
  Rig rig;
  rig.go(1'000);
  rig.run_to_target();
  rig.drive.set_inputs(kInhibited);
  rig.run(500);
  rig.drive.set_position(1'300);
  rig.positioner().observe(1'300);
  rig.run(2);
  EXPECT_EQ(rig.h[511], 1'300);
  rig.drive.set_inputs(kEnabled);
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 1'000);
}

// Before the first target the axis stays where it is found.
TEST(Interruption, WithoutATargetTheAxisStays) {
  Rig rig({{"700", 13}});
  rig.drive.set_inputs(kInhibited);
  rig.run(2);
  rig.drive.set_position(5'000);
  rig.run(2);
  rig.drive.set_inputs(kEnabled);
  rig.run(500);
  EXPECT_EQ(rig.h[511], 5'000);
  EXPECT_EQ(rig.h[492], 5'000);
}

}  // namespace
}  // namespace ipos::tests
