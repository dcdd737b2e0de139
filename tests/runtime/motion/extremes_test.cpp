// Orders and machines of any 32-bit values, under UBSan: no overflow, and the state stays within its bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/runtime/motion/order_mix.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

void check(const AxisState& state, const AxisOrder& order) {
  ASSERT_LE(std::abs(int64_t{state.speed}), kTopSpeed);
  ASSERT_LE(std::abs(int64_t{state.setpoint}), kTopSpeed);
  ASSERT_LE(std::abs(int64_t{state.torque}), kTopTorque);
  ASSERT_GE(state.output_current, std::abs(int64_t{state.active_current}));
  if (state.phase != AxisPhase::StandstillCurrent) {
    ASSERT_LE(state.output_current, std::max(0, order.current_limit));
  }
  ASSERT_GE(state.dc_link, 1'000);
  ASSERT_LE(state.dc_link, kTopDcLink);
  ASSERT_GE(state.utilization, 0);
  ASSERT_GE(state.energy, 0);
  ASSERT_EQ(state.output_stage, state.phase != AxisPhase::Off);
  ASSERT_TRUE(state.output_stage || !state.brake_released);
}

TEST(Extremes, AnyOrdersOnTheDefaultMachine) {
  std::mt19937_64 random(21);
  Axis axis{{}};
  for (int round = 0; round < 20'000; ++round) {
    const AxisOrder order = draw_order(random, Taste::Any);
    if (random() % 50 == 0) axis.set_position(static_cast<int32_t>(random()));
    for (uint64_t n = 0; n <= random() % 20; ++n) {
      check(axis.tick(order), order);
      if (HasFatalFailure()) FAIL() << round;
    }
  }
}

TEST(Extremes, AnyMachines) {
  std::mt19937_64 random(22);
  for (int round = 0; round < 2'000; ++round) {
    Axis axis(draw_machine(random, Taste::Any));
    for (int orders = 0; orders < 10; ++orders) {
      const AxisOrder order = draw_order(random, Taste::Any);
      for (uint64_t n = 0; n <= random() % 30; ++n) {
        check(axis.tick(order), order);
        if (HasFatalFailure()) FAIL() << round;
      }
    }
  }
}

// The table of docs/inside/motion.md: what lies beyond its limits counts as the limit, what lies within stays.
TEST(Extremes, EveryFigureOfTheMachineHasItsLimits) {
  struct Row {
    int32_t MachineData::*figure;
    int32_t least, most;
  };
  using M = MachineData;
  constexpr Row kRows[] = {
      {&M::ramp_reference, 1, 100'000'000},
      {&M::rated_speed, 1'000, 10'000'000},
      {&M::rated_slip, 0, 1'500'000},
      {&M::pole_pairs, 1, 50},
      {&M::rated_power, 1, 1'000'000},
      {&M::rated_active_current, 1'000, 1'000'000},
      {&M::magnetizing_current, 0, 1'000'000},
      {&M::rotor_run_up_ms, 1, 100'000},
      {&M::motor_heat_time_ms, 1, 10'000'000},
      {&M::inertia, 0, 100'000},
      {&M::friction, 0, 4'000'000},
      {&M::load_torque, -4'000'000, 4'000'000},
      {&M::brake_torque, 0, 4'000'000},
      {&M::dc_link, 1'000, 1'000'000},
      {&M::chopper_level, 560'000, 1'000'000},
      {&M::continuous_current, 1'000, 1'000'000},
      {&M::unit_heat_time_ms, 1, 10'000'000},
      {&M::ambient, -50, 100},
      {&M::heat_sink_rise, 0, 200},
      {&M::heat_sink_time_ms, 1, 10'000'000},
  };
  for (const auto& [figure, least, most] : kRows) {
    SCOPED_TRACE(testing::Message() << least << " to " << most);
    const auto limited = [figure = figure](int32_t value) {
      MachineData machine;
      machine.*figure = value;
      return within_limits(machine).*figure;
    };
    EXPECT_EQ(limited(least), least);
    EXPECT_EQ(limited(most), most);
    EXPECT_EQ(limited(least - 1), least);
    EXPECT_EQ(limited(most + 1), most);
    EXPECT_EQ(limited(INT32_MIN), least);
    EXPECT_EQ(limited(INT32_MAX), most);
  }
  EXPECT_EQ(within_limits({}), MachineData{});
}

TEST(Extremes, AllAtOneEnd) {
  for (const int32_t end : {INT32_MIN, INT32_MAX}) {
    MachineData machine;
    machine.load_torque = machine.inertia = machine.friction = machine.rated_speed = end;
    machine.rated_power = machine.brake_torque = machine.rated_active_current = end;
    machine.ramp_reference = end;
    Axis axis(machine);
    for (const AxisCommand command : {AxisCommand::Run, AxisCommand::Follow, AxisCommand::HoldZero,
                                      AxisCommand::Stop, AxisCommand::Inhibit})
      for (const uint32_t ms : {0U, 1U, 2'000'000U, UINT32_MAX})
        for (const int s : {0, 1, 3, 255}) {
          AxisOrder order;
          order.command = command;
          order.target = order.current_limit = order.load_torque = order.standstill_current = end;
          order.ramp = {ms, ms, ms, ms, static_cast<uint8_t>(s)};
          order.stop_ramp_ms = ms;
          for (int n = 0; n < 50; ++n) check(axis.tick(order), order);
        }
  }
}

TEST(Extremes, FallingLoadEndsAtTheTopSpeed) {
  MachineData machine;
  machine.load_torque = kTopTorque;
  machine.brake = false;
  Axis axis(machine);
  for (int n = 0; n < 100'000; ++n) axis.tick({});
  EXPECT_EQ(axis.state().speed, -kTopSpeed);
}

// The longest ramp a parameter can hold, cut short where it would take half an hour of test.
TEST(Extremes, LongestRampStartsAsItShould) {
  Axis axis{{}};
  AxisOrder order;
  order.command = AxisCommand::Run;
  order.target = 3'000'000;
  order.ramp = {2'000'000, 2'000'000, 2'000'000, 2'000'000, 0};
  for (int n = 1; n <= 100'001; ++n) axis.tick(order);
  EXPECT_EQ(axis.state().speed, std::lround(1.5 * 100'001));
}

}  // namespace
}  // namespace ipos::tests
