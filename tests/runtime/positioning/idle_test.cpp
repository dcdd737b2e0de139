// Positioning that only goes on where it has nothing to decide, at rest or on a travel, against one that
// decides in every millisecond: the same random variables, parameters, inputs and commands, compared in each.
#include <random>

#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

constexpr int32_t kSpeedControl = 11, kPositioning = 13;  // settings of P700

class Pair {
 public:
  // P700 is mostly `mode`.
  Pair(uint32_t seed, int32_t mode) : random_(seed), mode_(mode) {
    for (Rig* rig : {&idles_, &never_}) rig->set("700", mode_);
  }

  void step() {
    for (uint32_t orders = below(3); orders > 0; --orders) order();
    for (uint32_t ticks = below(8) == 0 ? below(200) : 1 + below(4); ticks > 0; --ticks) {
      never_.positioner();  // who may have changed it has to be looked at
      idles_.tick();
      never_.tick();
      ASSERT_EQ(idles_.h, never_.h);
      ASSERT_EQ(idles_.drive.axis().speed, never_.drive.axis().speed);
      ASSERT_EQ(idles_.drive.outputs(), never_.drive.outputs());
      ASSERT_EQ(idles_.parameters.changes(), never_.parameters.changes());
      ASSERT_EQ(idles_.journal.entries().size(), never_.journal.entries().size());
      possible_ += idles_.drive.can_position();
      turned_ += idles_.drive.axis().speed != 0;
      ++ticks_;
    }
  }

  int ticks_ = 0, possible_ = 0, turned_ = 0;

