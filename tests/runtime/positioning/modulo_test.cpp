// The modulo function (IPOSplus p. 29, 76, 81).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/positioning/modulo.hpp"
#include "tests/runtime/positioning/closed_form.hpp"
#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Modulo;

// A turn of the output is 10 turns of the motor: 40960 increments.
struct ModuloRig : Rig {
  explicit ModuloRig(int32_t mode, Settings more = {})
      : Rig({{"960", mode}, {"961", 10}, {"962", 1}, {"963", 4096}, {"911", 300}, {"912", 300}}) {
    for (const auto& [number, value] : more) set(number, value);
    run(2);
  }
  // Increments travelled for this target.
  int64_t travel(int32_t target) {
    const int64_t from = mechanical;
    h[454] = target;
    run(1);
    run_to_target();
    return mechanical - from;
  }
};

TEST(Modulo, ShortestWay) {
  ModuloRig rig(1);
  EXPECT_EQ(rig.travel(0x4000), 10'240);  // to 90 degrees
  EXPECT_EQ(rig.h[455], 0x4000);
  EXPECT_EQ(rig.travel(0xF000), -12'800);  // back through 0
  EXPECT_EQ(rig.h[455], 0xF000);
  EXPECT_EQ(rig.h[456], -1);
  EXPECT_EQ(rig.travel(0x7000), 20'480);       // half a turn: CW
  EXPECT_EQ(rig.travel(0x30000 + 0x7000), 0);  // full turns do not count
}

TEST(Modulo, OneWayOnly) {
  ModuloRig cw(2);
  EXPECT_EQ(cw.travel(0x4000), 10'240);
  EXPECT_EQ(cw.travel(0), 30'720);
  EXPECT_EQ(cw.h[456], 1);
  EXPECT_EQ(cw.travel(0x10000), 40'960);  // a turn
  EXPECT_EQ(cw.h[454], 0) << "the full turns are taken when the travel begins";
  EXPECT_EQ(cw.travel(0x10000), 40'960);  // and another one
  EXPECT_EQ(cw.travel(0x30000 + 0x8000), 3 * 40'960 + 20'480);
  ModuloRig ccw(3);
  EXPECT_EQ(ccw.travel(0x4000), -30'720);
  EXPECT_EQ(ccw.travel(0x10000 + 0x4000), -40'960);
  EXPECT_EQ(ccw.travel(0), -10'240);
}

TEST(Modulo, OneWayOnlyWhileMoving) {
  ModuloRig rig(2);
  rig.h[454] = 0x8000;
  rig.run(200);
  ASSERT_GT(rig.drive.axis().speed, 100'000);
  // Just passed: it goes round, never back.
  rig.h[454] = rig.h[455] + 16;
  while (!rig.arrived()) {
    rig.tick();
    ASSERT_GE(rig.drive.axis().speed, -20'000);
  }
  EXPECT_GT(rig.mechanical, 40'960);
}

// IPOSplus p. 81: the example of a gear ratio 113553 / 1088 with 4096 increments.
TEST(Modulo, AGearWithoutWholeIncrements) {
  ModuloRig rig(2, {{"961", 113'553}, {"962", 1'088}});
  const double turn = 113'553.0 * 4'096 / 1'088;
  EXPECT_NEAR(static_cast<double>(rig.travel(0x8000)), turn / 2, 1);
  for (int n = 1; n <= 5; ++n) {
    rig.travel(0x10000 + 0x8000);
    EXPECT_NEAR(static_cast<double>(rig.mechanical), (n + 0.5) * turn, 1) << "nothing drifts";
    EXPECT_NEAR(rig.h[455], 0x8000, 1);
    EXPECT_EQ(rig.h[456], n);
  }
}

TEST(Modulo, HighResolution) {
  ModuloRig rig(2, {{"962", 4}});
  rig.h[453] = 2;
  rig.run(2);
  EXPECT_EQ(rig.travel(20'480), 5'120);  // half of 10 x 4096 units, 4 of them an increment
  EXPECT_EQ(rig.h[455], 20'480);
  for (const int32_t turns : {1, 2, 7, 1'000})
    EXPECT_EQ(rig.travel(turns * 40'960 + 20'480), 0) << "no several turns (IPOSplus p. 29)";
}

TEST(Modulo, TooFineATurnIsOff) {
  Rig rig({{"960", 1}, {"961", 1'000'000}, {"963", 4'096}});
  EXPECT_EQ(rig.h[455], 0);
  EXPECT_TRUE(rig.said("2^31"));
}

// Whether it is wanted or not: such a turn counts as the function that is off, from the factory.
TEST(Modulo, AnImpossibleTurnIsAsWithoutTheFunction) {
  struct Turn {
    int32_t numerator, denominator, resolution;
  };
  for (const Turn& t : {Turn{0, 1, 1}, Turn{-5, 1, 4'096}, Turn{10, 0, 4'096}, Turn{10, -3, 4'096},
                        Turn{1'000'000, 1, 4'096}, Turn{INT32_MAX, 7, 65'535}})
    for (const int32_t mode : {0, 1, 2, 3}) {
      SCOPED_TRACE(testing::Message() << t.numerator << " / " << t.denominator << " x " << t.resolution);
      runtime::PositioningSettings settings;
      Modulo off;
      EXPECT_TRUE(off.configure(settings, -9'000));
      off.set(-9'000);
      settings.modulo = mode;
      settings.modulo_numerator = t.numerator;
      settings.modulo_denominator = t.denominator;
      settings.modulo_resolution = t.resolution;
      Modulo modulo;
      EXPECT_EQ(modulo.configure(settings, -9'000), mode == 0);
      EXPECT_FALSE(modulo.possible());
      for (const int32_t way : {8'000, 70'000, -200'000}) {
        modulo.move(way);
        off.move(way);
        EXPECT_FALSE(modulo.on());
        EXPECT_EQ(modulo.position(false), 0);
        EXPECT_EQ(modulo.turns(), off.turns());
      }
    }
}

// 2^31 - 1 units are the longest turn.
TEST(Modulo, TheLongestTurn) {
  runtime::PositioningSettings settings;
  settings.modulo = 1;
  settings.modulo_numerator = INT32_MAX;
  Modulo modulo;
  EXPECT_TRUE(modulo.configure(settings, -1));
  EXPECT_EQ(modulo.position(true), INT32_MAX - 1);
  settings.modulo_numerator = 1 << 30;
  settings.modulo_resolution = 2;
  EXPECT_FALSE(modulo.configure(settings, -1));
}

TEST(Modulo, WhileItIsOffThereIsNoModuloPosition) {
  runtime::PositioningSettings settings;
  settings.modulo_numerator = 10;
  settings.modulo_resolution = 4'096;
  Modulo modulo;
  EXPECT_TRUE(modulo.configure(settings, 10'240));
  for (const bool high_resolution : {false, true}) EXPECT_EQ(modulo.position(high_resolution), 0);
  settings.modulo = 1;
  modulo.configure(settings, 10'240);
  EXPECT_EQ(modulo.position(false), 0x4000) << "a quarter of 10 x 4096";
  EXPECT_EQ(modulo.position(true), 10'240);
}

TEST(Modulo, WithoutItTheTargetIsRefused) {
  Rig rig;
  rig.h[454] = 0x8000;
  rig.run(100);
  EXPECT_EQ(rig.h[511], 0);
  EXPECT_TRUE(rig.said("H454"));
}

// IPOSplus p. 29: H453 bit 0.
TEST(Modulo, InterruptedTheTargetIsDroppedOrKept) {
  ModuloRig rig(2);
  rig.h[454] = 0xC000;
  rig.run(250);
  rig.drive.set_inputs(0b0011);
  rig.run(3000);
  EXPECT_TRUE(rig.drive.axis().standing);
  EXPECT_EQ(rig.h[454], rig.h[455]);
  rig.drive.set_inputs(kEnabled);
  const int64_t at = rig.mechanical;
  rig.run(1000);
  EXPECT_EQ(rig.mechanical, at);

  ModuloRig kept(2);
  kept.h[453] = 1;
  kept.h[454] = 0xC000;
  kept.run(250);
  kept.drive.set_inputs(0b0011);
  kept.run(3000);
  EXPECT_EQ(kept.h[454], 0xC000);
  kept.drive.set_inputs(kEnabled);
  kept.run_to_target();
  EXPECT_EQ(kept.h[455], 0xC000);
}

// An endless axis passes the end of the 32-bit count.
TEST(Modulo, TurnsForEver) {
  ModuloRig rig(2, {{"903", 5}, {"900", INT32_MAX - 60'000}});
  rig.positioner().start_reference(false, false);
  rig.run(2);
  const int32_t start = rig.h[455];
  EXPECT_EQ(rig.travel(0x30000 + start), 3 * 40'960);
  EXPECT_LT(rig.h[511], 0);
  EXPECT_EQ(rig.travel(0x30000 + start), 3 * 40'960);
  EXPECT_EQ(rig.drive.fault(), 0);
}

// An encoder so fine that its count is soon 2^32 round, and three times that, both ways: each travel is that of the
// closed form.
TEST(Modulo, TheCountGoesRoundManyTimes) {
  constexpr int32_t kFiner = 32'767, kWay = 1 << 30;
  for (const int shape : {0, 1})
    for (const int sign : {1, -1}) {
      Rig rig({{"941", 1},
               {"942", 1},
               {"943", kFiner},
               {"960", 1},
               {"961", INT32_MAX},
               {"962", 1},
               {"963", 1},
               {"911", 300},
               {"912", 300},
               {"916", shape},
               {"923", 0}});
      for (int n = 0; n < 12; ++n) {
        const int32_t length = n == 0 ? kWay + 60'000'000 : kWay;  // so that it is in a ramp when it is round
        const ClosedForm form(static_cast<double>(length) / kFiner, 1500, 300, 300);
        const int32_t from = rig.h[491];
        rig.go_by(sign * length);
        for (int t = 1; t < form.duration() + 500; ++t) {
          rig.tick();
          const double way = kFiner * (shape == 0 ? form.linear(t) : form.sine(t));
          const auto expected = runtime::wrapped(from + sign * std::llround(way));
          ASSERT_LT(std::abs(runtime::wrapped(int64_t{rig.h[491]} - expected)), 100)
              << "travel " << n << ", after " << t << " ms";
        }
        ASSERT_EQ(rig.h[491], runtime::wrapped(int64_t{from} + sign * length));
        ASSERT_LT(std::abs(rig.h[495]), 10 * kFiner) << "the axis is there";
      }
      EXPECT_EQ(rig.drive.fault(), 0);
    }
}

// Wherever the axis is, and wherever the target: the way ends at the increment next to it, goes round as P960 says, and
// has as many turns more as the target has (normal form, one way only).
TEST(Modulo, EveryWayEndsAtItsTarget) {
  struct Turn {
    int32_t numerator, denominator, resolution;
  };
  std::mt19937 random(11);
  const auto around = [&](int32_t most) {
    return static_cast<int32_t>(random() % (2 * static_cast<uint32_t>(most) + 1)) - most;
  };
  for (const Turn& t : {Turn{10, 1, 4'096}, Turn{113'553, 1'088, 4'096}, Turn{7, 3, 100}, Turn{1, 1, 360},
                        Turn{5, 4, 4'096}, Turn{1, 1, 65'536}})
    for (const int32_t mode : {1, 2, 3})
      for (int n = 0; n < 4'000; ++n) {
        runtime::PositioningSettings settings;
        settings.modulo = mode;
        settings.modulo_numerator = t.numerator;
        settings.modulo_denominator = t.denominator;
        settings.modulo_resolution = t.resolution;
        const bool high = n % 2 == 0;
        const int32_t position = around(1'000'000), offset = n % 3 == 0 ? 0 : around(5'000);
        const int32_t target = n % 5 == 0 ? around(3) * 65'536 : around(250'000);
        Modulo modulo;
        ASSERT_TRUE(modulo.configure(settings, position));
        SCOPED_TRACE(testing::Message() << t.numerator << "/" << t.denominator << " mode " << mode << " from "
                                        << position << " + " << offset << " to " << target << " " << high);
        const double turn = 1.0 * t.numerator * t.resolution, increment = t.denominator;  // units
        const auto within = [](double value, double of) { return value - of * std::floor(value / of); };
        const double at = within((1.0 * position + offset) * increment, turn);
        const double place = high ? within(target, turn) : within(target, 65'536) / 65'536 * turn;
        const double way = static_cast<double>(modulo.way_to(target, high, offset)) * increment;
        const double missed = within(at + way - place + turn / 2, turn) - turn / 2;
        ASSERT_LE(std::abs(missed), increment / 2 + 0.5001);
        const double full = high ? 0 : std::max(0.0, std::floor(target / 65'536.0)) * turn;
        if (mode == 1) {
          ASSERT_LE(std::abs(way), turn / 2 + increment / 2 + 0.5);
        } else {
          const double ahead = mode == 2 ? way - full : -way - full;
          ASSERT_GE(ahead, -increment);
          ASSERT_LT(ahead, turn + increment / 2);
        }
      }
}

// Positions in a turn: floor of the share in steps of 1/65536, or in units.
TEST(Modulo, PositionsAreSharesOfTheTurn) {
  runtime::PositioningSettings settings;
  settings.modulo = 2;
  settings.modulo_numerator = 7;
  settings.modulo_denominator = 3;
  settings.modulo_resolution = 100;
  for (int32_t position = -2'000; position < 2'000; position += 7) {
    Modulo set, moved;
    set.configure(settings, position);
    moved.configure(settings, 0);
    moved.move(position);
    const int64_t turns = static_cast<int64_t>(std::floor(position * 3 / 700.0)), units = position * 3 - turns * 700;
    for (const Modulo* modulo : {&set, &moved}) {
      EXPECT_EQ(modulo->position(true), units) << position;
      EXPECT_EQ(modulo->position(false), units * 65'536 / 700) << position;
      EXPECT_EQ(modulo->turns(), turns) << position;
      EXPECT_EQ(modulo->within_turn(position, true), (position % 700 + 700) % 700);
      EXPECT_EQ(modulo->within_turn(position, false), (position % 65'536 + 65'536) % 65'536);
    }
  }
}

TEST(Modulo, CountOfTurnsCanBeSet) {
  ModuloRig rig(2);
  rig.h[456] = 7;
  rig.run(2);
  rig.travel(0x10000);
  EXPECT_EQ(rig.h[456], 8);
}

}  // namespace
}  // namespace ipos::tests
