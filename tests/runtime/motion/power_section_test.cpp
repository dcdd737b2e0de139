// Currents, frequency, DC link, energy and temperatures against the formulas of docs/inside/motion.md, in floating
// point.
#include <gtest/gtest.h>

#include <cmath>

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

void run(Axis& axis, const AxisOrder& order, int ms) {
  for (int n = 0; n < ms; ++n) axis.tick(order);
}

TEST(PowerSection, RatedPointIsRatedCurrent) {
  Axis axis{{}};
  AxisOrder order = order_of(AxisCommand::Run, 1'400'000, 2'000);
  order.load_torque = 95'000;  // with 5 % friction: rated torque
  run(axis, order, 2'000);
  EXPECT_EQ(axis.state().torque, 100'000);
  EXPECT_EQ(axis.state().active_current, 80'000);
  EXPECT_EQ(axis.state().output_current, 100'000);
  EXPECT_EQ(axis.state().frequency, 50'000);  // 1400 rpm + 100 rpm slip on two pole pairs
}

TEST(PowerSection, CurrentsByPythagoras) {
  for (const int32_t load : {-80'000, -5'000, 0, 33'333, 120'000}) {
    Axis axis{{}};
    AxisOrder order = order_of(AxisCommand::Run, 600'000, 2'000);
    order.load_torque = load;
    run(axis, order, 1'000);
    const double active = (load + 5'000) * 0.8;
    EXPECT_NEAR(axis.state().active_current, active, 1);
    EXPECT_NEAR(axis.state().output_current, std::hypot(active, 60'000), 1.5);
  }
}

TEST(PowerSection, SlipMovesTheFrequency) {
  Axis axis{{}};
  AxisOrder order = order_of(AxisCommand::Run, 600'000, 2'000);
  run(axis, order, 1'000);
  EXPECT_NEAR(axis.state().frequency, (600'000 + 5'000) / 30.0, 1);
  order.load_torque = -65'000;  // driven by the load: 60 % braking
  run(axis, order, 1);
  EXPECT_NEAR(axis.state().frequency, (600'000 - 60'000) / 30.0, 1);
  EXPECT_EQ(axis.state().active_current, -48'000);
  run(axis, order_of(AxisCommand::Inhibit, 0, 0), 1);
  EXPECT_EQ(axis.state().frequency, 0);
}

// A motor that needs no magnetizing current, with 80 % active current a rated torque.
TEST(PowerSection, TheCurrentLimitIsATorque) {
  MachineData machine;
  machine.magnetizing_current = 0;
  PowerSection power{within_limits(machine)};
  for (const auto& [limit, torque] :
       {std::pair(0, 0), std::pair(-1, 0), std::pair(INT32_MIN, 0), std::pair(1, 1),
        std::pair(80'000, 100'000), std::pair(999'999, 1'249'998), std::pair(1'000'000, 1'250'000),
        std::pair(INT32_MAX, 1'250'000)})
    EXPECT_EQ(power.torque_limit(limit), torque) << limit;
}

// Direct current at standstill: what is below 0 counts as 0, and 10 x IN are the most.
TEST(PowerSection, DirectCurrentIsThatOfTheOrder) {
  struct Row {
    int32_t ordered, current;
  };
  for (const Row& row : {Row{INT32_MIN, 0}, Row{-1, 0}, Row{0, 0}, Row{1, 1}, Row{20'000, 20'000},
                         Row{INT32_MAX, 1'000'000}}) {
    PowerSection power{within_limits({})};
    power.step({Supply::DirectCurrent, 0, 50'000, 150'000, row.ordered});
    EXPECT_EQ(power.output_current(), row.current);
    EXPECT_EQ(power.active_current(), 0) << "it makes no torque";
  }
}

// The square of the voltage takes the braking energy: 1e10 mV² a millisecond at rated power, less losses of
// 20 % at IN (with the square of the current) and 1 % standby.
TEST(PowerSection, DcLinkRisesWhenBraking) {
  MachineData machine;
  machine.braking_resistor = false;
  Axis axis(machine);
  run(axis, order_of(AxisCommand::Run, 1'500'000, 2'000), 2'000);
  EXPECT_EQ(axis.state().dc_link, 560'000);
  const AxisOrder stop = order_of(AxisCommand::Stop, 0, 600);  // 5 rpm a millisecond: 83.3 %, friction helps
  double square = 560'000.0 * 560'000.0, most = 0;
  for (int n = 1; n <= 300; ++n) {
    const AxisState& state = axis.tick(stop);
    const double speed = 1'500'000 - 5'000.0 * n, torque = -(5'000 / 6'000.0 - 0.05);
    const double current = std::hypot(torque * 0.8, 0.6);
    const double power = torque * speed / 1'500'000 + 0.2 * current * current + 0.01;
    square = std::clamp(square - power * 1e10, 560'000.0 * 560'000.0, 1e12);
    ASSERT_NEAR(state.dc_link, std::sqrt(square), 100) << n;
    most = std::max<double>(most, state.dc_link);
  }
  EXPECT_GT(most, 900'000);
  run(axis, {}, 10'000);  // standby discharges it
  EXPECT_EQ(axis.state().dc_link, 560'000);
}

TEST(PowerSection, BrakingResistorHoldsTheDcLink) {
  Axis axis{{}};
  run(axis, order_of(AxisCommand::Run, 1'500'000, 2'000), 2'000);
  const AxisOrder stop = order_of(AxisCommand::Stop, 0, 600);
  int32_t most = 0;
  for (int n = 1; n <= 300; ++n) most = std::max(most, axis.tick(stop).dc_link);
  EXPECT_EQ(most, 780'000);
}

// Without mains the square of the voltage falls by what is taken: 100 V² a millisecond for the standby of 1 % alone, from
// 560 V to nothing in 3136 ms; nothing counts as drawn from the mains.
TEST(PowerSection, WithoutMainsTheDcLinkFallsByWhatIsTaken) {
  Axis axis{{}};
  run(axis, {}, 100);
  axis.set_mains(false);
  for (int ms = 0; ms < 3'200; ms += 100) {
    EXPECT_NEAR(axis.state().dc_link, 1'000 * std::sqrt(std::max(0.0, 313'600 - 100.0 * ms)), 30) << ms;
    run(axis, {}, 100);
  }
  EXPECT_EQ(axis.state().dc_link, 0);
  EXPECT_EQ(axis.state().energy, 0);
}

// Half the rated torque at rated speed, 50 % of the rated power: with losses of 20 % at IN and the standby.
TEST(PowerSection, WithoutMainsALoadTakesItsPowerFromTheDcLink) {
  Axis axis{{}};
  AxisOrder order = order_of(AxisCommand::Run, 1'500'000, 2'000);
  order.load_torque = 45'000;
  run(axis, order, 3'000);
  const int64_t drawn = axis.state().energy;
  axis.set_mains(false);
  const double power = 0.5 + 0.2 * (0.4 * 0.4 + 0.6 * 0.6) + 0.01;
  for (int ms = 1; ms <= 40; ++ms) {
    run(axis, order, 1);
    ASSERT_NEAR(axis.state().dc_link, 1'000 * std::sqrt(313'600 - power * 10'000 * ms), 30) << ms;
  }
  EXPECT_EQ(axis.state().energy, drawn);
}

// What a stop gives back goes into the DC link, and no mains hold it: the sum of n ms of (torque x speed) less losses.
TEST(PowerSection, WithoutMainsAStopFeedsTheDcLink) {
  Axis axis{{}};
  run(axis, order_of(AxisCommand::Run, 1'500'000, 1'000), 2'000);
  axis.set_mains(false);
  const AxisOrder stop = order_of(AxisCommand::Stop, 0, 1'500);  // 2 rpm a millisecond: a third of the torque, friction helps
  const double torque = -(1 / 3.0 - 0.05), current = std::hypot(torque * 0.8, 0.6);
  double square = 313'600;
  for (int n = 1; n <= 700; ++n) {
    const AxisState& state = axis.tick(stop);
    const double power = torque * (1'500 - 2.0 * n) / 1'500 + 0.2 * current * current + 0.01;
    square = std::min(square - power * 10'000, 780.0 * 780.0);
    ASSERT_NEAR(state.dc_link, 1'000 * std::sqrt(square), 100) << n;
  }
}

// A hundredth of the energy at mains a millisecond, ours.
TEST(PowerSection, WhenTheMainsComeBackTheDcLinkIsCharged) {
  for (const double from : {0.0, 0.5}) {
    Axis axis{{}};
    axis.set_mains(false);
    if (from == 0) axis.empty_dc_link();
    while (axis.state().dc_link > 560'000 * std::sqrt(from)) run(axis, {}, 1);
    const double square = std::pow(axis.state().dc_link / 1'000.0, 2);
    axis.set_mains(true);
    for (int ms = 1; ms <= 110; ++ms) {
      run(axis, {}, 1);
      ASSERT_NEAR(axis.state().dc_link, 1'000 * std::sqrt(std::min(313'600.0, square + 3'136.0 * ms)), 30) << ms;
    }
    EXPECT_EQ(axis.state().dc_link, 560'000);
  }
}

// Many milliseconds at once are the same as one after the other.
TEST(PowerSection, WithoutMainsMillisecondsAreLeftOutOnlyWhereNothingChanges) {
  Axis axis{{}}, other{{}};
  for (Axis* one : {&axis, &other}) {
    one->set_mains(false);
    one->empty_dc_link();
    run(*one, {}, 5);
  }
  axis.advance(10'000);
  run(other, {}, 10'000);
  EXPECT_TRUE(axis == other);
}

TEST(PowerSection, EnergyIsPowerTimesTime) {
  Axis axis{{}};
  AxisOrder order = order_of(AxisCommand::Run, 1'500'000, 2'000);
  order.load_torque = 45'000;  // 50 % with friction
  run(axis, order, 2'000);
  const int64_t before = axis.state().energy;
  run(axis, order, 60'000);
  const double current_square = 0.4 * 0.4 + 0.6 * 0.6;
  EXPECT_NEAR(static_cast<double>(axis.state().energy - before), 60 * 1'500 * (0.5 + 0.2 * current_square),
              5);
  const int64_t standing = axis.state().energy;
  run(axis, {}, 100'000);
  EXPECT_EQ(axis.state().energy, standing);
}

// I² with a time constant of 50 s and 125 % IN as continuous current: 150 % IN are reached cold after
// 50 s x ln(1.44 / 0.44) = 59.3 s, near the 60 s that such inverters allow.
TEST(PowerSection, UtilizationReaches100PercentAfterAMinuteOfOverload) {
  Axis axis{{}};
  AxisOrder order = order_of(AxisCommand::HoldZero, 0, 0);
  order.current_limit = 150'000;
  order.load_torque = 171'825 - 20;  // sqrt(150² - 60²) / 0.8
  int ms = 0;
  while (axis.state().utilization < 100'000 && ms < 100'000) run(axis, order, 1), ++ms;
  EXPECT_NEAR(axis.state().output_current, 150'000, 40);
  EXPECT_NEAR(ms, 50'000 * std::log(1.44 / 0.44), 100);
}

TEST(PowerSection, MotorAndHeatSinkWarmUp) {
  Axis axis{{}};
  EXPECT_EQ(axis.state().heat_sink, 25);
  AxisOrder order = order_of(AxisCommand::HoldZero, 0, 0);
  order.load_torque = 100'000;  // IN
  run(axis, order, 300'000);
  EXPECT_NEAR(axis.state().heat_sink, 25 + 40 * (1 - std::exp(-1.0)), 1);
  EXPECT_NEAR(axis.state().motor_utilization, 100'000 * (1 - std::exp(-0.25)), 100);
  run(axis, order, 4'000'000);
  EXPECT_NEAR(axis.state().heat_sink, 65, 1);
  EXPECT_NEAR(axis.state().utilization, 64'000, 50);  // (100 / 125)²
  run(axis, {}, 3'000'000);
  EXPECT_EQ(axis.state().heat_sink, 25);
}

// However small the heat sink is: 1000 K above the surroundings.
TEST(PowerSection, TheHeatSinkHasAnEnd) {
  MachineData machine;
  machine.heat_sink_rise = 200;
  machine.heat_sink_time_ms = 1;
  Axis axis{machine};
  AxisOrder order = order_of(AxisCommand::HoldZero, 0, 0);
  order.current_limit = 300'000;
  order.load_torque = 300'000;  // about 250 % IN, which would be 1200 K
  run(axis, order, 100);
  EXPECT_EQ(axis.state().heat_sink, 1025);
}

}  // namespace
}  // namespace ipos::runtime