 private:
  uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random_()) % limit; }
  int32_t value() {
    return below(4) == 0 ? static_cast<int32_t>(random_()) : static_cast<int32_t>(below(40'001)) - 20'000;
  }
  template <typename Act>
  void both(Act act) {
    act(idles_);
    act(never_);
  }

  void order() {
    switch (below(8)) {
      case 0: {  // what positioning reads or shows
        static constexpr size_t kVariables[] = {453, 454, 455, 456, 473, 491, 492, 493, 494, 495, 496,
                                                497, 498, 499, 502, 503, 506, 507, 509, 510, 511};
        const size_t variable = kVariables[below(std::size(kVariables))];
        const int32_t x = below(3) == 0 ? static_cast<int32_t>(below(4)) : value();
        return both([&](Rig& rig) { rig.h[variable] = x; });
      }
      case 1: {
        struct Choice {
          const char* number;
          int32_t highest;  // from 0
        };
        static constexpr Choice kChoices[] = {
            {"903", 7},     {"941", 2},     {"942", 4},      {"943", 4},     {"922", 99},
            {"923", 9'999}, {"900", 9'999}, {"920", 50'000}, {"951", 1},     {"954", 50'000},
            {"960", 3},     {"961", 5},     {"962", 5},      {"963", 5'000}, {"302", 3'000'000}};
        const Choice& choice = kChoices[below(std::size(kChoices))];
        const auto x = static_cast<int32_t>(below(static_cast<uint32_t>(choice.highest) + 1));
        return both(
            [&](Rig& rig) { rig.parameters.preset(rig.parameters.table().find(choice.number)->index, x); });
      }
      case 2: {
        const int32_t mode = below(3) == 0 ? kSpeedControl + kPositioning - mode_ : mode_;
        return both([&](Rig& rig) { rig.set("700", mode); });
      }
      case 3:
      case 4: {
        const auto levels =
            static_cast<uint16_t>(below(2) == 0 ? uint32_t{kEnabled} : kEnabled ^ 1U << below(16));
        return both([&](Rig& rig) { rig.drive.set_inputs(levels); });
      }
      case 5: {
        static constexpr int32_t kFunctions[] = {0, 14, 15, 17, 18};
        const int32_t function = kFunctions[below(std::size(kFunctions))];
        const char* input = below(2) == 0 ? "602" : "603";
        return both([&](Rig& rig) { rig.set(input, function); });
      }
      case 6: {
        const size_t probe = below(2);
        const uint32_t edges = below(4);
        return both([&](Rig& rig) {
          rig.positioner().touch_probes().enable(probe, (edges & 1) != 0, (edges & 2) != 0);
        });
      }
      default: {
        const uint32_t what = below(8);
        const int32_t x = value();
        return both([&](Rig& rig) {
          rig.service.take_targets(rig.h);
          switch (what) {
            case 0: rig.positioner().start_reference(false, true); break;
            case 1: rig.positioner().end_reference(); break;
            case 2: rig.positioner().stop_here(); break;
            case 3: rig.positioner().halt(runtime::Halt::HoldControl); break;
            case 4: rig.go(x); break;
            case 5: rig.go_by(x); break;
            default: rig.positioner().halt(runtime::Halt::None); break;
          }
          rig.service.show_targets(rig.h);
        });
      }
    }
  }

  std::mt19937 random_;
  int32_t mode_;
  Rig idles_, never_;
};

// On a travel nothing is decided but in the milliseconds in which something changes; what goes on there, or idles,
// leaves the state and the speed of a whole millisecond.
TEST(GoesOn, ATravelGoesOnAsAWholeMillisecondWould) {
  for (const int32_t shape : {0, 1, 2}) {
    Rig rig({{"916", shape}});
    int decided = 0;
    const auto run = [&](int ms) {
      while (ms-- > 0) {
        rig.tick();
        runtime::Positioner goes_on = rig.service.positioner();
        decided += !goes_on.goes_on();
        if (!goes_on.goes_on()) continue;
        runtime::Positioner whole = goes_on;
        const int32_t speed = whole.tick(whole.inputs()).speed;
        ASSERT_EQ(goes_on.go_on(), speed);
        ASSERT_EQ(goes_on == whole, true);
      }
    };
    rig.go(200'000);
    run(800);
    EXPECT_LE(decided, 1);
    rig.go(300'000);
    run(100);
    if (shape == 0) rig.service.set_parameter("913", 1'000'000);  // a curved ramp must not change
    run(4'000);
    EXPECT_TRUE(rig.arrived());
    EXPECT_LE(decided, 3);
  }
}

TEST(GoesOn, IdlingIsAsAWholeMillisecondWould) {
  Rig rig({{"100", 10}});
  rig.go(30'000);
  rig.run(400);
  rig.set("700", kSpeedControl);
  for (int n = 0; n < 300; ++n) {
    rig.tick();
    runtime::Positioner idles = rig.service.positioner();
    ASSERT_TRUE(idles.idles());
    runtime::Positioner whole = idles;
    whole.tick(whole.inputs());
    idles.idle();
    ASSERT_EQ(idles == whole, true) << n;
  }
}

// Several idle milliseconds at once leave what each of them leaves: the target follows the axis one behind it.
TEST(GoesOn, ManyIdleMillisecondsAreAsEachOfThem) {
  Rig rig({{"700", kSpeedControl}});
  rig.run(5);
  runtime::Positioner each = rig.service.positioner(), many = each;
  int32_t counter = each.encoders().counter();
  for (const int ms : {1, 2, 5, 1, 40}) {
    int32_t before = counter;
    for (int n = 0; n < ms; ++n) {
      before = counter;
      counter += 37;
      each.idle();
      each.observe(counter);
    }
    many.advance(before, counter);
    ASSERT_EQ(many == each, true) << ms;
    ASSERT_EQ(many.target(), before);
  }
}

struct Mode {
  int32_t setting;
  double least_possible, most_possible;  // share of the ms in which the mode is one with positioning
};

class GoesOn : public ::testing::TestWithParam<Mode> {};

TEST_P(GoesOn, LeavesOutNothingThatShows) {
  int possible = 0, turned = 0, ticks = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Pair pair(seed, GetParam().setting);
    for (int n = 0; n < 150; ++n) {
      pair.step();
      if (HasFatalFailure()) return;
    }
    ticks += pair.ticks_;
    possible += pair.possible_;
    turned += pair.turned_;
  }
  // All of it has been there.
  EXPECT_GT(possible, ticks * GetParam().least_possible);
  EXPECT_LT(possible, ticks * GetParam().most_possible);
  EXPECT_GT(turned, ticks / 20);
}

INSTANTIATE_TEST_SUITE_P(Modes, GoesOn,
                         ::testing::Values(Mode{kSpeedControl, 0.05, 0.5}, Mode{kPositioning, 0.5, 0.95}));

}  // namespace
}  // namespace ipos::tests
