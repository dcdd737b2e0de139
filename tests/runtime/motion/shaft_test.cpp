// The mechanics against hand calculation. Default machine: rated torque takes the shaft from 0 to 1500 rpm in
// 50 ms x (100 + 400) / 100 = 250 ms, so 100 % torque is 6 rpm a millisecond; friction 5 %, brake 200 %.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/motion/axis.hpp"

namespace ipos::runtime {
namespace {

constexpr double kPerRated = 6'000;  // 1/1000 rpm a millisecond

AxisOrder run_to(int32_t target, uint32_t ms) {
  AxisOrder order;
  order.command = AxisCommand::Run;
  order.target = target;
  order.ramp = {ms, ms, ms, ms, 0};
  order.stop_ramp_ms = ms;
  return order;
}

int ticks_until_standing(Axis& axis, const AxisOrder& order) {
  for (int n = 1; n < 1'000'000; ++n)
    if (axis.tick(order).standing) return n;
  return -1;
}

TEST(Shaft, CoastsByFriction) {
  MachineData machine;
  machine.brake = false;
  for (const int32_t friction : {1'000, 5'000, 20'000})
    for (const int32_t speed : {1'500'000, -700'000}) {
      machine.friction = friction;
      Axis axis(machine);
      for (int n = 0; n < 3'000; ++n) axis.tick(run_to(speed, 2'000));
      ASSERT_EQ(axis.state().speed, speed);
      AxisOrder off;
      const double slope = kPerRated * friction / 100'000;
      const int32_t sign = speed < 0 ? -1 : 1;
      for (int n = 1; n <= 100; ++n)
        ASSERT_NEAR(axis.tick(off).speed, speed - sign * slope * n, 1.0) << friction;
      EXPECT_NEAR(ticks_until_standing(axis, off), std::ceil(std::abs(speed) / slope) - 100, 1);
      EXPECT_EQ(axis.tick(off).speed, 0);
    }
}

TEST(Shaft, BrakeStopsTheInhibitedAxis) {
  Axis axis{{}};
  for (int n = 0; n < 2'000; ++n) axis.tick(run_to(1'500'000, 2'000));
  EXPECT_EQ(ticks_until_standing(axis, {}), std::ceil(1'500'000 / (kPerRated * 2.05)));
  // Without the brake function nothing closes it.
  for (int n = 0; n < 2'000; ++n) axis.tick(run_to(1'500'000, 2'000));
  AxisOrder coast;
  coast.brake_function = false;
  EXPECT_NEAR(ticks_until_standing(axis, coast), std::ceil(1'500'000 / (kPerRated * 0.05)), 1);
}

TEST(Shaft, TorqueIsAccelerationFrictionAndLoad) {
  Axis axis{{}};
  AxisOrder order = run_to(1'500'000, 2'000);  // 1.5 rpm a millisecond: 25 %
  order.load_torque = 30'000;
  EXPECT_NEAR(axis.tick(order).torque, 25'000 + 5'000 + 30'000, 2);
  for (int n = 0; n < 1'500; ++n) axis.tick(order);
  EXPECT_EQ(axis.state().torque, 5'000 + 30'000);
  order.command = AxisCommand::Stop;
  EXPECT_NEAR(axis.tick(order).torque, -25'000 + 5'000 + 30'000, 2);
  order = run_to(-1'500'000, 2'000);
  order.load_torque = 30'000;  // a static load acts in one direction
  for (int n = 0; n < 4'000; ++n) axis.tick(order);
  EXPECT_EQ(axis.state().torque, -5'000 + 30'000);
}

// 150 % IN leave sqrt(150² - 60²) % active current, that is 171.8 % torque at 80 % active current a rated
// torque.
TEST(Shaft, CurrentLimitMakesTheSpeedLag) {
  for (const int32_t limit : {150'000, 100'000, 70'000, 65'000}) {
    Axis axis{{}};
    AxisOrder order = run_to(1'500'000, 100);
    order.current_limit = limit;
    const double torque = std::sqrt(std::pow(limit, 2) - std::pow(60'000, 2)) / 0.8;
    const double slope = kPerRated * (torque - 5'000) / 100'000;
    for (int n = 1; n <= 1'000'000; ++n) {
      const AxisState& state = axis.tick(order);
      ASSERT_LE(state.output_current, limit);
      if (!state.current_limited) {
        EXPECT_EQ(n, std::ceil(1'500'000 / slope)) << limit;
        break;
      }
      ASSERT_NEAR(state.speed, slope * n, 1 + 0.0001 * slope * n) << limit << " " << n;
      ASSERT_NEAR(state.output_current, limit, 3);
    }
    for (int n = 0; n < 10; ++n) axis.tick(order);
    EXPECT_EQ(axis.state().speed, 1'500'000) << limit;
    // The same limit holds for braking, where friction helps.
    order.command = AxisCommand::Stop;
    EXPECT_EQ(ticks_until_standing(axis, order),
              std::ceil(1'500'000 / (kPerRated * (torque + 5'000) / 100'000)));
  }
}

// The ramp waits at the shaft's speed: the setpoint is one of its steps ahead of that, both ways.
TEST(Shaft, TheSetpointOfALaggingAxisIsOneStepAhead) {
  for (const int32_t sign : {1, -1}) {
    Axis axis{{}};
    const AxisOrder order = run_to(sign * 1'500'000, 100);
    for (int n = 0; n < 40; ++n) {
      const int32_t before = axis.state().speed;
      const AxisState& state = axis.tick(order);
      ASSERT_TRUE(state.current_limited);
      ASSERT_NEAR(state.setpoint, before + sign * 30'000, 1);  // 3000 rpm in 100 ms
      ASSERT_LT(std::abs(state.speed), std::abs(state.setpoint));
    }
  }
}

// Coasting or magnetizing, standing or turning: no torque, no active current, no setpoint.
TEST(Shaft, OnlyADrivingMotorHasTorque) {
  MachineData machine;
  machine.brake = false;
  Axis axis(machine);
  const auto idle = [&](AxisPhase phase) {
    EXPECT_EQ(axis.state().phase, phase);
    EXPECT_EQ(axis.state().torque, 0);
    EXPECT_EQ(axis.state().active_current, 0);
    EXPECT_EQ(axis.state().setpoint, 0);
    EXPECT_FALSE(axis.state().current_limited);
  };
  AxisOrder order = run_to(600'000, 1'000);
  order.premagnetize_ms = 10;
  axis.tick({});
  idle(AxisPhase::Off);
  axis.tick(order);
  idle(AxisPhase::Magnetizing);
  for (int n = 0; n < 500; ++n) axis.tick(order);
  EXPECT_EQ(axis.state().torque, 5'000);
  axis.tick({});
  idle(AxisPhase::Off);
  axis.tick(order);
  idle(AxisPhase::Magnetizing);
  EXPECT_GT(axis.state().speed, 0);
}

// A torque that does not carry the shaft beyond the speed limit is given as it is, also where the shaft then is just
// at the limit.
TEST(Shaft, AtTheSpeedLimitTheTorqueIsTheGivenOne) {
  const Shaft shaft{within_limits({})};
  for (const int64_t torque : {4'000, -4'000}) {  // friction holds it: the speed stays 0
    const Motion motion = shaft.turned(0, torque, 0, 200'000, {0, 5'000});
    EXPECT_EQ(motion.speed, 0);
    EXPECT_EQ(motion.torque, torque);
    EXPECT_FALSE(motion.limited);
  }
  for (const int64_t torque : {6'000, -6'000}) {  // it would turn: only friction may be left
    const Motion motion = shaft.turned(0, torque, 0, 200'000, {0, 5'000});
    EXPECT_EQ(motion.speed, 0);
    EXPECT_LE(std::abs(motion.torque), 5'000);
  }
}

TEST(Shaft, StopOfALaggingAxisStartsFromItsSpeed) {
  Axis axis{{}};
  AxisOrder order = run_to(1'500'000, 10);
  for (int n = 0; n < 20; ++n) axis.tick(order);
  const int32_t speed = axis.state().speed;
  ASSERT_TRUE(axis.state().current_limited);
  order.command = AxisCommand::Stop;
  order.stop_ramp_ms = 2'000;
  EXPECT_NEAR(axis.tick(order).speed, speed - 1'500, 1);
}

TEST(Shaft, WithoutCurrentItStands) {
  Axis axis{{}};
  AxisOrder order = run_to(1'500'000, 100);
  order.current_limit = 60'000;  // all of it magnetizes
  for (int n = 0; n < 1'000; ++n) axis.tick(order);
  EXPECT_EQ(axis.state().speed, 0);
  EXPECT_TRUE(axis.state().current_limited);
}

// A hoist: 60 % static load, turning counter-clockwise when let go.
class Hoist : public ::testing::Test {
 protected:
  Hoist() : axis_(hoist()) { order_.brake_release_ms = order_.brake_apply_ms = 20; }
  static MachineData hoist() {
    MachineData machine;
    machine.load_torque = 60'000;
    return machine;
  }
  void run(AxisCommand command, int ms) {
    order_.command = command;
    for (int n = 0; n < ms; ++n) axis_.tick(order_);
  }
  Axis axis_;
  AxisOrder order_ = run_to(600'000, 1'000);
};

TEST_F(Hoist, BrakeAndMotorHoldIt) {
  run(AxisCommand::Inhibit, 100);
  EXPECT_EQ(axis_.state().position, 0);
  run(AxisCommand::HoldZero, 100);
  EXPECT_EQ(axis_.state().position, 0);
  EXPECT_EQ(axis_.state().torque, 60'000);
  EXPECT_EQ(axis_.state().active_current, 48'000);
  run(AxisCommand::Run, 400);
  EXPECT_EQ(axis_.state().speed, 600'000);
  run(AxisCommand::Stop, 400);
  const int32_t position = axis_.state().position;
  run(AxisCommand::Stop, 1'000);
  EXPECT_EQ(axis_.state().position, position);
}

TEST_F(Hoist, FallsWithoutBrake) {
  order_.brake_function = false;
  run(AxisCommand::Inhibit, 100);
  // 60 % pull, 5 % friction against it
  EXPECT_NEAR(axis_.state().speed, -kPerRated * 0.55 * 100, 1);
}

TEST_F(Hoist, TooLittleCurrentLetsItSink) {
  order_.current_limit = 65'000;  // 31 % torque
  run(AxisCommand::HoldZero, 200);
  EXPECT_LT(axis_.state().speed, 0);
  EXPECT_TRUE(axis_.state().current_limited);
}

// What is outside: an inertia of `share` times what was told, a load, and an answer a millisecond later.
struct Outside {
  double share;
  double load;  // 1/1000 %, positive pulls counter-clockwise
  double speed = 0;
  double torque = 0;

  void tick(Axis& axis, AxisOrder order) {
    order.shaft_speed = static_cast<int32_t>(std::lround(speed));
    const int32_t given = axis.tick(order).torque;
    speed += (torque - load) / 100'000 * kPerRated / share;
    torque = given;
  }
};

TEST(Shaft, DrivenFromOutsideIsTakenToTheSetpointAndHeldThere) {
  MachineData machine;
  machine.driven = true;
  for (const double share : {0.5, 1.0, 3.0, 10.0})
    for (const double load : {0.0, 60'000.0, -90'000.0}) {
      Axis axis(machine);
      Outside outside{share, load};
      double most = 0;
      for (int n = 0; n < 3'000; ++n) {
        outside.tick(axis, run_to(1'200'000, 3'000));
        most = std::max(most, outside.speed);
      }
      EXPECT_NEAR(outside.speed, 1'200'000, 500) << share << " " << load;
      EXPECT_NEAR(axis.state().torque, load, 500) << "no friction of its own";
      EXPECT_LT(most, 1'240'000) << share << " " << load;
      EXPECT_NEAR(axis.state().speed, outside.speed, 3) << "as it was told in the last tick " << share;
    }
}

TEST(Shaft, DrivenFromOutsideGoesWhereItIsDrivenToWithoutTorque) {
  MachineData machine;
  machine.driven = true;
  Axis axis(machine);
  AxisOrder off;
  off.shaft_speed = -321'000;
  for (int n = 0; n < 60'000; ++n) axis.tick(off);
  EXPECT_EQ(axis.state().speed, -321'000);
  EXPECT_EQ(axis.state().torque, 0);
  EXPECT_NEAR(axis.state().position, -321.0 * 4096, 12) << "a minute, half a millisecond less of it at the start";
}

TEST(Shaft, DrivenFromOutsideGivesTheTorqueThatIsOrdered) {
  MachineData machine;
  machine.driven = true;
  Axis axis(machine);
  AxisOrder order = run_to(0, 1'000);
  for (int n = 0; n < 10; ++n) axis.tick(order);
  order.command = AxisCommand::Torque;
  order.current = 40'000;  // 80 % active current is the rated torque
  order.speed_limit = 500'000;
  order.shaft_speed = 200'000;
  EXPECT_EQ(axis.tick(order).torque, 50'000);
  order.shaft_speed = 510'000;
  for (int n = 0; n < 10; ++n) axis.tick(order);
  EXPECT_LT(axis.state().torque, 0) << "beyond the limit it brakes";
}

TEST(Shaft, DrivenFromOutsideTheBrakeFallsInNearStandstill) {
  MachineData machine;
  machine.driven = true;
  Axis axis(machine);
  AxisOrder order = run_to(0, 1'000);
  order.shaft_speed = 1'500;
  for (int n = 0; n < 10; ++n) axis.tick(order);
  order.command = AxisCommand::Stop;
  for (int n = 0; n < 10; ++n) axis.tick(order);
  EXPECT_TRUE(axis.state().brake_released);
  order.shaft_speed = -900;
  for (int n = 0; n < 10; ++n) axis.tick(order);
  EXPECT_FALSE(axis.state().brake_released);
  EXPECT_EQ(axis.state().phase, AxisPhase::Off);
}

TEST(Shaft, RatedTorqueIsPowerByAngularSpeed) {
  EXPECT_NEAR(rated_torque({}), 1'500 / (2 * 3.14159265358979 * 1'400 / 60), 1e-9);
}

}  // namespace
}  // namespace ipos::runtime
