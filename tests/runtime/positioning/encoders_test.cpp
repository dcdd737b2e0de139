// Encoders, zero pulses and touch probes.
#include "runtime/positioning/encoders.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

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

// Each source has its own number; another number for one of them is none for the others.
TEST(Encoders, EachHasItsOwnNumber) {
  PositioningSettings settings = factor(2, 1);
  settings.absolute_zero = 30;
  for (const auto source : {kMotor, kExternal, kAbsolute}) {
    Encoders encoders;
    encoders.configure(settings);
    encoders.count(1'001);
    encoders.set_position(source, -7);
    EXPECT_EQ(encoders.position(kMotor), source == kMotor ? -7 : 1'001);
    EXPECT_EQ(encoders.position(kExternal), source == kExternal ? -7 : 500);
    EXPECT_EQ(encoders.position(kAbsolute), source == kAbsolute ? -7 : 530);
    encoders.count(1'003);
    EXPECT_EQ(encoders.position(source), source == kMotor ? -5 : -6);
  }
}

// Power-on finds the incremental encoders at 0; the absolute one knows what the shaft was ever turned.
TEST(Encoders, PowerOnForgetsAllButTheAbsoluteOne) {
  PositioningSettings settings = factor(2, 1);
  settings.absolute_zero = 30;
  Encoders encoders;
  encoders.configure(settings);
  encoders.count(500);
  for (const auto source : {kMotor, kExternal, kAbsolute}) encoders.set_position(source, 9);
  encoders.power_on(10'000);
  EXPECT_EQ(encoders.counter(), 0);
  EXPECT_EQ(encoders.position(kMotor), 0);
  EXPECT_EQ(encoders.position(kExternal), 0);
  EXPECT_EQ(encoders.position(kAbsolute), 5'030);
  encoders.count(100);
  EXPECT_EQ(encoders.position(kMotor), 100);
  EXPECT_EQ(encoders.position(kExternal), 50);
  EXPECT_EQ(encoders.position(kAbsolute), 5'080);
}

// The pulse is the motor's; its place is told in the count of the source.
TEST(Encoders, ZeroPulsesHaveThePlaceOfTheirSource) {
  for (const bool inverted : {false, true}) {
    PositioningSettings settings = factor(4, 1);
    settings.absolute_inverted = inverted ? 1 : 0;
    settings.absolute_zero = 30;
    Encoders encoders;
    encoders.configure(settings);
    encoders.count(8'000);
    encoders.set_position(kExternal, 1'000);  // 2000 before
    encoders.count(8'200);
    EXPECT_EQ(encoders.zero_pulse(kMotor, 1), 8'192);
    EXPECT_EQ(encoders.zero_pulse(kExternal, 1), 1'048);
    EXPECT_EQ(encoders.zero_pulse(kAbsolute, 1), inverted ? 30 - 2'048 : 30 + 2'048);
    EXPECT_EQ(encoders.zero_pulse(kMotor, -1), std::nullopt);
    encoders.count(8'192);
    EXPECT_EQ(encoders.zero_pulse(kMotor, -1), 8'192) << "down to it";
    encoders.count(8'191);
    EXPECT_EQ(encoders.zero_pulse(kMotor, -1), std::nullopt) << "it was there already";
    encoders.count(8'192);
    EXPECT_EQ(encoders.zero_pulse(kMotor, 1), 8'192);
    encoders.count(8'193);
    EXPECT_EQ(encoders.zero_pulse(kMotor, 1), std::nullopt);
  }
}

// Inputs DI02 and DI03, rising and falling edges as they are wanted; nothing else is an edge.
TEST(TouchProbes, WantEachEdgeByItself) {
  for (const size_t n : {size_t{0}, size_t{1}})
    for (const bool rising : {false, true})
      for (const bool falling : {false, true}) {
        SCOPED_TRACE(testing::Message() << n << ' ' << rising << ' ' << falling);
        Encoders encoders;
        TouchProbes probes;
        probes.enable(n, rising, falling);
        const auto bit = static_cast<uint16_t>(1U << (2 + n));
        int32_t at = 0, want = 0;
        bool before = false;
        for (const bool level : {true, true, false, false, true, false}) {
          at += 1'000;
          encoders.count(at);
          probes.tick(static_cast<uint16_t>(level ? 0xFFFF : ~bit), encoders);
          if (std::exchange(before, level) != level && (level ? rising : falling)) want = at;
          EXPECT_EQ(probes.probe(n).motor, want);
          EXPECT_EQ(probes.probe(n).touched, want != 0);
          EXPECT_EQ(probes.probe(1 - n).motor, 0) << "the other one is off";
        }
      }
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

// Something else turns X14: H510 goes on from what it shows, counts every increment through the ends of the range, and the
// touch probe takes it. Left alone again it follows the motor from there.
TEST(Encoders, AnotherShaftAtX14) {
  Rig rig;
  const auto turn = [&](int64_t count) {
    rig.drive.set_encoders({runtime::wrapped(count), {}});
    rig.tick();
    return rig.h[510];
  };
  EXPECT_EQ(turn(INT32_MAX - 100), 0) << "what the other one has turned before is nothing";
  EXPECT_EQ(turn(int64_t{INT32_MAX} + 400), 500);
  EXPECT_EQ(turn(INT32_MAX - 1'000), -900);
  rig.positioner().touch_probes().enable(0, true, false);
  rig.run(2);
  rig.drive.set_inputs(kEnabled | 1U << 2);
  EXPECT_EQ(turn(INT32_MAX - 900), -800);
  EXPECT_EQ(rig.h[506], -800);
  EXPECT_EQ(rig.h[511], 0);
  rig.drive.set_encoders({});
  rig.run(2);
  EXPECT_EQ(rig.h[510], -800);
  rig.go(2'000);
  rig.run_until([&] { return rig.h[511] == 2'000; });
  EXPECT_EQ(rig.h[510], 1'200);
}

// A source of the position that the motor does not move: the axis cannot hold its place, and that is a lag error.
TEST(Encoders, PositionOfAnotherShaftIsALagError) {
  Rig rig({{"941", 1}, {"923", 1'000}});
  for (int count = 0; count <= 1'000; count += 100) {
    rig.drive.set_encoders({count, {}});
    rig.tick();
  }
  EXPECT_EQ(rig.drive.fault(), 0);
  rig.drive.set_encoders({1'200, {}});
  rig.run(3);
  EXPECT_EQ(rig.drive.fault(), 42);
}

}  // namespace
}  // namespace ipos::tests
