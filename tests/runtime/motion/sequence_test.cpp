// Enable and stop to the millisecond: premagnetization, brake release, ramp, brake application, output stage
// off.
#include <gtest/gtest.h>

#include "runtime/motion/axis.hpp"

namespace ipos::runtime {
namespace {

struct Drive {
  Axis axis;
  AxisOrder order;
  explicit Drive(MachineData machine = {}) : axis(machine) {
    order.target = 300'000;
    order.ramp = {1'000, 1'000, 1'000, 1'000, 0};
    order.stop_ramp_ms = 500;
    order.premagnetize_ms = 100;
    order.brake_release_ms = 30;
    order.brake_apply_ms = 200;
  }
  const AxisState& run(int ms) {
    for (int n = 0; n < ms; ++n) axis.tick(order);
    return axis.state();
  }
  const AxisState& run(AxisCommand command, int ms) {
    order.command = command;
    return run(ms);
  }
};

TEST(Sequence, EnableToTheMillisecond) {
  Drive drive;
  drive.order.command = AxisCommand::Run;
  for (int ms = 1; ms <= 240; ++ms) {
    const AxisState& state = drive.run(1);
    ASSERT_TRUE(state.output_stage) << ms;
    ASSERT_EQ(state.brake_released, ms > 100) << ms;                                      // P323 over
    ASSERT_EQ(state.speed, ms <= 130 ? 0 : std::min(300'000, 3'000 * (ms - 130))) << ms;  // P731 over
    ASSERT_EQ(state.phase, ms <= 100   ? AxisPhase::Magnetizing
                           : ms <= 130 ? AxisPhase::Releasing
                                       : AxisPhase::Moving);
    // Magnetizing current from the first millisecond.
    ASSERT_GE(state.output_current, 60'000) << ms;
  }
}

TEST(Sequence, StopToTheMillisecond) {
  Drive drive;
  drive.run(AxisCommand::Run, 300);
  drive.order.command = AxisCommand::Stop;
  for (int ms = 1; ms <= 260; ++ms) {  // 300 rpm at 6 rpm a millisecond: 50 ms
    const AxisState& state = drive.run(1);
    ASSERT_EQ(state.speed, std::max(0, 300'000 - 6'000 * ms)) << ms;
    ASSERT_EQ(state.brake_released, ms <= 50) << ms;
    ASSERT_EQ(state.output_stage, ms <= 250) << ms;  // P732 over
    ASSERT_EQ(state.standing, ms >= 50) << ms;
  }
}

TEST(Sequence, WithoutTimesEverythingFollowsAtOnce) {
  Drive drive;
  drive.order.premagnetize_ms = drive.order.brake_release_ms = drive.order.brake_apply_ms = 0;
  EXPECT_EQ(drive.run(AxisCommand::Run, 1).speed, 3'000);
  drive.run(99);
  const AxisState& state = drive.run(AxisCommand::Stop, 50);
  EXPECT_TRUE(state.standing && state.output_stage && state.brake_released);
  drive.run(1);
  EXPECT_FALSE(state.output_stage || state.brake_released);
}

TEST(Sequence, BrakeFunctionOffNeedsNoBrakeTimes) {
  Drive drive;
  drive.order.brake_function = false;
  EXPECT_EQ(drive.run(AxisCommand::Run, 100).speed, 0);
  EXPECT_EQ(drive.run(1).speed, 3'000);
  drive.run(200);
  drive.run(AxisCommand::Stop, 50);
  EXPECT_FALSE(drive.run(1).output_stage);
}

TEST(Sequence, InhibitActsAtOnce) {
  for (const int ms : {1, 100, 101, 130, 131, 300}) {
    Drive drive;
    drive.run(AxisCommand::Run, ms);
    const AxisState& state = drive.run(AxisCommand::Inhibit, 1);
    EXPECT_FALSE(state.output_stage || state.brake_released) << ms;
    EXPECT_EQ(state.output_current, 0);
    EXPECT_EQ(state.setpoint, 0);
  }
}

TEST(Sequence, StopBeforeMotion) {
  Drive drive;
  drive.run(AxisCommand::Run, 50);  // magnetizing: off at once, the brake never opened
  EXPECT_FALSE(drive.run(AxisCommand::Stop, 1).output_stage);
  drive.run(AxisCommand::Run, 120);  // releasing: the brake falls in again first
  EXPECT_FALSE(drive.run(AxisCommand::Stop, 1).brake_released);
  EXPECT_TRUE(drive.run(199).output_stage);
  EXPECT_FALSE(drive.run(1).output_stage);
}

TEST(Sequence, EnableWhileTheBrakeFallsIn) {
  Drive drive;
  drive.run(AxisCommand::Run, 300);
  drive.run(AxisCommand::Stop, 100);
  EXPECT_EQ(drive.axis.state().phase, AxisPhase::Applying);
  EXPECT_TRUE(drive.run(AxisCommand::Run, 1).brake_released);  // magnetized already: only P731
  EXPECT_EQ(drive.run(29).speed, 0);
  EXPECT_EQ(drive.run(1).speed, 3'000);
}

TEST(Sequence, HoldZeroKeepsBrakeOpenAndCurrent) {
  Drive drive;
  drive.run(AxisCommand::Run, 300);
  const AxisState& state = drive.run(AxisCommand::HoldZero, 50);
  EXPECT_TRUE(state.standing);
  drive.run(10'000);
  EXPECT_TRUE(state.standing && state.output_stage && state.brake_released);
  EXPECT_EQ(state.output_current, 60'000);
}

// P710: current at standstill without enable, unit state 3 of MOVITRAC 07.
TEST(Sequence, StandstillCurrent) {
  Drive drive;
  drive.order.standstill_current = 20'000;
  drive.run(AxisCommand::Run, 300);
  const AxisState& state = drive.run(AxisCommand::Stop, 250);
  EXPECT_EQ(state.phase, AxisPhase::Applying);
  drive.run(1);
  EXPECT_EQ(state.phase, AxisPhase::StandstillCurrent);
  EXPECT_TRUE(state.output_stage);
  EXPECT_FALSE(state.brake_released);
  EXPECT_EQ(state.output_current, 20'000);
  drive.order.standstill_current = 0;
  EXPECT_FALSE(drive.run(1).output_stage);
  drive.order.standstill_current = 20'000;
  EXPECT_TRUE(drive.run(1).output_stage);  // also from rest
  EXPECT_FALSE(drive.run(AxisCommand::Inhibit, 1).output_stage);
}

// However little it is.
TEST(Sequence, StandstillCurrentIsAnyAboveZero) {
  for (const int32_t current : {-1, 0, 1, 2}) {
    Drive drive;
    drive.order.standstill_current = current;
    EXPECT_EQ(drive.run(AxisCommand::Stop, 1).phase,
              current > 0 ? AxisPhase::StandstillCurrent : AxisPhase::Off);
    EXPECT_EQ(drive.axis.state().output_current, std::max(current, 0));
  }
}

// A hoist that is enabled again while it still turns, and stopped while its brake opens: the brake falls in at
// standstill, on the stop ramp (500 ms for 3000 rpm) from the speed that was found.
TEST(Sequence, StopWhileTheBrakeOpensOnATurningShaft) {
  MachineData machine;
  machine.brake = false;
  machine.friction = 0;
  Drive drive(machine);
  drive.run(AxisCommand::Run, 300);
  drive.run(AxisCommand::Inhibit, 10);
  ASSERT_EQ(drive.run(AxisCommand::Run, 115).phase, AxisPhase::Releasing);
  const int32_t found = drive.axis.state().speed;
  ASSERT_EQ(found, 300'000);
  drive.order.command = AxisCommand::Stop;
  for (int ms = 1; ms <= 260; ++ms) {
    const AxisState& state = drive.run(1);
    ASSERT_EQ(state.speed, std::max(0, found - 6'000 * ms)) << ms;
    ASSERT_EQ(state.brake_released, ms <= 50) << ms;
    ASSERT_EQ(state.output_stage, ms <= 250) << ms;
  }
}

TEST(Sequence, TurningMotorIsCaughtAtItsSpeed) {
  MachineData machine;
  machine.brake = false;
  Drive drive(machine);
  drive.order.premagnetize_ms = drive.order.brake_release_ms = 0;
  drive.run(AxisCommand::Run, 100);
  drive.run(AxisCommand::Inhibit, 200);
  const int32_t found = drive.axis.state().speed;
  ASSERT_GT(found, 200'000);
  EXPECT_EQ(drive.run(AxisCommand::Run, 1).speed, found + 3'000);
}

}  // namespace
}  // namespace ipos::runtime
