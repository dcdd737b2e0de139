// Encoders, zero pulses and touch probes.
#include "runtime/positioning/encoders.hpp"

#include <gtest/gtest.h>

#include <random>

#include "runtime/positioning/touch_probe.hpp"
#include "tests/runtime/positioning/rig.hpp"

namespace ipos::runtime {
namespace {

constexpr auto kMotor = PositionSource::Motor;
constexpr auto kExternal = PositionSource::External;
constexpr auto kAbsolute = PositionSource::Absolute;

PositioningSettings factor(int32_t numerator, int32_t denominator) {
  PositioningSettings settings;
  settings.factor_numerator = numerator;
  settings.factor_denominator = denominator;
  return settings;
}

// The definition, in one division.
int64_t rounded_speed(Rate rate, EncoderFactor factor) {
  const Wide value = Wide{rate} * 234'375 * factor.numerator;
  const Wide unit = (Wide{1} << 32) * factor.denominator;
  return static_cast<int64_t>((value + (value < 0 ? -unit : unit) / 2) / unit);
}

TEST(EncoderFactors, SpeedIsRoundedToTheNearest) {
  std::mt19937_64 random(1);
  constexpr int32_t kMost = 32'767;  // of P942 and P943
  const auto factor = [&] { return static_cast<int32_t>(random() % kMost) + 1; };
  for (int n = 0; n < 200'000; ++n) {
    const Rate rate = static_cast<Rate>(random()) >> random() % 64;
    for (const EncoderFactor f : {EncoderFactor{}, EncoderFactor{factor(), factor()}, EncoderFactor{kMost, 1},
                                  EncoderFactor{1, kMost}, EncoderFactor{kMost, kMost}})
      ASSERT_EQ(speed_of_rate(rate, f), rounded_speed(rate, f)) << rate << " " << f.numerator;
  }
  for (const Rate rate : {INT64_MIN, INT64_MAX}) {
    const EncoderFactor f{kMost, kMost};
    ASSERT_EQ(speed_of_rate(rate, f), rounded_speed(rate, f));
  }
}

TEST(Encoders, FactorIsMotorOverExternal) {
  Encoders encoders;
  encoders.configure(factor(5, 2));
  encoders.count(1'000);
  EXPECT_EQ(encoders.position(kMotor), 1'000);
  EXPECT_EQ(encoders.position(kExternal), 400);
  encoders.count(-1'001);
  EXPECT_EQ(encoders.position(kExternal), -401) << "counts down in whole increments";
}

TEST(Encoders, AbsoluteWithDirectionAndZeroOffset) {
  PositioningSettings settings = factor(1, 1);
  settings.absolute_inverted = 1;
  settings.absolute_zero = 50;
  Encoders encoders;
  encoders.configure(settings);
  encoders.count(200);
  EXPECT_EQ(encoders.position(kAbsolute), -150);
}

TEST(Encoders, TheCounterWraps) {
  Encoders encoders;
  encoders.recount(INT32_MAX - 5);
  encoders.set_position(kMotor, INT32_MAX - 5);
  encoders.count(INT32_MIN + 4);
  EXPECT_EQ(encoders.position(kMotor), INT32_MIN + 4);
  EXPECT_EQ(encoders.position(kExternal), 10);
}

TEST(Encoders, ZeroPulsesAtWholeTurns) {
  Encoders encoders;
  const auto pulse = [&](int32_t counter, int way) {
    encoders.count(counter);
    return encoders.zero_pulse(kMotor, way);
  };
  EXPECT_EQ(pulse(4'000, 1), std::nullopt);
  EXPECT_EQ(pulse(4'100, 1), 4'096);
  EXPECT_EQ(pulse(4'200, 1), std::nullopt);
  EXPECT_EQ(pulse(4'096, -1), 4'096);
  EXPECT_EQ(pulse(4'096, -1), std::nullopt) << "standing on it";
  EXPECT_EQ(pulse(10, -1), std::nullopt);
  EXPECT_EQ(pulse(-10, -1), 0);
  EXPECT_EQ(pulse(-4'097, -1), -4'096);
  // The pulse belongs to the shaft, not to the count.
  encoders.set_position(kMotor, 100);
  encoders.recount(100);
  EXPECT_EQ(pulse(102, 1), 101);
}

TEST(TouchProbes, StoreAllEncodersAtTheEdge) {
  Encoders encoders;
  encoders.configure(factor(2, 1));
  TouchProbes probes;
  constexpr uint16_t kDi02 = 1 << 2, kDi03 = 1 << 3;
  probes.enable(0, true, false);
  probes.enable(1, false, true);
  encoders.count(1'000);
  probes.tick(kDi02 | kDi03, encoders);
  EXPECT_EQ(probes.probe(0).motor, 1'000);
  EXPECT_EQ(probes.probe(0).external, 500);
  EXPECT_EQ(probes.probe(0).absolute, 500);
  EXPECT_TRUE(probes.probe(0).touched);
  EXPECT_FALSE(probes.probe(1).touched) << "a rising edge";
  encoders.count(2'000);
  probes.tick(0, encoders);
  EXPECT_EQ(probes.probe(0).motor, 1'000) << "a falling edge";
  EXPECT_EQ(probes.probe(1).motor, 2'000);
  encoders.count(3'000);
  probes.tick(kDi02, encoders);
  EXPECT_EQ(probes.probe(0).motor, 3'000) << "every edge until it is disabled";
  probes.enable(0, true, true);
  EXPECT_FALSE(probes.probe(0).touched);
  probes.enable(0, false, false);
  probes.tick(0, encoders);
  probes.tick(kDi02, encoders);
  EXPECT_EQ(probes.probe(0).motor, 3'000);
}

}  // namespace
}  // namespace ipos::runtime

namespace ipos::tests {
namespace {

TEST(TouchProbes, ShowInTheirVariables) {
  Rig rig({{"602", 16}, {"603", 1}, {"942", 4}});
  const uint16_t enabled = 0b10011;
  rig.drive.set_inputs(enabled);
  rig.positioner().touch_probes().enable(0, true, false);
  rig.positioner().touch_probes().enable(1, true, false);
  rig.go(50'000);
  rig.run(700);
  const int32_t at = rig.h[511];
  rig.drive.set_inputs(enabled | 1 << 2);
  rig.tick();
  EXPECT_EQ(rig.h[507], at);
  EXPECT_EQ(rig.h[506], at / 4);
  EXPECT_EQ(rig.h[503], at / 4);
  EXPECT_EQ(rig.h[505], 0);
  rig.drive.set_inputs(enabled | 1 << 3);
  const int32_t second = rig.h[511];
  rig.tick();
  EXPECT_EQ(rig.h[505], second);
  EXPECT_EQ(rig.h[504], second / 4);
  EXPECT_EQ(rig.h[502], second / 4);
}

}  // namespace
}  // namespace ipos::tests
