// Synchronous operation with the DRS card: the counter and the speed of the slave alone, on an axis that turns as it is told,
// beside the closed form of a proportional controller with precontrol; free running, offsets, monitoring.
#include "runtime/positioning/synchronous.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT
using State = SynchronousOperation::State;

constexpr double kIncrementsPerSpeed = 4096.0 / 60e6;  // increments a millisecond for 1/1000 rpm
// 3000 rpm in the 2 s of P241, in increments per millisecond squared.
constexpr double kSlope = 204.8 / 2'000;

// A master, and a slave that turns at the ordered speed from millisecond to millisecond.
struct Pair {
  SynchronousSettings settings;
  SynchronousInputs in;
  SynchronousOperation operation;
  SynchronousOrder order;
  double master = 0;
  double slave = 0;
  double free_speed = 0;  // increments a millisecond while it runs free
  int ms = 0;

  explicit Pair(double behind = 0, bool at_once = false) {
    in.following = true;
    if (at_once) {  // catches up by its gain alone
      settings.catch_up_ramp = 0;
      settings.catch_up_speed = 100'000'000;
      settings.maximum_speed = 100'000'000;
    }
    if (behind == 0) return;
    in.following = false;  // the master turns while the slave is not enabled
    tick(0);
    tick(behind);
    run(100);
    in.following = true;
  }
  void tick(double master_step) {
    in.master = wrapped(static_cast<int64_t>(std::floor(master)));
    in.slave = wrapped(static_cast<int64_t>(std::floor(slave)));
    order = operation.tick(settings, in);
    master += master_step;
    const double step = !order.controls ? free_speed : order.stands || !in.following ? 0 : order.speed * kIncrementsPerSpeed;
    in.speed = static_cast<int32_t>(std::lround(step / kIncrementsPerSpeed));
    slave += step;
    ++ms;
  }
  void run(int count, double master_step = 0) {
    while (count-- > 0) tick(master_step);
  }
  int until(const std::function<bool()>& condition, double master_step = 0) {
    int count = 0;
    for (; !condition() && count < 60'000; ++count) tick(master_step);
    return count;
  }
  double behind() const { return master - slave; }
};

TEST(Synchronous, ConstantSpeedIsFollowedWithoutDifference) {
  Pair pair;
  pair.settings.catch_up_ramp = 0;
  pair.run(3'000, 60.3);
  EXPECT_EQ(pair.operation.state(), State::Synchronous);
  for (int n = 0; n < 500; ++n) {
    pair.tick(60.3);
    ASSERT_NEAR(pair.behind(), 0, 1.5) << n;
  }
  pair.run(2'000);
  EXPECT_NEAR(pair.behind(), 0, 1.5);
}

// P220 = k per second: d(n) = d(0) (1 - k / 1000)^n, a millisecond each.
TEST(Synchronous, DifferenceIsWorkedOffByTheGain) {
  for (const int32_t gain : {1, 10, 50, 200}) {
    Pair pair(10'000, true);
    pair.settings.gain = gain * 1'000;
    for (int n = 1; n <= 300; ++n) {
      pair.tick(0);
      ASSERT_NEAR(pair.behind(), 10'000 * std::pow(1 - gain / 1000.0, n), 1.5) << "gain " << gain << ", " << n << " ms";
    }
  }
}

// A master that accelerates by a is followed a (T + P228) / k behind; T are the millisecond that the precontrol is late, and
// four of its own filter.
TEST(Synchronous, LagOfAnAcceleratingMaster) {
  for (const int32_t filter_ms : {0, 20, 100}) {
    Pair pair(0, true);
    pair.settings.precontrol_filter = filter_ms * 1'000;
    for (int n = 0; n < 2'000; ++n) pair.tick(kSlope * n);
    EXPECT_NEAR(static_cast<double>(pair.operation.difference()), kSlope * (5 + filter_ms) / 0.01, 2) << filter_ms;
  }
}

// The figures of the DRS11B manual p. 25: for the same way of both belts the master makes P221 increments and the slave P222.
TEST(Synchronous, GearOfTheManual) {
  Pair pair;
  pair.settings.master_gear = 3'420'928;
  pair.settings.slave_gear = 4'282'875;
  pair.settings.maximum_speed = 5'000'000;
  pair.run(34'209, 100);
  pair.run(3'000, 28.0 / 3'000);
  EXPECT_NEAR(pair.master, 3'420'928, 0.01);
  EXPECT_NEAR(pair.slave, 4'282'875, 2);
}

// Up to 3 999 999 999, which as a 32-bit value is negative; and the greatest gears lose nothing.
TEST(Synchronous, GreatestGears) {
  Pair pair;
  pair.settings.master_gear = pair.settings.slave_gear = static_cast<int32_t>(3'999'999'999U);
  pair.run(2'000, 50);
  pair.run(2'000);
  EXPECT_NEAR(pair.behind(), 0, 1.5);
}

// P230: the encoder that is compared turns P232 increments for P231 of the motor.
TEST(Synchronous, SynchronousEncoder) {
  for (const int32_t kind : {1, 2}) {
    Pair pair;
    pair.settings.synchronous_encoder = kind;
    pair.settings.slave_factor = 5;
    pair.settings.encoder_factor = 2;
    pair.settings.maximum_speed = 5'000'000;
    pair.run(2'000, 20);
    pair.run(4'000);
    EXPECT_NEAR(pair.slave, 40'000.0 * 5 / 2, 4) << kind;
  }
}

// P240 and P241: up on the ramp, on at the speed, down on the ramp as far as the gain would brake harder, and the rest by the gain.
TEST(Synchronous, CatchesUpOnItsRamp) {
  constexpr double kWay = 409'600, kSpeed = 102.4, kGain = 0.01;
  const double knee = kSlope / kGain;
  const double braking = (kSpeed * kSpeed + knee * knee) / (2 * kSlope);
  const double time = kSpeed / kSlope + (kWay - kSpeed * kSpeed / (2 * kSlope) - braking) / kSpeed + (kSpeed - knee) / kSlope +
                      std::log(kSlope / (kGain * kGain) / 25) / kGain;
  Pair pair(kWay);
  double before = 0;
  const int ms = pair.until([&] {
    const double speed = pair.in.speed * kIncrementsPerSpeed;
    EXPECT_LE(std::abs(speed - before), kSlope * 1.05 + 0.001);
    EXPECT_LE(speed, kSpeed + 0.001);
    before = speed;
    return pair.operation.state() == State::Synchronous;
  });
  EXPECT_NEAR(ms, time, 0.01 * time);
  pair.run(1'000);
  EXPECT_NEAR(pair.behind(), 0, 1.5);
}

TEST(Synchronous, CatchesUpWithARunningMaster) {
  Pair pair(100'000);
  pair.settings.maximum_speed = 5'000'000;
  EXPECT_LT(pair.until([&] { return pair.operation.state() == State::Synchronous; }, 60), 10'000);
  pair.run(2'000, 60);
  EXPECT_NEAR(pair.behind(), 0, 1.5);
}

// Beyond P302 the slave does not turn, and falls behind.
TEST(Synchronous, MaximumSpeed) {
  Pair pair(0, true);
  pair.settings.maximum_speed = 1'500'000;
  pair.run(1'000, 150);
  EXPECT_EQ(pair.order.speed, 1'500'000);
  EXPECT_NEAR(static_cast<double>(pair.operation.difference()), 1'000 * (150 - 102.4), 250);
}

// What the slave has turned off its way, at the end of free running with each mode of P223, and whether it ended by itself.
TEST(Synchronous, ModesOfFreeRunning) {
  const struct {
    int32_t mode;  // as it is coded, MODE 1 is 0
    double left;   // difference to the master in the end; the slave ran 3000 increments ahead, or 1000 where P224 ends it
    bool limited;
  } rows[] = {{0, -3'000, false}, {1, 0, false}, {2, -1'000, false}, {3, -1'000, true}, {4, 0, true}, {5, -3'000, false}};
  for (const auto& row : rows) {
    Pair pair;
    pair.settings.mode = row.mode;
    pair.settings.slave_counter = 1'000;
    pair.run(1'000, 20);
    ASSERT_EQ(pair.operation.state(), State::Synchronous) << row.mode;
    pair.in.free_run = true;
    pair.free_speed = 30;
    int free = 0;
    for (int n = 0; n < 300; ++n) {
      pair.tick(20);
      free += pair.order.controls ? 0 : 1;
    }
    EXPECT_EQ(free < 300, row.limited) << row.mode;
    if (row.limited) {
      EXPECT_NEAR(free, 100, 3) << row.mode;
    }
    pair.in.free_run = false;
    pair.run(8'000, 20);
    EXPECT_EQ(pair.operation.state(), State::Synchronous) << row.mode;
    EXPECT_NEAR(pair.behind(), row.left, row.limited ? 40 : 15) << row.mode;
  }
}

TEST(Synchronous, LimitedFreeRunningComesAgainWithItsInput) {
  Pair pair;
  pair.settings.mode = 4;
  pair.settings.slave_counter = -200;
  pair.free_speed = -10;
  for (int n = 0; n < 2; ++n) {
    pair.in.free_run = true;
    pair.run(100);
    EXPECT_TRUE(pair.order.controls) << "after 20 ms it has ended";
    pair.in.free_run = false;
    pair.run(3'000);
    EXPECT_NEAR(pair.behind(), 0, 1.5);
  }
}

// P225 to P227: in mode 6 as long as it is chosen, in 7 once a choice, in 8 again after three seconds, four times a second.
TEST(Synchronous, Offsets) {
  Pair pair;
  pair.settings.offset_1 = 500;
  pair.settings.offset_2 = -300;
  pair.settings.offset_3 = 2'000;
  const auto choose = [&](int32_t mode, uint8_t offset, int ms) {
    pair.settings.mode = mode;
    pair.in.offset = offset;
    pair.run(ms);
    return -pair.behind();
  };
  EXPECT_NEAR(choose(5, 1, 3'000), 500, 1.5);
  EXPECT_NEAR(choose(5, 2, 3'000), -300, 1.5);
  EXPECT_NEAR(choose(5, 3, 4'000), 2'000, 1.5);
  EXPECT_NEAR(choose(5, 0, 4'000), 0, 1.5);
  EXPECT_NEAR(choose(6, 1, 3'000), 500, 1.5);
  EXPECT_NEAR(choose(6, 0, 3'000), 500, 1.5);
  EXPECT_NEAR(choose(6, 2, 5'000), 200, 1.5);
  EXPECT_NEAR(choose(7, 0, 1'000), 200, 1.5);
  choose(7, 1, 4'000);  // at once, after 3 s, and 3.25, 3.5, 3.75 s
  EXPECT_NEAR(choose(7, 0, 4'000), 200 + 5 * 500, 1.5);
  EXPECT_NEAR(choose(0, 1, 3'000), 2'700, 1.5) << "a mode without offsets";
}

TEST(Synchronous, ZeroPointAndTeachIn) {
  Pair pair(5'000, true);
  pair.in.zero_point = true;
  pair.run(500);
  EXPECT_NEAR(pair.behind(), 5'000, 1.5) << "where it was is in step";
  pair.run(1'500, 10);
  EXPECT_NEAR(pair.behind(), 5'000, 2) << "the edge acts, not the level";
  pair.settings.mode = 1;
  pair.in.teach_in = true;
  pair.free_speed = 7;
  pair.run(100);
  EXPECT_FALSE(pair.order.controls);
  pair.in.teach_in = false;
  pair.run(500);
  EXPECT_NEAR(pair.behind(), 5'000 - 700, 2) << "taught, whatever P223 says";
}

TEST(Synchronous, StartAndStandstillOfTheMaster) {
  Pair pair;
  pair.in.start = false;
  pair.run(1'000, 10);
  EXPECT_TRUE(pair.order.stands);
  EXPECT_NEAR(pair.behind(), 10'000, 0.1);
  pair.in.start = true;
  pair.run(4'000);
  EXPECT_NEAR(pair.behind(), 0, 1.5) << "it makes up for the way";
  pair.in.master_stopped = true;
  pair.tick(0);
  EXPECT_TRUE(pair.order.stands);
  pair.run(3, 10);
  pair.run(3, 10);
  EXPECT_FALSE(pair.order.stands) << "beyond P510 it follows all the same";
}

TEST(Synchronous, LimitSwitches) {
  Pair pair(2'000, true);
  pair.in.limit_cw = true;
  pair.run(100);
  EXPECT_TRUE(pair.order.stands);
  EXPECT_NEAR(pair.behind(), 2'000, 0.1);
  pair.run(400, -10);
  EXPECT_FALSE(pair.order.stands) << "the master leads away from it";
  pair.in.limit_cw = false;
  pair.run(1'000);
  EXPECT_NEAR(pair.behind(), 0, 1.5);
}

// P512 for longer than P513, where the slave was in step; P511 at once; P510 for P515.
TEST(Synchronous, Monitoring) {
  Pair pair;
  pair.settings.lag_delay = 200;
  pair.settings.maximum_speed = 0;  // it cannot turn
  EXPECT_EQ(pair.until([&] { return pair.operation.in_position(); }), 11) << "longer than 10 ms";
  EXPECT_FALSE(pair.operation.prewarning());
  const auto difference = [&](int64_t n) { return [&pair, n] { return pair.operation.difference() >= n; }; };
  pair.until(difference(26), 1);
  EXPECT_FALSE(pair.operation.in_position());
  pair.until(difference(50), 1);
  EXPECT_FALSE(pair.operation.prewarning());
  pair.until(difference(51), 1);
  EXPECT_TRUE(pair.operation.prewarning());
  pair.until(difference(4'001), 1);
  EXPECT_FALSE(pair.operation.lag_error());
  EXPECT_EQ(pair.until([&] { return pair.operation.lag_error(); }), 200);
  pair.in.following = false;
  pair.run(10);
  EXPECT_TRUE(pair.operation.lag_error());
  pair.in.following = true;
  pair.tick(0);
  EXPECT_FALSE(pair.operation.lag_error()) << "started anew";
  pair.run(5'000);
  EXPECT_FALSE(pair.operation.lag_error()) << "a slave that catches up is not watched";
}

TEST(Synchronous, CountsPassTheEndOfTheRange) {
  Pair pair;
  pair.master = pair.slave = INT32_MAX - 1'000.0;
  pair.run(2'000, 40);
  EXPECT_NEAR(pair.behind(), 0, 60);
  EXPECT_EQ(pair.operation.state(), State::Synchronous);
  pair.run(2'000);
  EXPECT_NEAR(pair.behind(), 0, 1.5);
}

}  // namespace
}  // namespace ipos::tests
