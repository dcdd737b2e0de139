// The ramp generator against the closed form, and what it does when an order changes on the way.
#include "runtime/positioning/profile.hpp"

#include <gtest/gtest.h>
#include <numbers>

#include <functional>

#include "runtime/positioning/settings.hpp"
#include "tests/runtime/positioning/closed_form.hpp"

namespace ipos::runtime {
namespace {

using tests::ClosedForm;

TravelRules rules(int32_t rpm, int32_t up_ms, int32_t down_ms, RampShape shape = RampShape::Linear) {
  PositioningSettings settings;
  settings.speed_cw = settings.speed_ccw = rpm * 1000;
  settings.maximum_speed = 5'500'000;
  settings.ramp_up = up_ms;
  settings.ramp_down = down_ms;
  settings.ramp_shape = static_cast<int32_t>(shape);
  return settings.travel_rules(1000);
}

struct Job {
  int64_t from, to;
  int32_t rpm, up_ms, down_ms;
};

// Trapezoids and triangles, both ways, at three speeds, with equal and unequal ramps.
std::vector<Job> jobs() {
  std::vector<Job> all;
  for (const int64_t way : {400'000, 2'000})  // trapezoid, triangle
    for (const int32_t rpm : {300, 1500, 4500})
      for (const auto& [up, down] : {std::pair{1000, 1000}, std::pair{200, 700}, std::pair{1500, 90}})
        for (const int sign : {1, -1}) all.push_back({-5000, -5000 + sign * way, rpm, up, down});
  return all;
}

using Way = std::function<double(const ClosedForm&, double)>;

// Every millisecond is where the closed form is; the end comes within one tick, exactly at the target, at
// rest.
void compare(const Job& job, RampShape shape, const Way& way) {
  SCOPED_TRACE(testing::Message() << job.from << " to " << job.to << " at " << job.rpm << " rpm, ramps "
                                  << job.up_ms << " and " << job.down_ms << " ms");
  const ClosedForm form(static_cast<double>(job.to - job.from), job.rpm, job.up_ms, job.down_ms);
  Profile profile;
  profile.hold(fine(job.from), 0);
  profile.travel(job.to, rules(job.rpm, job.up_ms, job.down_ms, shape), Goal::New);
  const int sign = job.to > job.from ? 1 : -1;
  int ticks = 0;
  while (!profile.at_rest() && ticks < 100'000) {
    profile.tick();
    ++ticks;
    const double expected = static_cast<double>(job.from) + sign * way(form, ticks);
    ASSERT_NEAR(static_cast<double>(profile.position()) / kIncrement, expected, 0.01)
        << "after " << ticks << " ms";
  }
  EXPECT_GE(ticks, form.duration() - 1e-6);
  EXPECT_LT(ticks, form.duration() + 1);
  EXPECT_EQ(profile.position(), fine(job.to));
  EXPECT_EQ(profile.speed(), 0);
}

TEST(Profile, LinearIsTheClosedForm) {
  int trapezoids = 0, triangles = 0;
  for (const Job& job : jobs()) {
    compare(job, RampShape::Linear, &ClosedForm::linear);
    const ClosedForm form(static_cast<double>(job.to - job.from), job.rpm, job.up_ms, job.down_ms);
    ++(form.triangle() ? triangles : trapezoids);
  }
  EXPECT_GE(trapezoids, 12);
  EXPECT_GE(triangles, 12);
}

TEST(Profile, SineIsTheClosedForm) {
  for (const Job& job : jobs()) compare(job, RampShape::Sine, &ClosedForm::sine);
}

TEST(Profile, SquaredIsTheClosedForm) {
  for (const Job& job : jobs()) compare(job, RampShape::Squared, &ClosedForm::squared);
}

// The numbers of a travel that can be checked by head: 2^18 increments are 64 turns; 3000 rpm are 50 turns a
// second, reached within 1 s over 25 turns.
TEST(Profile, ByHead) {
  Profile profile;
  profile.travel(64 * 4096, rules(3000, 1000, 1000), Goal::New);
  const auto at = [&](int ms) {
    Profile copy = profile;
    for (int n = 0; n < ms; ++n) copy.tick();
    return copy;
  };
  EXPECT_EQ(whole(at(1000).position()), 25 * 4096);
  EXPECT_EQ(speed_of_rate(at(1000).speed(), {}), 3'000'000);
  EXPECT_EQ(whole(at(1280).position()), 39 * 4096);  // 14 turns at 50 turns a second
  EXPECT_FALSE(at(2279).at_rest());
  EXPECT_TRUE(at(2280).at_rest());
  EXPECT_EQ(at(2280).position(), fine(64 * 4096));
}

TEST(Profile, FromOneEndOfTheRangeToTheOther) {
  Profile profile;
  profile.hold(fine(INT32_MIN), 0);
  profile.travel(INT32_MAX, rules(5000, 10, 10), Goal::New);
  const ClosedForm form(4294967295.0, 5000, 10, 10);
  const auto ticks = static_cast<int64_t>(std::ceil(form.duration()));
  for (int64_t n = 0; n < ticks; ++n) profile.tick();
  EXPECT_TRUE(profile.at_rest());
  EXPECT_EQ(profile.position(), fine(INT32_MAX));
}

// 2^32 increments at 1/1000 rpm last 2000 years: more than a plan can count, and no reason to be there sooner.
TEST(Profile, ATravelOfManyYearsIsNotCutShort) {
  PositioningSettings settings;
  settings.speed_cw = settings.speed_ccw = 1;
  for (const auto& [from, to] : {std::pair{INT32_MIN, INT32_MAX}, std::pair{INT32_MAX, INT32_MIN}}) {
    Profile profile;
    profile.hold(fine(from), 0);
    profile.travel(to, settings.travel_rules(1000), Goal::New);
    const int sign = to > from ? 1 : -1;
    for (int n = 1; n <= 100'000; ++n) {
      profile.tick();
      const double way = static_cast<double>(profile.position() - fine(from)) / kIncrement;
      ASSERT_NEAR(sign * way, n * 4096 / 60e6, 0.001) << n;
    }
  }
}

struct Journey {
  int64_t highest = INT64_MIN, lowest = INT64_MAX;
  int ticks = 0;
};

Journey run_out(Profile& profile) {
  Journey run;
  while (!profile.at_rest() && run.ticks < 1'000'000) {
    profile.tick();
    ++run.ticks;
    run.highest = std::max(run.highest, profile.position());
    run.lowest = std::min(run.lowest, profile.position());
  }
  return run;
}

TEST(Profile, TargetFurtherAheadIsReachedWithoutAStop) {
  for (const auto shape : {RampShape::Linear, RampShape::Sine, RampShape::Squared}) {
    Profile profile;
    const TravelRules r = rules(1500, 500, 500, shape);
    profile.travel(100'000, r, Goal::New);
    for (int n = 0; n < 700; ++n) profile.tick();
    profile.travel(200'000, r, Goal::New);
    const Journey run = run_out(profile);
    EXPECT_EQ(run.highest, fine(200'000));
    // At full speed already: the whole travel takes as long as one to 200000 from the start.
    EXPECT_NEAR(700 + run.ticks, ClosedForm(200'000, 1500, 500, 500).duration(), 1.01);
  }
}

// In the braking ramp, at any time, the same target again or one further away: it is never passed.
TEST(Profile, NoOvershootThatNeedNotBe) {
  for (const auto shape : {RampShape::Linear, RampShape::Sine, RampShape::Squared})
    for (const int64_t further : {0, 1, 10, 1000})
      for (int at = 1; at < 1200; at += 7) {
        Profile profile;
        const TravelRules r = rules(1500, 700, 900, shape);
        profile.travel(50'000, r, Goal::New);
        for (int n = 0; n < at; ++n) profile.tick();
        profile.travel(50'000 + further, r, Goal::New);
        const Journey run = run_out(profile);
        ASSERT_LE(run.highest, fine(50'000 + further)) << "after " << at << " ms, " << further << " further";
        ASSERT_EQ(profile.position(), fine(50'000 + further));
      }
}

// A target behind the axis, or too near: it brakes on the ramp, in the shortest way, and comes back.
TEST(Profile, TargetTooNearIsPassedByTheBrakingWay) {
  Profile profile;
  const TravelRules r = rules(1500, 1000, 1000);
  profile.travel(1'000'000, r, Goal::New);
  for (int n = 0; n < 1000; ++n) profile.tick();  // 25600 after 500 ms, then 102.4 a ms
  const int64_t now = 25'600 + 51'200;
  ASSERT_EQ(whole(profile.position()), now);
  profile.travel(now + 100, r, Goal::New);
  const Journey run = run_out(profile);
  EXPECT_NEAR(static_cast<double>(run.highest) / kIncrement, static_cast<double>(now + 25'600), 1);
  EXPECT_EQ(profile.position(), fine(now + 100));
  EXPECT_NEAR(run.ticks, 500 + ClosedForm(25'500, 1500, 1000, 1000).duration(), 1.01);
}

// A longer ramp in the middle of braking does not push the axis past its target.
TEST(Profile, OtherRampOnTheWayKeepsTheTarget) {
  for (int at = 600; at < 900; at += 3) {
    Profile profile;
    profile.travel(50'000, rules(1500, 500, 500), Goal::New);
    for (int n = 0; n < at; ++n) profile.tick();
    profile.travel(50'000, rules(1500, 500, 5000), Goal::Kept);
    const Journey run = run_out(profile);
    ASSERT_LE(run.highest, fine(50'000)) << at;
    ASSERT_EQ(profile.position(), fine(50'000));
  }
}

TEST(Profile, OtherSpeedOnTheWay) {
  Profile profile;
  profile.travel(400'000, rules(1500, 1000, 1000), Goal::New);
  for (int n = 0; n < 1000; ++n) profile.tick();
  profile.travel(400'000, rules(600, 1000, 1000), Goal::Kept);
  for (int n = 0; n < 299; ++n) profile.tick();
  EXPECT_GT(speed_of_rate(profile.speed(), {}), 600'000);
  for (int n = 0; n < 2; ++n) profile.tick();  // 900 rpm less take 300 ms
  EXPECT_EQ(speed_of_rate(profile.speed(), {}), 600'000);
  profile.travel(400'000, rules(3000, 1000, 1000), Goal::Kept);
  for (int n = 0; n < 400; ++n) profile.tick();
  EXPECT_NEAR(static_cast<double>(speed_of_rate(profile.speed(), {})), 1'800'000, 1);
  run_out(profile);
  EXPECT_EQ(profile.position(), fine(400'000));
}

TEST(Profile, WithoutSpeedThereIsNoTravel) {
  Profile profile;
  profile.travel(1000, rules(0, 1000, 1000), Goal::New);
  profile.tick();
  EXPECT_EQ(profile.position(), 0);
  profile.travel(1000, rules(10, 1000, 1000), Goal::Kept);
  run_out(profile);
  EXPECT_EQ(profile.position(), fine(1000));
}

TEST(Profile, StopEndsAtTheNextIncrementInReach) {
  Profile profile;
  const TravelRules r = rules(1500, 1000, 1000);
  profile.run(-1, r);
  for (int n = 0; n < 500; ++n) profile.tick();
  EXPECT_EQ(whole(profile.position()), -25'600);
  EXPECT_EQ(profile.stop_position(r), -51'200);
  for (int n = 0; n < 123; ++n) profile.tick();
  const int64_t end = profile.stop_position(r);
  profile.stop(r);
  const Journey run = run_out(profile);
  EXPECT_EQ(run.lowest, fine(end));
  EXPECT_EQ(profile.position(), fine(end));
  EXPECT_NEAR(run.ticks, 500, 1);
}

// Both ways, from every millisecond of a start: the stop ends at the first whole increment that the brake, v² / 2a
// long, does not have to pass, and the shaft stays on this side of it.
TEST(Profile, StopEndsAtTheNextIncrementEitherWay) {
  for (const int way : {1, -1})
    for (const int32_t down_ms : {90, 700, 1000})
      for (int at = 1; at < 400; at += 3) {
        SCOPED_TRACE(testing::Message()
                     << "way " << way << ", ramp " << down_ms << ", after " << at << " ms");
        Profile profile;
        const TravelRules r = rules(1500, 613, down_ms);
        profile.hold(fine(1234), 0);
        profile.run(way, r);
        for (int n = 0; n < at; ++n) profile.tick();
        const double speed = std::min(1500.0 * 4096 / 60000, at * ClosedForm(1, 1500, 613, down_ms).up);
        const double brake = speed * speed / 2 / ClosedForm(1, 1500, 613, down_ms).down;
        const double here = static_cast<double>(profile.position()) / kIncrement;
        const int64_t end = profile.stop_position(r);
        const double beyond = way * (static_cast<double>(end) - (here + way * brake));
        ASSERT_GE(beyond, -0.001);
        ASSERT_LT(beyond, 1.001);
        profile.stop(r);
        const Journey run = run_out(profile);
        ASSERT_EQ(profile.position(), fine(end));
        ASSERT_EQ(way > 0 ? run.highest : run.lowest, fine(end));
      }
}

// Counting that moves (reference travel, modulo) changes the number of every place and nothing else: at any time of
// a travel, also of one that turns back, of a run without end and of a stop.
TEST(Profile, ShiftedOnTheWayItIsTheSameTravel) {
  const std::function<void(Profile&, const TravelRules&)> kOrders[] = {
      [](Profile& p, const TravelRules& r) { p.travel(12'000, r, Goal::New); },
      [](Profile& p, const TravelRules& r) { p.travel(-300, r, Goal::New); },
      [](Profile& p, const TravelRules& r) { p.run(-1, r); },
      [](Profile& p, const TravelRules& r) { p.stop(r); },
  };
  for (const auto shape : {RampShape::Linear, RampShape::Sine, RampShape::Squared})
    for (const auto& order : kOrders)
      for (int at = 0; at < 700; at += 29)
        for (const int64_t change : {1, -4096, 1'000'000}) {
          const TravelRules r = rules(1500, 300, 200, shape);
          Profile plain;
          plain.run(1, r);
          for (int n = 0; n < 170; ++n) plain.tick();
          order(plain, r);
          for (int n = 0; n < at; ++n) plain.tick();
          Profile shifted = plain;
          shifted.shift(change);
          for (int n = 0; n < 600; ++n) {
            ASSERT_EQ(shifted.position(), plain.position() + fine(change)) << at << " + " << n << " ms";
            ASSERT_EQ(shifted.speed(), plain.speed());
            ASSERT_EQ(shifted.at_rest(), plain.at_rest());
            plain.tick();
            shifted.tick();
          }
        }
}

// A lower top speed is reached on the ramp down, a higher one on the ramp up, both ways, in travels and in runs.
TEST(Profile, EveryChangeOfSpeedHasItsOwnRamp) {
  for (const int way : {1, -1})
    for (const bool endless : {false, true}) {
      const auto order = [&](Profile& p, int32_t rpm) {
        const TravelRules r = rules(rpm, 2000, 500);
        if (endless)
          p.run(way, r);
        else
          p.travel(way * 1'000'000, r, Goal::Kept);
      };
      const auto rpm_after = [&](Profile& p, int ms) {
        for (int n = 0; n < ms; ++n) p.tick();
        return way * static_cast<double>(speed_of_rate(p.speed(), {})) / 1000;
      };
      Profile p;
      order(p, 1500);
      EXPECT_NEAR(rpm_after(p, 500), 750, 0.01);  // 3000 rpm in 2000 ms
      EXPECT_NEAR(rpm_after(p, 500), 1500, 0.01);
      order(p, 600);
      EXPECT_NEAR(rpm_after(p, 100), 900, 0.01);  // 3000 rpm in 500 ms
      EXPECT_NEAR(rpm_after(p, 50), 600, 0.01);
      EXPECT_NEAR(rpm_after(p, 50), 600, 0.01);
      order(p, 1200);
      EXPECT_NEAR(rpm_after(p, 200), 900, 0.01);
      EXPECT_NEAR(rpm_after(p, 200), 1200, 0.01);
    }
}

// Turned round on the way a run brakes on the ramp down and starts again on the ramp up: v² / 2a on each of them.
TEST(Profile, ARunTheOtherWayBrakesFirst) {
  for (const auto shape : {RampShape::Linear, RampShape::Sine, RampShape::Squared})
    for (const int way : {1, -1}) {
      const TravelRules r = rules(1500, 2000, 500, shape);
      const auto rpm_after = [&](Profile& p, int ms) {
        for (int n = 0; n < ms; ++n) p.tick();
        return way * static_cast<double>(speed_of_rate(p.speed(), {})) / 1000;
      };
      Profile p;
      p.run(way, r);
      EXPECT_NEAR(rpm_after(p, 1'000), 1500, 0.01);
      const double turned = static_cast<double>(p.position()) / kIncrement;
      p.run(-way, r);
      EXPECT_NEAR(rpm_after(p, 125), 750, 0.01);  // 3000 rpm in 500 ms; in its middle every shape is at half
      EXPECT_NEAR(rpm_after(p, 125), 0, 0.01);
      EXPECT_NEAR(static_cast<double>(p.position()) / kIncrement, turned + way * 102.4 * 125, 0.01);
      EXPECT_NEAR(rpm_after(p, 500), -750, 0.01);  // 3000 rpm in 2000 ms
      EXPECT_NEAR(rpm_after(p, 500), -1500, 0.01);
      EXPECT_NEAR(static_cast<double>(p.position()) / kIncrement, turned + way * 102.4 * (125 - 500), 0.01);
    }
}

// 1 rpm is 4096 increments a minute. P901 and P902 are at most P302, and no override scales them.
TEST(TravelRules, ReferenceSpeedsAreP901AndP902) {
  PositioningSettings settings;
  settings.reference_speed_1 = 600'000;
  settings.reference_speed_2 = 60'000;
  settings.maximum_speed = 1'500'000;
  for (const bool fast : {true, false}) {
    const TravelRules r = settings.reference_rules(fast);
    const double rate = (fast ? 600.0 : 60.0) * 4096 / 60'000 * (int64_t{1} << kRateBits);
    EXPECT_NEAR(static_cast<double>(r.cw), rate, 1);
    EXPECT_EQ(r.ccw, r.cw);
  }
  settings.maximum_speed = 300'000;
  EXPECT_NEAR(static_cast<double>(settings.reference_rules(true).cw),
              300.0 * 4096 / 60'000 * (int64_t{1} << kRateBits), 1);
}

// Only what lies ahead and is nearer than the brake needs is overrun; a hundredth less is rounding. 1500 rpm and 3000 rpm
// in 1 s: 25600 increments.
TEST(Profile, OverrunsWhatIsTooNear) {
  const TravelRules r = rules(1500, 1000, 1000);
  for (const int way : {1, -1}) {
    Profile profile;
    profile.run(way, r);
    for (int n = 0; n < 500; ++n) profile.tick();
    const int64_t now = whole(profile.position());
    ASSERT_EQ(now, way * 25'600);
    for (const auto& [ahead, overruns] :
         {std::pair(100'000, false), std::pair(25'700, false), std::pair(25'600, false),
          std::pair(24'000, true), std::pair(100, true), std::pair(1, true), std::pair(-1, false),
          std::pair(-25'000, false), std::pair(-100'000, false)})
      EXPECT_EQ(profile.overruns(now + way * ahead, r), overruns) << way << ", " << ahead;
  }
  Profile rests;
  for (const int64_t target : {-1, 0, 1, 1'000}) EXPECT_FALSE(rests.overruns(target, r)) << target;
}

// Less than half an increment from the target: with a travel speed the travel is over at once, without one the axis
// may not move, not even so little.
TEST(Profile, NextToTheTarget) {
  for (const Fine off : {kIncrement / 4, -kIncrement / 4})
    for (const int32_t rpm : {0, 1500}) {
      Profile profile;
      profile.hold(fine(10) + off, 0);
      profile.travel(10, rules(rpm, 1000, 1000), Goal::New);
      run_out(profile);
      EXPECT_EQ(profile.position(), rpm == 0 ? fine(10) + off : fine(10)) << rpm;
    }
}

TEST(RampShapes, AreSymmetric) {
  for (const auto shape : {RampShape::Linear, RampShape::Sine, RampShape::Squared}) {
    EXPECT_EQ(speed_share(shape, 0), 0);
    EXPECT_EQ(speed_share(shape, kWholeShare), kWholeShare);
    EXPECT_EQ(distance_share(shape, 0), 0);
    EXPECT_EQ(distance_share(shape, kWholeShare), kWholeShare / 2);
    for (int64_t t = 0; t <= kWholeShare; t += kWholeShare / 997) {
      EXPECT_NEAR(static_cast<double>(speed_share(shape, t) + speed_share(shape, kWholeShare - t)),
                  static_cast<double>(kWholeShare), 2);
      const double x = static_cast<double>(t) / kWholeShare;
      const double speed = shape == RampShape::Linear ? x
                           : shape == RampShape::Sine ? (1 - std::cos(std::numbers::pi * x)) / 2
                           : x < 0.5                  ? 2 * x * x
                                                      : 1 - 2 * (1 - x) * (1 - x);
      EXPECT_NEAR(static_cast<double>(speed_share(shape, t)) / kWholeShare, speed, 1e-8);
    }
  }
}

}  // namespace
}  // namespace ipos::runtime
