// control = "real" against closed forms that are calculated here: slip by Kloss's curve, stall and field weakening, the step of
// a second-order loop, coasting and braking by direct current, the sag of a hoist, two masses. docs/reference/physics.md has the errors.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/motion/axis.hpp"
#include "runtime/motion/load_torque.hpp"
#include "runtime/motion/motor.hpp"

namespace ipos::runtime {
namespace {

constexpr double kPi = 3.14159265358979323846;

// 1.5 kW, 1410 rpm, on a unit of 4 A; 10.16 Nm, breakdown torque 2.6 times that.
constexpr Nameplate kPlate{1'500, 400, 50, 3.6, 1'410, 0.78, 0.0034};
const double kTorque = 1'500 / (2 * kPi * 1'410 / 60);

MachineData plate_machine() {
  MachineData m;
  fit_motor(m, kPlate);
  m.real = true;
  m.friction = 0;
  return m;
}

AxisOrder ramp_to(int32_t target, uint32_t ms = 0) {
  AxisOrder order;
  order.command = AxisCommand::Run;
  order.target = target;
  order.ramp = {ms, ms, ms, ms, 0};
  order.stop_ramp_ms = ms;
  return order;
}

const AxisState& after(Axis& axis, const AxisOrder& order, int ms) {
  for (int n = 0; n < ms; ++n) axis.step(order);
  return axis.state();
}

// Slip in rpm of a torque (shares of the rated one) at a flux: T = 2 K f² / (s/k + k/s), through 90 rpm at T = 1.
double kloss(double torque, double flux = 1) {
  const double k = 2.6, at_breakdown = 90 * (k + std::sqrt(k * k - 1));
  const double share = k * flux * flux / torque;
  return at_breakdown * (share - std::sqrt(share * share - 1));
}

TEST(Nameplate, BecomesTheFiguresOfTheModel) {
  const MachineData m = plate_machine();
  EXPECT_EQ(m.pole_pairs, 2);
  EXPECT_EQ(m.rated_speed, 1'500'000);
  EXPECT_EQ(m.rated_slip, 90'000);
  EXPECT_EQ(m.unit_current, 4'000);
  EXPECT_NEAR(rated_torque(m), kTorque, 1e-9);
  // Of 4 A: 3.6 A x 0.78, and the rest to a right angle.
  EXPECT_NEAR(m.rated_active_current, 3.6 * 0.78 / 4 * 1e5, 1);
  EXPECT_NEAR(m.magnetizing_current, 3.6 * std::sqrt(1 - 0.78 * 0.78) / 4 * 1e5, 1);
  EXPECT_NEAR(m.run_up_us, 0.0034 * 5 * 50 * kPi / kTorque * 1e6, 1);  // with a load of four rotors
  EXPECT_EQ((Nameplate{.frequency = 50, .speed = 2'850}.pole_pairs()), 1);
  EXPECT_EQ((Nameplate{.frequency = 50, .speed = 930}.pole_pairs()), 3);
  EXPECT_EQ((Nameplate{.frequency = 60, .speed = 1'740}.synchronous()), 1'800);
}

TEST(Nameplate, OnAnotherUnitTheSharesAreOthers) {
  MachineData m = plate_machine();
  fit_unit(m, 3'000, std::nullopt);
  EXPECT_EQ(m.unit_current, 7'000);
  EXPECT_NEAR(m.rated_active_current, 3.6 * 0.78 / 7 * 1e5, 2);
  fit_unit(m, std::nullopt, 3.6);
  EXPECT_NEAR(std::hypot(m.rated_active_current, m.magnetizing_current), 1e5, 3);
}

TEST(MotorTypes, EachIsPossible) {
  for (const MotorType& type : motor_types()) {
    SCOPED_TRACE(type.name);
    EXPECT_EQ(type.plate.pole_pairs(), 2);
    EXPECT_GT(type.plate.efficiency(), 0.6);
    EXPECT_LT(type.plate.efficiency(), 0.96);
    MachineData m;
    fit_motor(m, type.plate);
    EXPECT_EQ(within_limits(m), m);
    EXPECT_GE(m.unit_current, type.plate.current * 990);
  }
}

TEST(Voltage, SpeedSagsBySlipAndCurrentIsOfTheLoad) {
  for (const double load : {0.1, 0.25, 0.5, 1.0, 1.4, -0.5, -1.0})
    for (const int32_t target : {300'000, 1'000'000, 1'500'000}) {
      SCOPED_TRACE(load);
      Axis axis(plate_machine());
      AxisOrder order = ramp_to(target, 1'000);
      order.load_torque = static_cast<int32_t>(load * 1e5);
      const AxisState& state = after(axis, order, 4'000);
      const double slip = std::copysign(kloss(std::abs(load)), load);
      EXPECT_NEAR(state.speed, target - 1e3 * slip, 20);
      EXPECT_NEAR(state.frequency, target / 30.0, 2);  // the field keeps the setpoint
      EXPECT_NEAR(state.active_current, load * 3.6 * 0.78 / 4 * 1e5, 20);
      EXPECT_NEAR(state.output_current, std::hypot(load * 0.78, std::sqrt(1 - 0.78 * 0.78)) * 3.6 / 4 * 1e5, 20);
    }
}

TEST(Voltage, SlipCompensationTakesTheSagAway) {
  Axis axis(plate_machine());
  AxisOrder order = ramp_to(1'000'000, 1'000);
  order.load_torque = 100'000;
  order.control.slip_compensation = 90'000;
  EXPECT_NEAR(after(axis, order, 5'000).speed, 1'000'000, 50);
  EXPECT_NEAR(axis.state().frequency, 1'090'000 / 30, 3);
  order.control.slip_compensation = 45'000;
  EXPECT_NEAR(after(axis, order, 5'000).speed, 955'000, 50);
}

// Of the tangent at slip 0: the speed of a shaft that is loaded by a step sags with the time constant J / (dT/ds). With 20 %
// torque the curve bends by 0.4 %.
TEST(Voltage, SagsWithTheTimeConstantOfItsCurve) {
  Axis axis(plate_machine());
  AxisOrder order = ramp_to(1'000'000, 500);
  after(axis, order, 3'000);
  order.load_torque = 20'000;
  const double steady = kloss(0.2) * 1e3;
  const double time = steady / 0.2 * (0.0034 * 5 / kTorque) * (2 * kPi / 60 / 1e3) * 1e3;  // ms
  for (int n = 1; n <= 60; ++n)
    ASSERT_NEAR(1'000'000 - after(axis, order, 1).speed, steady * (1 - std::exp(-n / time)), steady * 0.01) << n;
}

TEST(Voltage, CurrentLimitStallsTheMotor) {
  Axis axis(plate_machine());
  AxisOrder order = ramp_to(1'000'000, 500);
  after(axis, order, 2'000);
  order.load_torque = 250'000;
  order.current_limit = 150'000;
  const double active = std::sqrt(1.5 * 1.5 - std::pow(3.6 / 4, 2) * (1 - 0.78 * 0.78));
  const double torque = active / (3.6 / 4 * 0.78);
  EXPECT_LT(torque, 2.5);
  after(axis, order, 100);
  EXPECT_TRUE(axis.state().current_limited);
  EXPECT_NEAR(axis.state().torque, torque * 1e5, 50);
  EXPECT_NEAR(axis.state().output_current, 150'000, 50);
  // What the load has more slows it down.
  const int32_t before = axis.state().speed;
  const double slope = (2.5 - torque) * kTorque / (0.0034 * 5) * 60 / (2 * kPi);  // rpm / s
  EXPECT_NEAR(before - after(axis, order, 50).speed, slope * 0.05 * 1e3, slope * 0.05 * 1e3 * 0.01);
  EXPECT_FALSE(axis.overcurrent());
  // The load goes: it comes back to its setpoint.
  order.load_torque = 0;
  EXPECT_NEAR(after(axis, order, 3'000).speed, 1'000'000, 20);
}

TEST(Voltage, FieldWeakensAboveTheRatedFrequency) {
  for (const double times : {1.2, 1.5, 2.0}) {
    Axis axis(plate_machine());
    AxisOrder order = ramp_to(static_cast<int32_t>(1'500'000 * times), 2'000);
    order.load_torque = 30'000;
    const AxisState& state = after(axis, order, 8'000);
    const double flux = 1 / times;
    EXPECT_NEAR(state.speed, 1'500'000 * times - 1e3 * kloss(0.3, flux), 200) << times;
    EXPECT_NEAR(state.output_current,
                std::hypot(0.3 * 0.78 / flux, std::sqrt(1 - 0.78 * 0.78) * flux) * 3.6 / 4 * 1e5, 100) << times;
  }
  // Twice the frequency leaves a quarter of the breakdown torque: 65 %.
  Axis axis(plate_machine());
  AxisOrder order = ramp_to(3'000'000, 2'000);
  after(axis, order, 8'000);
  order.load_torque = 70'000;
  after(axis, order, 3'000);
  EXPECT_TRUE(axis.state().current_limited);
  EXPECT_LT(axis.state().speed, 2'600'000);
}

// Without automatic adjustment the stator's resistance takes its part of the voltage; IxR compensation gives it back.
TEST(Voltage, WithoutCompensationTheFluxIsWeakAtLowSpeed) {
  const auto loaded = [](bool adjusted, int32_t boost, int32_t ixr) {
    Axis axis(plate_machine());
    AxisOrder order = ramp_to(150'000, 100);
    order.control.adjusted = adjusted;
    order.control.boost = boost;
    order.control.ixr = ixr;
    order.load_torque = 30'000;
    return after(axis, order, 5'000).speed;
  };
  const int32_t full = loaded(true, 0, 0);
  EXPECT_NEAR(full, 150'000 - 1e3 * kloss(0.3), 20);
  EXPECT_NEAR(loaded(false, 100'000, 100'000), full, 20);
  EXPECT_LT(loaded(false, 0, 100'000), full - 5'000);
  EXPECT_LT(loaded(false, 0, 0), loaded(false, 0, 100'000));
}

TEST(Voltage, StartsAndStopsAtItsStartSpeed) {
  Axis axis(plate_machine());
  AxisOrder order = ramp_to(600'000, 2'000);  // 1.5 rpm a ms
  order.control.start_stop = 60'000;
  EXPECT_EQ(after(axis, order, 1).setpoint, 60'000);
  EXPECT_EQ(after(axis, order, 1).setpoint, 60'000 + 1'500);
  after(axis, order, 3'000);
  order.command = AxisCommand::Stop;
  int n = 0;
  while (axis.state().setpoint != 0 && n < 1'000) after(axis, order, 1), ++n;
  EXPECT_NEAR(n, (600 - 60) / 1.5, 1);
  EXPECT_GT(axis.state().speed, 0);
}

TEST(Voltage, ATurningMotorIsAnOvercurrentUnlessItIsCaught) {
  const auto enabled = [](int32_t speed, bool flying) {
    MachineData m = plate_machine();
    m.brake = false;
    Axis axis(m);
    AxisOrder order = ramp_to(speed, 500);
    order.control.flying_start = flying;
    after(axis, order, 2'000);
    after(axis, {}, 10);
    const int32_t before = axis.speed();
    bool over = false;
    int32_t least = before;
    for (int ms = 0; ms < 200; ++ms) {
      axis.step(order);
      over |= axis.overcurrent();
      least = std::min(least, axis.speed());
    }
    return std::pair(over, before - least);
  };
  EXPECT_TRUE(enabled(1'400'000, false).first);
  EXPECT_FALSE(enabled(1'400'000, true).first);
  EXPECT_LT(enabled(1'400'000, true).second, 10'000);
  EXPECT_FALSE(enabled(300'000, false).first);  // within reach of the limiter
  EXPECT_GT(enabled(300'000, false).second, 100'000);
}

// J dn/dt = -2 K / (n/k + k/n): t = J / (2 K) x (n² / 2k + k ln(n / n1)).
TEST(Voltage, DirectCurrentBrakesByTheCurve) {
  MachineData m = plate_machine();
  m.brake = false;
  Axis axis(m);
  AxisOrder order = ramp_to(1'400'000, 1'000);
  order.control.dc_braking = true;
  order.current_limit = 120'000;
  after(axis, order, 3'000);
  const double begin = axis.speed() / 1e3;
  order.command = AxisCommand::Stop;
  int n = 0;
  while (axis.speed() > 100'000 && n < 10'000) after(axis, order, 1), ++n;
  const double end = axis.speed() / 1e3, k = 90 * (2.6 + std::sqrt(2.6 * 2.6 - 1));
  const double per_second = kTorque / (0.0034 * 5) * 60 / (2 * kPi);  // rpm, by rated torque
  const double time = 1e3 / per_second / (2 * 2.6) * ((begin * begin - end * end) / (2 * k) + k * std::log(begin / end));
  EXPECT_NEAR(n, time, time * 0.02);
  EXPECT_EQ(axis.state().output_current, 120'000);
}

// A step of a loop of second order with a zero: proportional part P200 / (2 % of 1500 rpm), integral part with P201, inertia.
TEST(Encoder, AStepIsTheClosedForm) {
  for (const auto& [gain, time_us, inertia] :
       {std::tuple{2'000, 10'000, 400}, {500, 10'000, 400}, {1'000, 100'000, 400}, {2'000, 10'000, 0}, {4'000, 3'000, 100}}) {
    SCOPED_TRACE(gain);
    MachineData m = plate_machine();
    m.run_up_us = static_cast<int32_t>(int64_t{m.run_up_us} * (100 + inertia) / 500);
    Axis axis(m);
    AxisOrder order = ramp_to(0);
    order.command = AxisCommand::Follow;
    order.control.encoder = true;
    order.control.gain = gain;
    order.control.time_us = time_us;
    after(axis, order, 10);
    constexpr int32_t kStep = 10'000;  // far from the limit
    order.target = kStep;
    const double per_ms = kTorque / (0.0034 * (100 + inertia) / 100) * 60 / (2 * kPi) / 1e3;  // rpm, by rated torque
    const double p = gain / 1e3 / 30 * per_ms, q = p * 1e3 / time_us;  // x'' + p x' + q x = 0
    const double disc = p * p / 4 - q;
    for (int n = 1; n <= 60; ++n) {
      // x(0) = -1, x'(0) = p; speed = step x (1 + x).
      double x;
      if (disc > 0) {
        const double r1 = -p / 2 + std::sqrt(disc), r2 = -p / 2 - std::sqrt(disc);
        const double c = (p + r2) / (r1 - r2);
        x = c * std::exp(r1 * n) - (1 + c) * std::exp(r2 * n);
      } else {
        const double w = std::sqrt(-disc);
        x = std::exp(-p / 2 * n) * (-std::cos(w * n) + p / 2 / w * std::sin(w * n));
      }
      ASSERT_NEAR(after(axis, order, 1).speed, kStep * (1 + x), kStep * 0.002) << n;
    }
  }
}

// The loop of the plate machine with four rotors of load, in rpm and ms: p of the proportional part, q of the integral part.
struct Loop {
  explicit Loop(const ControlOrder& control) {
    const double per_ms = kTorque / (0.0034 * 5) * 60 / (2 * kPi) / 1e3;  // rpm, by rated torque
    p = control.gain / 1e3 / 30 * per_ms;
    q = p * 1e3 / control.time_us;
  }
  double p, q;
};

// When a ramp of A rpm a millisecond begins, a loop with p² > 4 q lags by A (e^-r1 t - e^-r2 t) / (r2 - r1); P202 gives its
// share beforehand. The setpoint goes in steps, in the mean half of one ahead of the ramp, and the loop follows that, too.
TEST(Encoder, PrecontrolTakesTheLagOfARamp) {
  for (const double share : {0.0, 0.5, 1.0, 1.5}) {
    SCOPED_TRACE(share);
    Axis axis(plate_machine());
    AxisOrder order = ramp_to(0, 2'000);
    order.control.encoder = true;
    order.control.gain = 500;
    order.control.time_us = 100'000;
    order.control.precontrol = static_cast<int32_t>(share * 1e3);
    after(axis, order, 10);
    order.target = 1'200'000;
    constexpr double kRise = 1.5;  // of 3000 rpm in 2 s
    const Loop loop(order.control);
    const double root = std::sqrt(loop.p * loop.p / 4 - loop.q), r1 = loop.p / 2 - root, r2 = loop.p / 2 + root;
    for (int n = 1; n <= 300; ++n) {
      const double lag = (std::exp(-r1 * n) - std::exp(-r2 * n)) / (r2 - r1);
      const double c = (loop.p - r2) / (r2 - r1), step = 1 + c * std::exp(-r1 * n) - (1 + c) * std::exp(-r2 * n);
      const AxisState& state = after(axis, order, 1);
      ASSERT_NEAR((state.setpoint - state.speed) / 1e3, (1 - share) * kRise * lag - kRise / 2 * step, 0.05) << n;
    }
  }
}

// The same equations in steps of a microsecond: v' = p (s - m) + i + u, i' = q (s - m), m' = (v - m) / P204,
// u' = (P202 s' - u) / P203.
TEST(Encoder, FiltersAreFirstOrder) {
  struct Row {
    int32_t precontrol, precontrol_us, filter_us;
  };
  for (const Row& row : {Row{0, 0, 1'000}, Row{0, 0, 4'000}, Row{0, 0, 10'000}, Row{1'000, 20'000, 0}, Row{800, 5'000, 3'000}})
    for (const bool ramp : {false, true}) {
      SCOPED_TRACE(row.filter_us);
      Axis axis(plate_machine());
      AxisOrder order = ramp_to(0);
      order.command = AxisCommand::Follow;
      order.control.encoder = true;
      order.control.gain = 1'000;
      order.control.time_us = 40'000;
      order.control.precontrol = ramp ? row.precontrol : 0;
      order.control.precontrol_us = row.precontrol_us;
      order.control.filter_us = row.filter_us;
      after(axis, order, 10);
      const Loop loop(order.control);
      constexpr int kParts = 1'000;
      double v = 0, m = 0, i = 0, u = 0, before = 0;
      for (int n = 1; n <= 150; ++n) {
        const double s = ramp ? n * 1.0 : 10;
        order.target = static_cast<int32_t>(s * 1e3);
        const double wanted = order.control.precontrol / 1e3 * (s - before);
        before = s;
        for (int part = 0; part < kParts; ++part) {
          const double seen = row.filter_us == 0 ? v : m, at = v;
          v += (loop.p * (s - seen) + i + u) / kParts;
          i += loop.q * (s - seen) / kParts;
          if (row.filter_us != 0) m += (at - m) / (row.filter_us / 1e3) / kParts;
          u = row.precontrol_us == 0 ? wanted : u + (wanted - u) / (row.precontrol_us / 1e3) / kParts;
        }
        ASSERT_NEAR(after(axis, order, 1).speed / 1e3, v, 0.05) << n;
      }
    }
}

TEST(Encoder, LoadPrecontrolHoldsAtTheStart) {
  const auto sag = [](int32_t percent_of_load) {
    const MachineData m = plate_machine();
    Axis axis(m);
    AxisOrder order = ramp_to(0);
    order.control.encoder = true;
    order.control.time_us = 40'000;
    order.control.load_precontrol = m.rated_active_current / 2 * percent_of_load / 100;
    order.load_torque = 50'000;
    order.premagnetize_ms = 50;
    int32_t least = 0;
    for (int n = 0; n < 500; ++n) least = std::min(least, after(axis, order, 1).speed);
    return -least;
  };
  // By a step of load a loop with p² > 4 q sags by A (e^-r1 t - e^-r2 t) / (r2 - r1) at most, A half of the rated torque.
  ControlOrder control;
  control.time_us = 40'000;
  const Loop loop(control);
  const double root = std::sqrt(loop.p * loop.p / 4 - loop.q), r1 = loop.p / 2 - root, r2 = loop.p / 2 + root;
  const double at = std::log(r2 / r1) / (r2 - r1), rated = kTorque / (0.0034 * 5) * 60 / (2 * kPi) / 1e3;
  const double most = 0.5 * rated * (std::exp(-r1 * at) - std::exp(-r2 * at)) / (r2 - r1) * 1e3;
  EXPECT_NEAR(sag(0), most, most * 0.05);
  EXPECT_NEAR(sag(50), most / 2, most * 0.05);
  EXPECT_LT(sag(100), most * 0.01);
}

TEST(Encoder, ALoadSagsAndComesBack) {
  Axis axis(plate_machine());
  AxisOrder order = ramp_to(1'000'000, 500);
  order.control.encoder = true;
  after(axis, order, 2'000);
  EXPECT_NEAR(axis.speed(), 1'000'000, 2);
  order.load_torque = 100'000;
  int32_t least = axis.speed();
  for (int n = 0; n < 300; ++n) least = std::min(least, after(axis, order, 1).speed);
  EXPECT_LT(least, 1'000'000 - 2'000);
  EXPECT_NEAR(axis.speed(), 1'000'000, 5);
  EXPECT_NEAR(axis.state().torque, 100'000, 20);
  order.command = AxisCommand::Stop;
  after(axis, order, 2'000);
  EXPECT_EQ(axis.phase(), AxisPhase::Off);
}

// With the brake applied too late the load falls freely: s = a t² / 2.
TEST(RealBrake, AppliedTooLateTheLoadSags) {
  const auto sag = [](uint16_t waits, int32_t takes) {
    MachineData m = plate_machine();
    m.brake_apply_ms = takes;
    Axis axis(m);
    AxisOrder order = ramp_to(0);
    order.control.encoder = true;
    order.load_torque = 50'000;
    order.brake_apply_ms = waits;
    after(axis, order, 1'000);
    order.command = AxisCommand::Stop;
    const int32_t from = axis.position();
    after(axis, order, 1'000);
    EXPECT_EQ(axis.speed(), 0);
    return from - axis.position();
  };
  EXPECT_NEAR(sag(200, 200), 0, 1);
  EXPECT_NEAR(sag(250, 200), 0, 1);
  // 100 ms free, then the brake of 200 % takes the speed away with 150 %: s = a t² / 2 x (1 + 1/3).
  const double turns = 0.5 * kTorque / (0.0034 * 5) * 0.1 * 0.1 / 2 * (1 + 1.0 / 3) / (2 * kPi);
  EXPECT_NEAR(sag(100, 200), turns * 4'096, turns * 4'096 * 0.03 + 2);
  EXPECT_GT(sag(0, 200), sag(100, 200));
}

TEST(RealBrake, HoldsUntilItIsReleased) {
  MachineData m = plate_machine();
  m.brake_release_ms = 80;
  Axis axis(m);
  AxisOrder order = ramp_to(600'000, 500);
  order.control.encoder = true;
  after(axis, order, 79);
  EXPECT_EQ(axis.position(), 0);
  EXPECT_GT(axis.state().torque, 10'000);  // it works against the brake
  after(axis, order, 30);
  EXPECT_GT(axis.position(), 0);
}

// The torque of the last stop is there before the brake opens.
TEST(RealBrake, AHoistRemembersItsTorque) {
  const auto sag = [](bool hoist) {
    Axis axis(plate_machine());
    AxisOrder order = ramp_to(0);
    order.control.encoder = true;
    order.control.hoist = hoist;
    order.load_torque = 80'000;
    order.brake_apply_ms = 100;
    order.premagnetize_ms = 50;
    after(axis, order, 1'000);
    order.command = AxisCommand::Stop;
    after(axis, order, 500);
    const int32_t from = axis.position();
    order.command = AxisCommand::Run;
    int32_t least = from;
    for (int n = 0; n < 500; ++n) least = std::min(least, after(axis, order, 1).position);
    return from - least;
  };
  EXPECT_NEAR(sag(true), 0, 1);
  EXPECT_GT(sag(false), 5);
}

double torque_at(const MachineData& m, FineSpeed speed, int32_t place) {
  return static_cast<double>(load_torque(m, speed, place));
}

TEST(LoadShape, SquareAndSine) {
  for (uint32_t n = 0; n < 4'096; ++n)
    ASSERT_NEAR(static_cast<double>(sine(n << 20)), std::sin(2 * kPi * n / 4'096) * (1 << 20), 12) << n;
  MachineData m = plate_machine();
  m.load_torque = 40'000;
  m.load_shape = LoadShape::BySpeed;
  EXPECT_NEAR(torque_at(m, fine_speed(1'410'000), 0), 40'000, 2);
  EXPECT_NEAR(torque_at(m, fine_speed(705'000), 0), 10'000, 2);
  EXPECT_NEAR(torque_at(m, fine_speed(-705'000), 0), -10'000, 2);
  m.load_shape = LoadShape::ByPosition;
  EXPECT_NEAR(torque_at(m, 0, 1'024), 40'000, 2);
  EXPECT_NEAR(torque_at(m, 0, -1'024), -40'000, 2);
  m.load_turns = 100;  // a gear of ten
  EXPECT_NEAR(torque_at(m, 0, 10'240), 40'000, 5);
}

// Coasting against a torque by the square of the speed: n = n0 / (1 + n0 c t).
TEST(LoadShape, AFanRunsDownByAHyperbola) {
  MachineData m = plate_machine();
  m.brake = false;
  m.load_torque = 50'000;
  m.load_shape = LoadShape::BySpeed;
  Axis axis(m);
  after(axis, ramp_to(1'400'000, 1'000), 4'000);
  const double begin = axis.speed() / 1e3;
  const double c = 0.5 / (1'410.0 * 1'410.0) * kTorque / (0.0034 * 5) * 60 / (2 * kPi);  // rpm / s per rpm²
  for (int n = 1; n <= 2'000; ++n) {
    axis.step({});
    ASSERT_NEAR(axis.speed() / 1e3, begin / (1 + begin * c * n / 1e3), begin * 0.003) << n;
  }
}

// The axis is enabled, and has this active current from the next millisecond on.
AxisOrder torque_jump(Axis& axis, int32_t current) {
  AxisOrder order = ramp_to(0);
  after(axis, order, 1);
  order.command = AxisCommand::Torque;
  order.speed_limit = 1'500'000;
  order.current = current;
  return order;
}

// A jump of torque on the first of two free masses: the mean speed goes up evenly, and the twist swings with
// w = sqrt(k (1/J1 + 1/J2)) about M J2 / (J1 + J2) / k.
TEST(SecondMass, TwoMassesSwingByTheClosedForm) {
  MachineData m = plate_machine();
  m.brake = false;
  m.run_up_us = static_cast<int32_t>(std::lround(0.0034 * 50 * kPi / kTorque * 1e6));  // the bare rotor
  m.second_inertia = 0.01;
  m.stiffness = 30;
  Axis axis(m);
  const AxisOrder order = torque_jump(axis, m.rated_active_current / 5);  // 20 % of the rated torque
  const double j1 = 0.0034, j2 = 0.01, torque = 0.2 * kTorque;
  const double w = std::sqrt(30 * (1 / j1 + 1 / j2));
  for (int n = 1; n <= 200; ++n) {
    const double t = n / 1e3;
    const double mean = torque / (j1 + j2) * t;
    const double swing = torque * j2 / (j1 * (j1 + j2)) / w * std::sin(w * t);
    const double rpm = (mean + swing) * 60 / (2 * kPi);
    ASSERT_NEAR(after(axis, order, 1).speed / 1e3, rpm, 0.02 * torque / (j1 + j2) * 0.2 * 60 / (2 * kPi)) << n;
  }
}

TEST(SecondMass, PlayIsWithoutTorque) {
  MachineData m = plate_machine();
  m.brake = false;
  m.second_inertia = 0.01;
  m.stiffness = 30;
  m.backlash = 0.5;
  Axis axis(m);
  const AxisOrder order = torque_jump(axis, m.rated_active_current / 10);
  // Within half of the play only the rotor and its load speed up.
  const double slope = 0.1 * kTorque / (0.0034 * 5);
  const int free = static_cast<int>(std::sqrt(2 * 0.25 / slope) * 1e3);
  for (int n = 1; n < free; ++n)
    ASSERT_NEAR(after(axis, order, 1).speed, slope * n / 1e3 * 60 / (2 * kPi) * 1e3, 30) << n;
  const int32_t then = axis.speed();
  after(axis, order, 60);
  EXPECT_LT(axis.speed() - then, slope * 0.06 * 60 / (2 * kPi) * 1e3 * 0.9);
}

}  // namespace
}  // namespace ipos::runtime
