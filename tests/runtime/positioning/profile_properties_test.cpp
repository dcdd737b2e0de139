// Random orders to the ramp generator: it always arrives, never leaves what the orders span, never jumps.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "runtime/positioning/profile.hpp"
#include "runtime/positioning/settings.hpp"

namespace ipos::runtime {
namespace {

PositioningSettings any_settings() {
  PositioningSettings settings;
  settings.maximum_speed = 5'500'000;
  settings.speed_cw = *rc::gen::inRange(200, 5'000'001);
  settings.speed_ccw = *rc::gen::inRange(200, 5'000'001);
  settings.ramp_up = *rc::gen::inRange(10, 20'001);
  settings.ramp_down = *rc::gen::inRange(10, 20'001);
  settings.ramp_shape = *rc::gen::inRange(0, 3);
  return settings;
}

// Any target, from any place; the time is the closed form's, so no loop has to wait for it.
TEST(ProfileProperties, ArrivesFromAnywhereToAnywhere) {
  EXPECT_TRUE(rc::check("arrives", [] {
    const auto from = *rc::gen::arbitrary<int32_t>();
    const auto to = *rc::gen::arbitrary<int32_t>();
    const PositioningSettings settings = any_settings();
    Profile profile;
    profile.hold(fine(from), 0);
    profile.travel(to, settings.travel_rules(1000), Goal::New);
    for (int n = 0; n < 5'000 && !profile.at_rest(); ++n) {
      const Fine before = profile.position();
      profile.tick();
      RC_ASSERT(profile.position() >= std::min(fine(from), fine(to)));
      RC_ASSERT(profile.position() <= std::max(fine(from), fine(to)));
      // 5000 rpm are below 342 increments a millisecond.
      RC_ASSERT(magnitude(profile.position() - before) < fine(342));
    }
    if (profile.at_rest()) RC_ASSERT(profile.position() == fine(to));
  }));
}

// Orders at random times, targets all over a range: the setpoint leaves the range never, as every stop was
// possible within it, and the last target is reached.
TEST(ProfileProperties, StaysWithinTheLimitsOfItsTargets) {
  EXPECT_TRUE(rc::check("limits", [] {
    constexpr int32_t kLow = -60'000, kHigh = 60'000;
    PositioningSettings settings = any_settings();
    settings.ramp_up = *rc::gen::inRange(10, 1'500);
    settings.ramp_down = *rc::gen::inRange(10, 1'500);
    settings.speed_cw = *rc::gen::inRange(100'000, 5'000'001);
    settings.speed_ccw = *rc::gen::inRange(100'000, 5'000'001);
    const auto shape = static_cast<RampShape>(settings.ramp_shape);
    Profile profile;
    int64_t target = 0;
    for (int n = *rc::gen::inRange(1, 12); n > 0; --n) {
      target = *rc::gen::inRange(kLow, kHigh + 1);
      profile.travel(target, settings.travel_rules(1000), Goal::New);
      for (int ms = *rc::gen::inRange(0, 900); ms > 0; --ms) {
        profile.tick();
        // Curved ramps taken up again in their middle may need more way than they had (docs/inside/positioning.md).
        if (shape != RampShape::Linear) continue;
        RC_ASSERT(profile.position() >= fine(kLow) - kIncrement / 100);
        RC_ASSERT(profile.position() <= fine(kHigh) + kIncrement / 100);
      }
    }
    for (int ms = 0; ms < 60'000 && !profile.at_rest(); ++ms) profile.tick();
    RC_ASSERT(profile.at_rest());
    RC_ASSERT(profile.position() == fine(target));
  }));
}

// A new plan every millisecond, as with an override that moves, is the same travel.
TEST(ProfileProperties, PlanningAnewChangesNothing) {
  EXPECT_TRUE(rc::check("same plan", [] {
    PositioningSettings settings = any_settings();
    settings.ramp_shape = 0;
    settings.speed_cw = *rc::gen::inRange(100'000, 5'000'001);
    settings.speed_ccw = *rc::gen::inRange(100'000, 5'000'001);
    settings.ramp_up = *rc::gen::inRange(10, 2'000);
    settings.ramp_down = *rc::gen::inRange(10, 2'000);
    const auto to = *rc::gen::inRange(-300'000, 300'001);
    const TravelRules rules = settings.travel_rules(1000);
    Profile once, again;
    once.travel(to, rules, Goal::New);
    for (int ms = 0; ms < 60'000 && !once.at_rest(); ++ms) {
      once.tick();
      again.travel(to, rules, Goal::Kept);
      again.tick();
      RC_ASSERT(magnitude(once.position() - again.position()) < kIncrement);
    }
    again.tick();
    RC_ASSERT(again.position() == fine(to));
  }));
}

// Encoder factors at both ends, the whole range of targets: nothing overflows (the sanitizer build sees it).
TEST(ProfileProperties, NothingOverflows) {
  EXPECT_TRUE(rc::check("no overflow", [] {
    PositioningSettings settings = any_settings();
    settings.source = 1;
    settings.factor_numerator = *rc::gen::element(1, 2, 4096, 32767);
    settings.factor_denominator = *rc::gen::element(1, 2, 4096, 32767);
    Profile profile;
    profile.hold(fine(*rc::gen::arbitrary<int32_t>()), 0);
    for (int n = 0; n < 20; ++n) {
      const auto target = *rc::gen::element(INT32_MIN, INT32_MAX, 0, -1, *rc::gen::arbitrary<int32_t>());
      profile.travel(target, settings.travel_rules(*rc::gen::inRange(0, 1501)),
                     *rc::gen::arbitrary<bool>() ? Goal::New : Goal::Kept);
      for (int ms = 0; ms < 50; ++ms) profile.tick();
      (void)profile.stop_position(settings.travel_rules(1000));
    }
  }));
}

}  // namespace
}  // namespace ipos::runtime
