// Mains that fail while the 24 V of the electronics stay: P520, P521, the input function MAINS ON (1053 1610 p. 77, 78), and the
// DC link, whose voltage these tests work out for themselves. That the power section is off below 60 % of its voltage at
// mains, 336 V, is ours.
#include <cmath>

#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kDrives[] = {"md60a", "compact", "mdxb"};

// Turns at 600 rpm without any torque: magnetizing current 60 % of IN, so losses of 20 % x 0.36 and the standby of 1 %.
MachineData heavy_machine() {
  MachineData machine = light_machine();
  machine.inertia = 400;
  return machine;
}

struct Turning : DriveRig {
  explicit Turning(std::string_view name, int32_t response = 0, int32_t time_ms = 0)
      : DriveRig(name, {}, heavy_machine()) {
    set("P604", 21);  // DI05: MAINS ON
    set("P520", time_ms);
    set("P521", response);
    set("P160", 600'000);
    set("P137", 500);
    enable_terminals();
    input("DI04", true);
    input("DI05", true);
    settle();
    run_ms(10);
    EXPECT_TRUE(stage());
  }
};

TEST(Mains, TheDcLinkHoldsTheDriveForAWhile) {
  constexpr double kTaken = 10'000 * (0.2 * 0.36 + 0.01);  // V² a millisecond
  for (const char* name : kDrives) {
    SCOPED_TRACE(name);
    Turning rig(name);
    rig.set("P604", 0);
    rig.run_ms(5);
    rig.drive.set_mains(false);
    const int left = static_cast<int>((560.0 * 560 - 336.0 * 336) / kTaken);  // 244 whole milliseconds above 336 V
    rig.run_ms(left);
    EXPECT_NEAR(rig.drive.axis().dc_link / 1'000.0, std::sqrt(560.0 * 560 - kTaken * left), 0.1);
    EXPECT_TRUE(rig.stage());
    EXPECT_FALSE(rig.drive.runs_on_24v());
    rig.run_ms(2);
    EXPECT_FALSE(rig.stage());
    EXPECT_TRUE(rig.drive.runs_on_24v());
    EXPECT_EQ(rig.drive.verdict().reason, Block::NoMains);
    EXPECT_EQ(rig.drive.condition(), UnitCondition::NotReady);
    EXPECT_EQ(rig.drive.display(), '0');
    EXPECT_EQ(rig.status(), 0x0000) << "neither ready nor enabled";
    EXPECT_EQ(rig.drive.fault(), 0);
  }
}

TEST(Mains, CardAndParametersLiveOn24V) {
  for (const char* name : {"md60a", "mdxb", "mc07", "mc31"}) {
    SCOPED_TRACE(name);
    DriveOptions options;
    options.mains = false;
    DriveRig rig(name, options);
    rig.run_ms(3);
    EXPECT_FALSE(rig.drive.mains());
    EXPECT_EQ(rig.drive.axis().dc_link, 0);
    EXPECT_EQ(rig.drive.display(), '0');
    EXPECT_EQ(rig.status() & 0x0002, 0) << "not ready";
    const char* ramp = std::string_view(name) == "mc31" ? "P120" : "P130";
    EXPECT_EQ(rig.write(ramp, 3'000), 0);
    EXPECT_EQ(rig.value(ramp), 3'000);
    rig.drive.power_cycle();
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.display(), '0') << "24 V off and on";
    rig.drive.set_mains(true);
    // 100 ms from empty: 60 % of the voltage are 36 % of the energy.
    rig.run_ms(35);
    EXPECT_TRUE(rig.drive.runs_on_24v());
    rig.run_ms(3);
    EXPECT_FALSE(rig.drive.runs_on_24v());
    EXPECT_NE(rig.status() & 0x0002, 0) << "ready";
    rig.run_ms(70);
    EXPECT_EQ(rig.drive.axis().dc_link, 560'000);
  }
}

TEST(Mains, WhatWasEnabledGoesOnWhenTheyAreBack) {
  Turning rig("mdxb");
  rig.set("P604", 0);
  rig.drive.set_mains(false);
  rig.run_ms(4'000);
  EXPECT_EQ(rig.drive.axis().dc_link, 0);
  rig.drive.set_mains(true);
  rig.run_ms(40);
  EXPECT_TRUE(rig.stage());
  rig.settle();
  EXPECT_EQ(rig.drive.axis().speed, 600'000);
}

// P520: the response comes with the first millisecond after the time, P521 = 0 inhibits.
TEST(Mains, TheInputInhibitsAfterItsTime) {
  PROVES("DRV-08");
  for (const char* name : kDrives)
    for (const int32_t time : {0, 1, 120}) {
      SCOPED_TRACE(time);
      Turning rig(name, 0, time);
      rig.input("DI05", false);
      rig.run_ms(time);
      EXPECT_TRUE(rig.stage());
      rig.run_ms(1);
      EXPECT_FALSE(rig.stage());
      EXPECT_EQ(rig.drive.verdict().reason, Block::MainsOff);
      EXPECT_EQ(rig.drive.condition(), UnitCondition::ControllerInhibit);
      EXPECT_EQ(rig.drive.axis().dc_link, 560'000) << "the mains are there";
      rig.input("DI05", true);
      rig.run_ms(1);
      EXPECT_TRUE(rig.stage());
    }
}

TEST(Mains, AShortFailureIsNoReason) {
  Turning rig("md60a", 0, 100);
  for (int n = 0; n < 3; ++n) {
    rig.input("DI05", false);
    rig.run_ms(100);
    rig.input("DI05", true);
    rig.run_ms(1);
    EXPECT_TRUE(rig.stage());
  }
}

// P521 = 1: the ramp of P137, 0.5 s for 3000 rpm, so 100 ms from 600 rpm; what it gives back goes into the DC link.
TEST(Mains, TheInputStopsByTheEmergencyRamp) {
  PROVES("DRV-08");
  for (const char* name : kDrives) {
    SCOPED_TRACE(name);
    Turning rig(name, 1);
    rig.drive.set_mains(false);  // the relay hangs on them
    rig.run_ms(50);
    EXPECT_NEAR(rig.rpm(), 300, 7);
    EXPECT_EQ(rig.drive.verdict().reason, Block::MainsOff);
    EXPECT_GT(rig.drive.axis().dc_link, 560'000);
    rig.run_ms(55);
    EXPECT_EQ(rig.rpm(), 0);
    rig.run_ms(10);
    EXPECT_FALSE(rig.stage());
    rig.drive.set_mains(true);
    rig.settle();
    EXPECT_EQ(rig.drive.axis().speed, 600'000);
  }
}

// One that decides only what has changed is like one that decides everything every millisecond.
TEST(Mains, DecisionsAreAsIfMadeAnew) {
  Turning some("mdxb", 1, 30), all("mdxb", 1, 30);
  for (int ms = 0; ms < 6'000; ++ms) {
    for (Turning* rig : {&some, &all}) {
      if (ms == 100) rig->drive.set_mains(false);
      if (ms == 120 || ms == 4'500) rig->drive.set_mains(true);
      if (ms == 400) rig->drive.set_mains(false);
      if (ms == 5'000) rig->input("DI05", false);
      if (ms == 5'500) rig->input("DI05", true);
    }
    all.drive.forget_decisions();
    some.run_ms(1), all.run_ms(1);
    ASSERT_EQ(some.drive.axis(), all.drive.axis()) << ms;
    ASSERT_EQ(some.status(), all.status()) << ms;
  }
}

}  // namespace
}  // namespace ipos::tests
