// The shaft as a physical interface: a partner that computes for itself and answers a millisecond later, as importers do.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

class Shaft {
 public:
  Shaft(const Resources& resources, Told& told) : resources_(resources), c_(resources.begin2(told)) {}
  ~Shaft() { fmi2FreeInstance(c_); }
  double get(const char* name) const {
    const unsigned reference = resources_.reference(name);
    double value = NAN;
    EXPECT_EQ(fmi2GetReal(c_, &reference, 1, &value), kOk);
    return value;
  }
  void set(const char* name, double value) const {
    const unsigned reference = resources_.reference(name);
    EXPECT_EQ(fmi2SetReal(c_, &reference, 1, &value), kOk);
  }
  void turn_on(const char* name) const {
    const unsigned reference = resources_.reference(name);
    const int on = 1;
    EXPECT_EQ(fmi2SetBoolean(c_, &reference, 1, &on), kOk);
  }
  void step(int ms) const { EXPECT_EQ(fmi2DoStep(c_, ms * 1e-3, 1e-3, 1), kOk); }

 private:
  const Resources& resources_;
  void* c_;
};

constexpr double kRated = 10.2314;  // Nm: 1.5 kW at 1400 rpm
// The rotor reaches 1500 rpm in 50 ms with rated torque; the load is four times that.
constexpr double kRotor = kRated * 0.05 / (1500 * 2 * std::numbers::pi / 60);

// Torque in, speed out: a second mass on a spring. Its swing about the drive that has stopped is that of a mass on a spring alone.
TEST(FmiShaft, ASpringOutsideKeepsItsEnergy) {
  const Resources resources(kTurning + "[station.load]\nfriction = 0\n");
  Told told;
  const Shaft drive(resources, told);
  drive.turn_on("u.DI01");
  const double stiffness = 20, inertia = 0.05;
  double angle = 0, speed = 0;
  const auto spring = [&] { return stiffness * (drive.get("u.shaft_angle") - angle); };
  int ms = 0;
  const auto run = [&](int until) {
    for (; ms < until; ++ms) {
      const double torque = spring();
      drive.set("u.load_torque", torque);
      speed += torque / inertia * 1e-3;
      angle += speed * 1e-3;
      drive.step(ms);
    }
  };
  run(1'500);  // the ramp is over: the shaft turns at 1000 rpm, and the mass swings about that
  const double turning = 1000 * 2 * std::numbers::pi / 60;
  EXPECT_NEAR(drive.get("u.shaft_speed"), turning, 1e-3);
  // Of the mass as it swings about the drive. With u the relative speed and s the stretch a step is u' = u + w^2 dt s, s' = s - dt u',
  // which keeps u^2 + w^2 s^2 + w^2 dt u s to the last digit: the closed form of the energy is a constant less k dt u s / 2, and that
  // is never more than the share w dt / 2 of it, here 20 rad/s x 0.5 ms = 1 %.
  struct Energy {
    double now, constant;
  };
  const auto energy = [&] {
    const double stretch = spring() / stiffness, relative = speed - turning;
    const double now = inertia * relative * relative / 2 + stiffness * stretch * stretch / 2;
    return Energy{now, now + stiffness * 1e-3 * relative * stretch / 2};
  };
  const double first = energy().constant;
  EXPECT_GT(first, 0.01);
  for (int n = 0; n < 100; ++n) {
    run(ms + 20);
    const Energy then = energy();
    EXPECT_NEAR(then.constant, first, first * 0.002) << ms;
    EXPECT_NEAR(then.now, first, first * 0.0105) << ms;
  }
}

// Speed in, torque out.
TEST(FmiShaft, AMassOutsideIsTakenToTheSpeed) {
  const Resources resources(kTurning + "[station.load]\ndriven = true\n");
  Told told;
  const Shaft drive(resources, told);
  drive.turn_on("u.DI01");
  const double inertia = kRotor * 5;  // as it is told by default
  double speed = 0, most = 0;
  for (int ms = 0; ms < 3'000; ++ms) {
    drive.set("u.shaft_speed", speed);
    const double torque = drive.get("u.torque") - (ms > 1'500 ? 4.0 : 0.0);
    drive.step(ms);
    speed += torque / inertia * 1e-3;
    most = std::max(most, speed);
  }
  EXPECT_NEAR(speed, 1000 * 2 * std::numbers::pi / 60, 0.05);
  EXPECT_LT(most, 1040 * 2 * std::numbers::pi / 60);
  EXPECT_NEAR(drive.get("u.torque"), 4, 0.05) << "what the mass asks for";
}

}  // namespace
}  // namespace ipos::tests
