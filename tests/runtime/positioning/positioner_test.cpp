// Positioning of a shaft that turns as it is told, millisecond by millisecond: following a master up to a limit switch,
// orders that wait for the end of a reference travel, and what is reported when.
#include "runtime/positioning/positioner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ipos::runtime {
namespace {

using Events = std::vector<PositioningEvent>;

struct IdealAxis {
  Positioner positioner;
  PositioningInputs inputs;
  PositioningSettings settings;
  double turned = 0;  // increments
  Events events;
  int syncs_in = 0;
  double master = 0, master_speed = 0;  // increments, and in a millisecond
  bool master_told = false;

  explicit IdealAxis(const PositioningSettings& with = {}) : settings(with) {
    positioner.power_on(settings, 0);
    inputs.possible = inputs.following = true;
    run(3);
  }
  void tick() {
    if (master_told) {
      inputs.master.sync = syncs_in-- == 0;
      if (inputs.master.sync) {
        syncs_in = 4;
        inputs.master.position = static_cast<int32_t>(std::lround(master));
      }
      master += master_speed;
    } else {
      inputs.master.sync = false;
    }
    const PositioningOrder order = positioner.tick(inputs);
    const auto told = positioner.take_events().which;
    for (size_t n = 0; n < told.size(); ++n)
      if (told.test(n)) events.push_back(static_cast<PositioningEvent>(n));
    inputs.speed = order.speed;
    turned += order.speed * (4096 / 60e6);
    positioner.observe(wrapped(std::llround(turned)));
  }
  void run(int ms) {
    while (ms-- > 0) tick();
  }
  Events take() { return std::exchange(events, {}); }
  void interrupt() {  // a millisecond in which something else brakes the axis
    inputs.following = false;
    inputs.speed = 0;
    tick();
    inputs.following = true;
  }
};

// --- behind a master

// The limit switch on the side to which the master leads ends it; that on the other side is nothing. The axis is followed
// no more until the program sets SyncControl anew.
TEST(PositionerFollows, UpToALimitSwitch) {
  for (const int way : {1, -1}) {
    SCOPED_TRACE(way);
    IdealAxis axis;
    axis.master_told = true;
    axis.master_speed = way * 40;
    axis.run(30);
    axis.inputs.master.follow = true;
    axis.run(400);
    ASSERT_EQ(axis.positioner.follow_state(), FollowState::Synchronous);
    bool& ahead = way > 0 ? axis.inputs.limit_cw : axis.inputs.limit_ccw;
    bool& behind = way > 0 ? axis.inputs.limit_ccw : axis.inputs.limit_cw;
    behind = true;
    axis.run(20);
    EXPECT_EQ(axis.take(), Events{});
    EXPECT_EQ(axis.positioner.follow_state(), FollowState::Synchronous);
    behind = false;
    ahead = true;
    axis.run(1);
    EXPECT_EQ(axis.take(), Events{PositioningEvent::LimitReached});
    EXPECT_EQ(axis.positioner.follow_state(), FollowState::Free);
    const int32_t end = axis.positioner.target();
    axis.run(1'000);
    EXPECT_EQ(axis.take(), Events{}) << "told once";
    EXPECT_EQ(axis.inputs.speed, 0);
    EXPECT_EQ(axis.positioner.target(), end) << "where the ramp ends";
    EXPECT_EQ(axis.positioner.setpoint(), end);
    ahead = false;
    axis.interrupt();
    axis.run(20);
    EXPECT_EQ(axis.positioner.follow_state(), FollowState::Free) << "not by itself";
    axis.inputs.master.follow = false;
    axis.run(1);
    axis.inputs.master.follow = true;
    axis.run(1);
    EXPECT_EQ(axis.positioner.follow_state(), FollowState::Coupling);
    EXPECT_EQ(axis.take(), Events{});
  }
}

// Behind a software limit switch of a referenced axis the same, with its own message.
TEST(PositionerFollows, UpToASoftwareLimitSwitch) {
  for (const int way : {1, -1}) {
    PositioningSettings settings;
    settings.reference_type = 5;
    settings.limit_cw = 20'000;
    settings.limit_ccw = -20'000;
    IdealAxis axis(settings);
    axis.positioner.start_reference(false, false);
    axis.master_told = true;
    axis.master_speed = way * 40;
    axis.run(30);
    axis.inputs.master.follow = true;
    for (int ms = 0; ms < 2'000 && axis.events.empty(); ++ms) axis.tick();
    EXPECT_EQ(axis.take(), Events{PositioningEvent::FollowedBeyondLimit});
    EXPECT_NEAR(axis.positioner.setpoint(), way * 20'000, 81) << "the first millisecond of the ramp is in it";
    EXPECT_GT(way * axis.positioner.setpoint(), 20'000);
    EXPECT_EQ(axis.positioner.follow_state(), FollowState::Free);
    axis.run(1'000);
    EXPECT_EQ(axis.inputs.speed, 0);
    EXPECT_EQ(axis.positioner.follow_state(), FollowState::Free);
  }
}

// The ramp P911 leads up to the master, whichever way it goes: 3000 rpm in 1000 ms are 0.2048 increments a ms more in
// each millisecond, so 40 of them take 196 ms.
TEST(PositionerFollows, OnTheRampEitherWay) {
  for (const int way : {1, -1}) {
    IdealAxis axis;
    axis.master_told = true;
    axis.master_speed = way * 40;
    axis.run(30);
    axis.inputs.master.follow = true;
    int32_t before = axis.positioner.setpoint();
    for (int ms = 1; ms <= 194; ++ms) {
      axis.tick();
      ASSERT_EQ(axis.positioner.follow_state(), FollowState::Coupling) << ms;
      const double step = axis.positioner.setpoint() - before;
      ASSERT_NEAR(way * step, (ms - 0.5) * 0.2048, 1.01) << ms;
      before = axis.positioner.setpoint();
    }
    axis.run(3);
    EXPECT_EQ(axis.positioner.follow_state(), FollowState::Synchronous);
    EXPECT_NEAR(axis.positioner.setpoint(), way * 195.3 * 40 / 2, 45 + 40);
    before = axis.positioner.setpoint();
    axis.run(100);
    EXPECT_NEAR(axis.positioner.setpoint() - before, way * 4'000, 1);
  }
}

// Given up by the program the axis stops on the ramp P912 and nothing is said; without sync telegrams it is the same,
// and said.
TEST(PositionerFollows, ToTheEndOfTheMasterOrOfTheProgramsWish) {
  for (const bool lost : {false, true}) {
    IdealAxis axis;
    axis.master_told = true;
    axis.master_speed = 40;
    axis.run(30);
    axis.inputs.master.follow = true;
    axis.run(400);
    axis.take();
    if (lost)
      axis.master_told = false;
    else
      axis.inputs.master.follow = false;
    int ms = 0;
    for (; ms < 100 && axis.positioner.follow_state() != FollowState::Free; ++ms) axis.tick();
    EXPECT_LE(ms, lost ? 20 : 1);
    EXPECT_EQ(axis.take(), lost ? Events{PositioningEvent::MasterLost} : Events{});
    // v² / 2a of 40 increments a ms: 3906.
    const int32_t from = axis.positioner.setpoint();
    axis.run(300);
    EXPECT_NEAR(axis.positioner.setpoint() - from, 3'906, 45);
    EXPECT_EQ(axis.positioner.setpoint(), axis.positioner.target());
    axis.run(200);  // half an increment that is left takes its time
    EXPECT_EQ(axis.inputs.speed, 0);
    EXPECT_EQ(axis.take(), Events{});
  }
}

// The ramp that ends it is of its shape: at a quarter of its time half a cosine has 85 % of the speed, a parabola 87.5 %,
// a straight line 75 %.
TEST(PositionerFollows, ToAStopOfItsShape) {
  const std::pair<int32_t, double> shapes[] = {{0, 0.75}, {1, (1 + std::sqrt(0.5)) / 2}, {2, 0.875}};
  for (const auto& [shape, share] : shapes) {
    IdealAxis axis;
    axis.master_told = true;
    axis.master_speed = 40;
    axis.run(30);
    axis.inputs.master.follow = true;
    axis.run(200);
    axis.settings.ramp_shape = shape;  // set while it follows, with another time
    axis.settings.ramp_down = 800;
    axis.positioner.take_over(axis.settings);
    axis.run(200);
    const double speed = axis.inputs.speed;
    axis.inputs.master.follow = false;
    axis.run(39);  // of 156
    EXPECT_NEAR(axis.inputs.speed / speed, share, 0.015) << shape;
    axis.run(39);
    EXPECT_NEAR(axis.inputs.speed / speed, 0.5, 0.02) << shape;
  }
}

// --- orders while a reference travel is on its way

enum class Order { Absolute, Relative, Modulo };

// Type 0 goes CCW to the next zero pulse. The target behind it is what was ordered meanwhile: the last place, and ways
// from there; a way alone counts from where the travel stops.
TEST(PositionerOrders, WaitForTheEndOfAReferenceTravel) {
  PositioningSettings settings;
  settings.modulo = 1;
  settings.modulo_numerator = 10;
  settings.modulo_resolution = 4'096;
  struct Given {
    Order order;
    int32_t value;
  };
  const auto target_after = [&](const std::vector<Given>& orders) {
    IdealAxis axis(settings);
    axis.positioner.start_reference(false, false);
    axis.run(5);
    for (const Given& given : orders) switch (given.order) {
        case Order::Absolute: axis.positioner.write_target(given.value); break;
        case Order::Relative: axis.positioner.move_target(given.value); break;
        case Order::Modulo: axis.positioner.write_modulo_target(given.value); break;
      }
    EXPECT_TRUE(axis.positioner.referencing());
    for (int ms = 0; ms < 5'000 && axis.positioner.referencing(); ++ms) axis.tick();
    EXPECT_TRUE(axis.positioner.referenced());
    return axis.positioner.target();
  };
  const int32_t stopped = target_after({});
  EXPECT_LT(stopped, 0) << "behind the zero pulse";
  EXPECT_GT(stopped, -1'000);
  EXPECT_EQ(target_after({{Order::Absolute, 7'000}}), 7'000);
  EXPECT_EQ(target_after({{Order::Absolute, 7'000}, {Order::Absolute, -300}}), -300);
  EXPECT_EQ(target_after({{Order::Absolute, 7'000}, {Order::Relative, -300}}), 6'700);
  EXPECT_EQ(target_after({{Order::Absolute, 7'000}, {Order::Relative, -300}, {Order::Relative, 50}}), 6'750);
  EXPECT_EQ(target_after({{Order::Relative, 500}}), stopped + 500);
  EXPECT_EQ(target_after({{Order::Relative, 500}, {Order::Relative, -20}}), stopped + 480);
  EXPECT_EQ(target_after({{Order::Relative, 500}, {Order::Absolute, 9}}), 9);
  // A quarter of 10 turns; the shorter way there.
  EXPECT_NEAR(target_after({{Order::Modulo, 0x4000}}), 10'240, 1);
  EXPECT_NEAR(target_after({{Order::Absolute, 7'000}, {Order::Modulo, 0xC000}}), -10'240, 1);
  EXPECT_EQ(target_after({{Order::Modulo, 0x4000}, {Order::Relative, 500}}), stopped + 500);
  EXPECT_EQ(target_after({{Order::Modulo, 0x4000}, {Order::Absolute, 11}}), 11);
}

TEST(PositionerOrders, AStopForgetsWhatWaits) {
  IdealAxis axis;
  axis.positioner.start_reference(false, false);
  axis.run(5);
  axis.positioner.write_target(7'000);
  axis.positioner.stop_here();
  EXPECT_FALSE(axis.positioner.referencing());
  EXPECT_FALSE(axis.positioner.referenced());
  axis.run(2'000);
  EXPECT_NE(axis.positioner.target(), 7'000);
  EXPECT_EQ(axis.positioner.target(), axis.positioner.setpoint());
  // A new reference travel does not know it either.
  axis.positioner.start_reference(false, false);
  for (int ms = 0; ms < 5'000 && axis.positioner.referencing(); ++ms) axis.tick();
  axis.run(1'000);
  EXPECT_NE(axis.positioner.setpoint(), 7'000);
}

// --- limit switches of a travel

TEST(PositionerLimits, OnlyTheOneAheadEndsATravel) {
  for (const int way : {1, -1})
    for (const bool ahead : {false, true}) {
      IdealAxis axis;
      axis.positioner.write_target(way * 200'000);
      axis.run(300);
      (ahead == (way > 0) ? axis.inputs.limit_cw : axis.inputs.limit_ccw) = true;
      axis.run(1);
      EXPECT_EQ(axis.take(), ahead ? Events{PositioningEvent::LimitReached} : Events{});
      axis.run(700);
      EXPECT_EQ(axis.inputs.speed == 0, ahead);
      EXPECT_EQ(axis.take(), Events{});
      if (!ahead) continue;
      // Given up: an interruption later the target is where the axis is.
      axis.interrupt();
      EXPECT_NEAR(axis.positioner.target(), axis.turned, 1);
      // Away from the switch is no travel against it.
      axis.positioner.write_target(0);
      axis.run(100);
      EXPECT_EQ(axis.take(), Events{});
      EXPECT_LT(way * axis.inputs.speed, 0);
    }
}

// --- modes

TEST(PositionerModes, OrdersInAModeWithoutPositioningAreTold) {
  IdealAxis axis;
  axis.positioner.write_target(100);
  axis.positioner.move_target(100);
  axis.run(1);
  EXPECT_EQ(axis.take(), Events{});
  axis.inputs.possible = false;
  axis.run(1);
  EXPECT_EQ(axis.take(), Events{});
  axis.positioner.write_target(100);
  axis.run(1);
  EXPECT_EQ(axis.take(), Events{PositioningEvent::NoPositioning});
  axis.positioner.start_reference(false, false);
  axis.run(1);
  EXPECT_EQ(axis.take(), Events{PositioningEvent::NoReferencing});
}

// The window of P922; a unit may be told a negative one, which is 0.
TEST(PositionerModes, InPositionIsWithinTheWindow) {
  for (const int32_t window : {0, 3, -3}) {
    PositioningSettings settings;
    settings.window = window;
    settings.speed_cw = settings.speed_ccw = 0;  // it stays where it is
    IdealAxis axis(settings);
    for (const int32_t off : {0, 1, 3, 4, -1, -3, -4}) {
      axis.positioner.write_target(off);
      EXPECT_EQ(axis.positioner.in_position(), std::abs(off) <= std::max(window, 0)) << off;
    }
  }
}

// P913 CW, P914 CCW, and P302 above both.
TEST(PositionerModes, EachWayHasItsSpeed) {
  PositioningSettings settings;
  settings.speed_cw = 600'000;
  settings.speed_ccw = 900'000;
  settings.maximum_speed = 800'000;
  for (const int way : {1, -1}) {
    IdealAxis axis(settings);
    axis.positioner.write_target(way * 1'000'000);
    axis.run(1'000);
    EXPECT_NEAR(axis.inputs.speed, way > 0 ? 600'000 : -800'000, 2'000);
  }
}

}  // namespace
}  // namespace ipos::runtime
