// Software and hardware limit switches, and random programs of orders that must stay within them.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

TEST(SoftwareLimits, ATargetBeyondIsF78AndNoTravel) {
  Rig rig({{"903", 5}, {"920", 50'000}, {"921", -20'000}});
  rig.positioner().start_reference(false, false);
  for (const int32_t target : {50'001, -20'001, INT32_MAX, INT32_MIN}) {
    rig.journal = {};
    rig.go(target);
    rig.run(300);
    EXPECT_EQ(rig.h[511], 0) << target;
    EXPECT_TRUE(rig.said("F78"));
    EXPECT_EQ(rig.drive.fault(), 0) << "no response from the factory";
    EXPECT_FALSE(rig.in_position());
    rig.go(0);
    rig.run_to_target();
  }
  for (const int32_t target : {50'000, -20'000}) {
    rig.go(target);
    rig.run_to_target();
    EXPECT_EQ(rig.h[511], target);
  }
}

TEST(SoftwareLimits, OnTheWayTheAxisStops) {
  Rig rig({{"903", 5}, {"920", 200'000}, {"921", -200'000}});
  rig.positioner().start_reference(false, false);
  rig.go(100'000);
  rig.run(500);
  rig.h[492] = 300'000;
  rig.run(2000);
  EXPECT_TRUE(rig.drive.axis().standing);
  EXPECT_LT(rig.h[511], 100'000);
  EXPECT_EQ(rig.h[492], 300'000);
  // A limit moved by the program: H496 is P920.
  rig.h[496] = 400'000;
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 300'000);
}

// Enable comes back while the axis turns and its target is not allowed: it brakes.
TEST(SoftwareLimits, ATurningAxisWithoutATravelBrakes) {
  Rig rig({{"903", 5}, {"920", 800'000}, {"921", -200'000}, {"136", 10'000}});
  rig.positioner().start_reference(false, false);
  rig.go(700'000);
  rig.run(1000);
  rig.h[492] = 900'000;
  rig.run(50);
  rig.drive.set_inputs(kEnabled & ~(1 << 3));
  rig.run(50);
  rig.drive.set_inputs(kEnabled);
  rig.run(1500);
  EXPECT_TRUE(rig.drive.axis().standing);
  EXPECT_EQ(rig.drive.fault(), 0);
}

TEST(SoftwareLimits, OnlyOfAReferencedAxisAndNotWithBothAtZero) {
  Rig rig({{"920", 50'000}, {"921", -20'000}});
  rig.go(60'000);
  rig.run_to_target();
  EXPECT_EQ(rig.h[511], 60'000);
  Rig off({{"903", 5}});
  off.positioner().start_reference(false, false);
  off.go(60'000);
  off.run_to_target();
  EXPECT_EQ(off.h[511], 60'000);
}

// DI04 /limit switch CW at 40000, DI05 /limit switch CCW at -40000.
struct LimitRig : Rig {
  LimitRig() : Rig({{"603", 14}, {"604", 15}, {"137", 100}}) {
    levels = [](int64_t at) {
      return static_cast<uint16_t>(kEnabled | (at < 40'000 ? 1 << 4 : 0) | (at > -40'000 ? 1 << 5 : 0));
    };
    drive.reset_fault();
    run(2);
  }
};

TEST(LimitSwitches, AreF29WithEmergencyStop) {
  for (const int sign : {1, -1}) {
    LimitRig rig;
    rig.go(sign * 100'000);
    rig.run_until([&] { return rig.drive.fault() != 0; });
    EXPECT_EQ(rig.drive.fault(), 29);
    EXPECT_EQ(rig.drive.verdict().command, runtime::Command::EmergencyStop);
    EXPECT_LT(std::abs(rig.h[511]), 40'210) << "102.4 increments a ms until it is seen, and while it is";
    rig.run(1000);
    EXPECT_TRUE(rig.drive.axis().standing);
    EXPECT_TRUE(rig.said("F29"));

    // The travel is given up: after a reset the axis stays.
    const int32_t at = rig.h[511];
    rig.drive.reset_fault();
    rig.run(1000);
    EXPECT_EQ(rig.drive.fault(), 0);
    EXPECT_EQ(rig.h[511], at);
    EXPECT_EQ(rig.h[492], at);
    // Further into the switch is the fault again, away from it is free.
    rig.go(at + sign * 1'000);
    rig.run(200);
    EXPECT_EQ(rig.drive.fault(), 29);
    rig.run(500);
    rig.drive.reset_fault();
    rig.run(2);
    rig.go(0);
    rig.run_to_target();
    EXPECT_EQ(rig.h[511], 0);
    EXPECT_EQ(rig.drive.fault(), 0);
  }
}

// What is told of a travel names the target that was ordered, not where the axis stops instead or where it is by then.
// Where nothing was ordered no target is named.
TEST(PositioningReports, NameTheOrderedTarget) {
  const auto check = [](const char* what, Rig::Settings settings, const std::function<void(Rig&)>& act, const char* told,
                        const std::string& target) {  // empty: none is named
    SCOPED_TRACE(what);
    Rig rig(settings);
    act(rig);
    EXPECT_TRUE(rig.said(told));
    EXPECT_EQ(rig.said("(target "), !target.empty());
    if (!target.empty()) {
      EXPECT_TRUE(rig.said("(target " + target + ", position "));
    }
  };
  const auto go = [](int32_t target) { return [target](Rig& rig) { rig.go(target), rig.run(2); }; };
  const auto until_fault = [](Rig& rig) { rig.run_until([&] { return rig.drive.fault() != 0; }); };
  const auto switch_at_40000 = [](Rig& rig) {
    rig.levels = [](int64_t at) { return static_cast<uint16_t>(kEnabled | (at < 40'000 ? 1 << 4 : 0) | 1 << 5); };
    rig.drive.reset_fault();
    rig.run(2);
  };
  check("limit switch", {{"603", 14}, {"604", 15}},
      [&](Rig& rig) {
        switch_at_40000(rig);
        rig.go(100'000);
        until_fault(rig);
      },
      "F29", "100000");
  check("limit switch, relative", {{"603", 14}, {"604", 15}},
      [&](Rig& rig) {
        switch_at_40000(rig);
        rig.go_by(70'000);
        rig.go_by(5'000);
        until_fault(rig);
      },
      "F29", "75000");
  check("mode without positioning", {{"700", 11}}, go(12'345), "F77", "12345");
  check("beyond the range", {}, [](Rig& rig) { rig.go(INT32_MAX), rig.go_by(10), rig.run(2); }, "F78", "2147483657");
  check("lag", {{"915", 0}, {"923", 2'000}}, [&](Rig& rig) { rig.go(400'000), until_fault(rig); }, "F42", "400000");
  check("ramp", {{"916", 1}},
      [](Rig& rig) { rig.go(400'000), rig.run(500), rig.service.set_parameter("911", 700), rig.run(2); }, "F99",
      "400000");
  check("overrun", {{"136", 20'000}, {"912", 1'000}, {"137", 200}},
      [](Rig& rig) {
        rig.go(100'000);
        rig.run_until([&] { return rig.h[511] > 100'000 - 25'600; });
        rig.drive.set_inputs(kEnabled & ~0b1000);
        rig.run(50);
        rig.drive.set_inputs(kEnabled);
        rig.run(2);
      },
      "F123", "100000");
  check("modulo off", {}, [](Rig& rig) { rig.h[454] = 777, rig.run(2); }, "H454", "777");
  check("reference travel", {{"903", 3}},
      [](Rig& rig) { rig.go(1'000), rig.run_to_target(), rig.positioner().start_reference(false, false), rig.run(3); },
      "F27", "");
  check("stop on the ramp", {{"915", 0}, {"923", 0}},
      [&](Rig& rig) {
        rig.go(400'000);
        rig.run(1'000);
        rig.positioner().stop_here();
        rig.service.set_parameter("923", 100);
        until_fault(rig);
      },
      "F42", "");
}

TEST(LimitSwitches, BothAtOnceAreF27) {
  LimitRig rig;
  rig.levels = {};
  rig.drive.set_inputs(kEnabled);
  rig.run(2);
  EXPECT_EQ(rig.drive.fault(), 27);
}

// Whatever a program orders and however often the enable goes: the setpoint stays within the limits, and the
// last target is reached, to the increment.
TEST(LimitProperties, NeverBeyondAndAlwaysThere) {
  EXPECT_TRUE(rc::check("never beyond the limits", [] {
    constexpr int32_t kHigh = 40'000, kLow = -30'000;
    Rig rig(
        {{"903", 5}, {"920", kHigh}, {"921", kLow}, {"911", 600}, {"912", 500}, {"136", 100}, {"131", 100}});
    rig.positioner().start_reference(false, false);
    rig.run(2);
    int32_t last = 0;
    const int orders = *rc::gen::inRange(1, 15);
    for (int n = 0; n < orders; ++n) {
      const int32_t target = *rc::gen::inRange(kLow - 3'000, kHigh + 3'000);
      switch (*rc::gen::inRange(0, 5)) {
        case 0: rig.go(target); break;
        case 1: rig.h[492] = target; break;
        case 2: rig.go_by(target / 4); break;
        case 3: rig.positioner().stop_here(); break;
        case 4: rig.drive.set_inputs(*rc::gen::arbitrary<bool>() ? kEnabled : uint16_t{0b0011}); break;
      }
      for (int ms = *rc::gen::inRange(1, 600); ms > 0; --ms) {
        rig.tick();
        RC_ASSERT(rig.h[491] <= kHigh && rig.h[491] >= kLow);
        RC_ASSERT(rig.h[511] <= kHigh + 60 && rig.h[511] >= kLow - 60);
      }
    }
    rig.drive.reset_fault();
    rig.drive.set_inputs(kEnabled);
    last = *rc::gen::inRange(kLow, kHigh + 1);
    rig.go(last);
    for (int ms = 0; ms < 5'000 && !rig.arrived(); ++ms) rig.tick();
    RC_ASSERT(rig.h[491] == last);
    RC_ASSERT(rig.h[492] == last);
    RC_ASSERT(rig.h[511] == last);
  }));
}

// Any 32-bit numbers anywhere: nothing overflows (the sanitizer build sees it), every position stays a
// position.
TEST(LimitProperties, ExtremesDoNotOverflow) {
  EXPECT_TRUE(rc::check("extremes", [] {
    const auto extreme = [] {
      return *rc::gen::element(INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX - 1, INT32_MAX,
                               *rc::gen::arbitrary<int32_t>());
    };
    Rig rig({{"903", 5},
             {"913", 5'000'000},
             {"914", 5'000'000},
             {"302", 5'500'000},
             {"911", 10},
             {"912", 10},
             {"923", INT32_MAX},
             {"960", *rc::gen::inRange(0, 4)},
             {"961", *rc::gen::element(1, 113'553, INT32_MAX)},
             {"962", *rc::gen::element(1, 1'088, INT32_MAX)},
             {"963", *rc::gen::element(1, 4'096)},
             {"942", *rc::gen::element(1, 32'767)},
             {"943", *rc::gen::element(1, 32'767)},
             {"941", *rc::gen::inRange(0, 3)}});
    for (int n = 0; n < 12; ++n) {
      const int32_t value = extreme();
      switch (*rc::gen::inRange(0, 9)) {
        case 0: rig.go(value); break;
        case 1: rig.h[492] = value; break;
        case 2: rig.go_by(value); break;
        case 3: rig.h[454] = value; break;
        case 4:
          rig.h[498] = value;
          rig.positioner().start_reference(false, false);
          break;
        case 5: rig.h[496] = value; break;
        case 6: rig.h[497] = value; break;
        case 7: rig.h[456] = value; break;
        case 8: rig.h[453] = value; break;
      }
      rig.run(30);
    }
    RC_ASSERT(rig.h[455] >= 0);
  }));
}

}  // namespace
}  // namespace ipos::tests
