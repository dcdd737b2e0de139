// Control words of MOVITRAC 07: what each bit does and which control source wins (its manual, chapters 6.2
// and 6.3). Times are those of the ramps: rpm x parameter / 1500.
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

struct BusRig : DriveRig {
  explicit BusRig(DriveOptions options = {}, const MachineData& machine = light_machine())
      : DriveRig("mc07", options, machine) {
    bus_control();
  }
  // At 1000 rpm by 0006h.
  void run_up(uint16_t third = 0) {
    po({0x0006, 5000, third});
    settle();
    EXPECT_EQ(rpm(), 1000);
  }
  void word(uint16_t control, uint16_t third = 0) { po({control, 5000, third}); }
};

TEST(M07Control, LowByteIsTheSameInBothControlWords) {
  PROVES("M07-CW-01", "M07-CW-08");
  for (const int32_t assignment : {9, 10})
    for (uint16_t word = 0; word < 256; ++word) {
      BusRig rig;
      rig.set("P870", assignment);
      rig.word(word);
      rig.run_ms(50);
      // Bits 3 to 7 mean nothing without a fault (chapter 6.2).
      const int low = word & 7;
      const int want = (low & 1) != 0 ? 1 : low == 6 ? 4 : 2;
      EXPECT_EQ(rig.state(), want) << assignment << " " << word;
      EXPECT_EQ(rig.rpm() != 0, low == 6) << assignment << " " << word;
    }
}

TEST(M07Control, Bit0IsInhibit) {
  PROVES("M07-CW-02", "M07-SW-01");
  BusRig rig;
  rig.run_up();
  EXPECT_EQ(rig.status() & 1, 1);
  EXPECT_TRUE(rig.brake_released());
  rig.word(0x0007);
  rig.run_ms(1);
  EXPECT_FALSE(rig.stage());
  EXPECT_EQ(rig.status() & 1, 0);
  EXPECT_FALSE(rig.brake_released());
  EXPECT_EQ(rig.state(), 1);
  rig.word(0x0006);
  rig.run_ms(1);
  EXPECT_EQ(rig.status() & 1, 1);
}

TEST(M07Control, Bit1IsRapidStopOnP136) {
  PROVES("M07-CW-03");
  BusRig rig;
  rig.set("P136", 600);
  rig.run_up();
  rig.word(0x0004);
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 600), kRampTolerance);
}

TEST(M07Control, Bit2IsStopOnP131) {
  PROVES("M07-CW-04");
  BusRig rig;
  rig.set("P131", 3000);
  rig.run_up();
  rig.word(0x0002);
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 3000), kRampTolerance);
}

TEST(M07Control, PriorityOfTheThreeBits) {
  PROVES("M07-CW-07");
  enum Expect { Rapid, Inhibit, Stop, Enable };
  constexpr Expect kTable[] = {Rapid, Inhibit, Stop, Inhibit, Rapid, Inhibit, Enable, Inhibit};
  for (uint16_t word = 0; word < 8; ++word) {
    BusRig rig;
    rig.set("P136", 500);
    rig.run_up();
    rig.word(word);
    rig.run_ms(100);
    switch (kTable[word]) {
      case Inhibit: EXPECT_FALSE(rig.stage()) << word; break;
      case Rapid: EXPECT_NEAR(rig.rpm(), 1000 - 1500 * 100 / 500, 4) << word; break;
      case Stop: EXPECT_NEAR(rig.rpm(), 1000 - 1500 * 100 / 2000, 4) << word; break;
      case Enable: EXPECT_EQ(rig.rpm(), 1000) << word; break;
    }
  }
}

// The warning about them is in tests/runtime/plant.
TEST(M07Control, ReservedBitsDoNothing) {
  PROVES("M07-CW-06");
  for (const unsigned bit : {3U, 4U, 5U, 7U, 14U, 15U}) {
    BusRig rig;
    rig.run_up();
    const uint16_t before = rig.status();
    rig.word(static_cast<uint16_t>(0x0006 | 1U << bit));
    rig.run_ms(100);
    EXPECT_EQ(rig.rpm(), 1000) << bit;
    EXPECT_EQ(rig.status(), before) << bit;
    EXPECT_EQ(rig.drive.reserved_control_bits(), 1U << bit);
  }
}

TEST(M07Control, ZeroIsTheSafeState) {
  PROVES("M07-CW-09");
  BusRig rig;
  rig.set("P136", 400);
  rig.set("P736", 200);
  rig.run_up();
  rig.word(0);
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 400), kRampTolerance);
  rig.run_ms(100);
  EXPECT_TRUE(rig.stage()) << "the motor holds until the brake is in";
  EXPECT_FALSE(rig.brake_released());
  rig.run_ms(110);
  EXPECT_FALSE(rig.stage());
  EXPECT_FALSE(rig.brake_released());
  EXPECT_EQ(rig.state(), 2);
}

TEST(M07Control, TheMostRestrictiveSourceWins) {
  PROVES("M07-CW-10", "M07-CW-11");
  BusRig rig;
  rig.run_up();
  rig.input("DI03", false);  // ENABLE/STOP
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 2000), kRampTolerance)
      << "bus enable, terminal stop";
  EXPECT_EQ(rig.state(), 2);
  rig.input("DI03", true);
  rig.settle();
  EXPECT_EQ(rig.rpm(), 1000);
  rig.input("DI01", false);  // CW/STOP
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 2000), kRampTolerance);
  EXPECT_EQ(rig.state(), 2);
  rig.input("DI01", true);
  rig.settle();
  rig.word(0x0007);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 1) << "bus inhibit, terminal enable";
  rig.word(0x0006);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 4);
  rig.program_word(1U << 30);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 1) << "inhibit by the program, both others enable";
  EXPECT_FALSE(rig.stage());

  BusRig inhibit;
  inhibit.set("P602", 32);  // DI03 CONTROL.INHIBIT
  inhibit.run_up();
  inhibit.input("DI03", false);
  inhibit.run_ms(1);
  EXPECT_EQ(inhibit.state(), 1) << "terminal inhibit, bus enable";
}

TEST(M07Control, TheSignOfTheBusSetpointIsTheDirection) {
  PROVES("M07-CW-12", "M07-PD-04");
  for (const char* terminal : {"DI01", "DI02"})
    for (const int sign : {1, -1}) {
      BusRig rig;
      rig.input("DI01", false);
      rig.input(terminal, true);
      rig.po({0x0006, sign > 0 ? uint16_t{0x07D0} : uint16_t{0xF15A}, 0});
      const int32_t before = rig.drive.axis().position;
      rig.settle();
      EXPECT_EQ(rig.rpm(), sign > 0 ? 400 : -750) << terminal;
      EXPECT_EQ(rig.drive.axis().position > before, sign > 0) << terminal;
    }
  BusRig rig;
  rig.input("DI01", false);
  rig.po({0x0006, 2000, 0});
  rig.run_ms(500);
  EXPECT_EQ(rig.rpm(), 0);
  EXPECT_FALSE(rig.stage());
}

TEST(M07Control, OtherFunctionsAreOrCombined) {
  PROVES("M07-CW-13");
  BusRig rig;
  rig.set("P604", 12);  // DI05 FAULT RESET
  rig.run_up();
  rig.drive.raise_fault(1);
  rig.run_ms(10);
  EXPECT_EQ(rig.drive.fault(), 1);
  rig.input("DI05", true);
  rig.run_ms(20);
  EXPECT_EQ(rig.drive.fault(), 0) << "reset by the terminal, bit 6 of the bus is 0";
  EXPECT_EQ(rig.state(), 4);
  // Motor potentiometer up: terminal, bus, program.
  for (const int source : {0, 1, 2}) {
    BusRig pot;
    pot.set("P100", 4);
    pot.set("P603", 9);  // DI04 MOTOR POT UP
    pot.po({source == 1 ? uint16_t{0x0206} : uint16_t{0x0006}, 0, 0});
    if (source == 0) pot.input("DI04", true);
    if (source == 2) pot.program_word(1U << 9);
    pot.run_ms(2000);
    EXPECT_NEAR(pot.drive.setpoint().speed, 150'000, 200) << source;  // 1500 rpm in 20 s
  }
}

// Full torque of the brake against the bare rotor with its load: rated speed in 50 ms x (1 + inertia) by the
// rated torque (machine data of the test).
TEST(M07Control, InhibitBrakesOrCoasts) {
  PROVES("M07-CW-14");
  for (const bool brake : {true, false}) {
    MachineData machine;
    machine.inertia = 400;
    machine.friction = 5'000;
    machine.brake_torque = 200'000;
    machine.brake = brake;
    BusRig rig({}, machine);
    rig.run_up();
    rig.word(0x0001);
    rig.run_ms(1);
    EXPECT_FALSE(rig.stage()) << "high impedance";
    EXPECT_EQ(rig.drive.axis().output_current, 0);
    const double per_ms = 1500.0 / (50 * 5) * (brake ? 2.05 : 0.05);
    EXPECT_NEAR(rig.rpm(), 1000 - per_ms, 0.1);
    const int ms = 1 + rig.ms_until([&] { return rig.drive.axis().standing; });
    EXPECT_NEAR(ms, 1000 / per_ms, 1.5) << brake;
  }
}

TEST(M07Control, ProcessRampActsOnStopAndEnableOnly) {
  PROVES("M07-CW-15", "M07-CW-16", "M07-CW-17");
  BusRig rig;
  rig.set("P872", 8);
  rig.set("P136", 1000);
  rig.word(0x0006, 3000);
  EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() == 1000; }), m07_ramp_ms(1000, 3000), kRampTolerance);
  rig.word(0x0004, 10'000);
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 1000), kRampTolerance) << "rapid stop: P136";
  rig.word(0x0006, 500);
  EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() == 1000; }), m07_ramp_ms(1000, 500), kRampTolerance);
  rig.word(0x0002, 500);
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 500), kRampTolerance) << "stop: process ramp";

  BusRig plain;
  plain.set("P130", 1500);
  plain.set("P131", 2500);
  plain.word(0x0006, 500);
  EXPECT_NEAR(plain.ms_until([&] { return plain.rpm() == 1000; }), m07_ramp_ms(1000, 1500), kRampTolerance);
  plain.word(0x0002, 500);
  EXPECT_NEAR(plain.ms_until_standing(), m07_ramp_ms(1000, 2500), kRampTolerance) << "P872 = 0: P131";
}

TEST(M07Control, MotorPotentiometerByControlWord) {
  PROVES("M07-CW-18", "M07-CW-19");
  BusRig rig;
  rig.set("P100", 4);
  const auto run = [&](uint16_t word) {
    rig.word(word);
    rig.run_ms(1000);
    return rig.drive.setpoint().speed / 1000.0;
  };
  // 1500 rpm in 20 s are 75 rpm a second.
  EXPECT_NEAR(run(0x0206), 75, 0.1);
  EXPECT_NEAR(run(0x0206), 150, 0.1);
  EXPECT_NEAR(run(0x0606), 150, 0.1) << "both bits: no change";
  EXPECT_NEAR(run(0x0006), 150, 0.1);
  EXPECT_NEAR(run(0x0406), 75, 0.1);
  EXPECT_NEAR(run(0x0306), -150, 0.1) << "bit 8: the speed grows in the CCW direction";
  EXPECT_NEAR(run(0x0306), -225, 0.1);
  rig.run_ms(1000);
  EXPECT_LT(rig.rpm(), -225);
}

TEST(M07Control, MotorPotentiometerIgnoresTheProcessRamp) {
  PROVES("M07-CW-23");
  // 75 rpm a second in both directions, whether the process ramp is faster or slower.
  for (const uint16_t ramp : {uint16_t{100}, uint16_t{60'000}}) {
    BusRig rig;
    rig.set("P872", 8);
    rig.set("P100", 4);
    rig.word(0x0206, ramp);
    rig.run_ms(4000);
    EXPECT_NEAR(rig.rpm(), 300, 0.2) << ramp;
    rig.word(0x0406, ramp);
    rig.run_ms(2000);
    EXPECT_NEAR(rig.rpm(), 150, 0.2) << ramp;
  }
}

TEST(M07Control, FixedSetpointsByControlWord) {
  PROVES("M07-CW-20", "M07-CW-21");
  BusRig rig;
  rig.set("P100", 1);
  for (const auto& [number, speed] :
       {std::pair{"P160", 100}, {"P161", 200}, {"P162", 300}, {"P170", 400}, {"P171", 500}, {"P172", 600}})
    rig.set(number, speed * 1000);
  for (const auto& [word, want] :
       {std::pair{0x0806, 100}, {0x1006, 200}, {0x1806, 300}, {0x2806, 400}, {0x3006, 500}, {0x3806, 600}}) {
    rig.word(static_cast<uint16_t>(word));
    EXPECT_EQ(rig.setpoint_rpm(), want) << word;
  }
}

TEST(M07Control, TheSourceOfP100DecidesWithoutInternalSetpoint) {
  PROVES("M07-CW-22");
  BusRig rig;
  rig.set("P100", 1);
  rig.ai1(2000);
  rig.word(0x0806);
  EXPECT_EQ(rig.setpoint_rpm(), 150) << "n11";
  rig.word(0x0006);
  EXPECT_EQ(rig.setpoint_rpm(), 300) << "AI1: 2 V of 10 V, P302 = 1500";
  rig.set("P100", 10);
  EXPECT_EQ(rig.setpoint_rpm(), 1000);
}

TEST(M07Control, ControlWordOfTheProgram) {
  PROVES("M07-CW-26");
  BusRig rig;
  rig.run_up();
  rig.program_word(1U << 1);
  EXPECT_NEAR(rig.ms_until_standing(), m07_ramp_ms(1000, 2000), kRampTolerance);
  EXPECT_EQ(rig.state(), 2);
  rig.program_word(1U << 30);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 1);
  rig.program_word(1U << 11);
  rig.run_ms(1);
  EXPECT_NE(rig.status() & 0x20, 0);
  EXPECT_EQ(rig.status() & 0x02, 0);
  EXPECT_EQ(rig.drive.fault(), 26);
}

TEST(M07Status, WarningAndFaultInMotion) {
  PROVES("M07-SW-04", "M07-SW-07");
  BusRig rig;
  rig.run_up();
  rig.drive.raise_fault(47, FaultResponse::Display);
  rig.run_ms(100);
  EXPECT_EQ(rig.status() & 0x22, 0x22) << "warning: ready and reported";
  EXPECT_EQ(rig.rpm(), 1000);
  rig.drive.reset_fault();
  EXPECT_EQ(rig.status() & 0x22, 0x02);
  rig.drive.raise_fault(1);
  rig.run_ms(1);
  EXPECT_EQ(rig.status() & 0x22, 0x20) << "fault: not ready";
  EXPECT_FALSE(rig.stage());
}

TEST(M07Status, CompositeWords) {
  PROVES("M07-SW-10");
  BusRig rig;
  rig.set("P815", 500);
  rig.word(0x0001);
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.pi()[0], 0x0106);
  rig.word(0x0000);
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.pi()[0], 0x0206);
  rig.word(0x0006);
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.pi()[0], 0x0407);
  rig.set("P710", 10'000);
  rig.word(0x0000);
  rig.ms_until_standing();
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.pi()[0], 0x0307);
  rig.word(0x0006);
  rig.run_ms(100);
  rig.silence();
  rig.run_ms(3000);
  EXPECT_EQ(rig.drive.pi()[0], 0x2F24);
}

TEST(M07Status, StatesZeroToFive) {
  PROVES("M07-SW-09");
  DriveOptions options;
  options.start_up_ms = 300;
  BusRig rig(options);
  rig.word(0x0006);
  rig.run_ms(299 - BusRig::kTicksBefore);
  EXPECT_EQ(rig.status(), 0x0004) << "not ready: bit 1 and the state are 0";
  EXPECT_FALSE(rig.stage());
  rig.word(0x0000);
  rig.run_ms(1);
  EXPECT_EQ(rig.status(), 0x0206);
  rig.word(0x0001);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 1);
  rig.word(0x0000);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 2);
  rig.set("P710", 1000);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 3);
  rig.word(0x0006);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 4);
  rig.word(0x0001);
  rig.run_ms(1);
  EXPECT_EQ(rig.write("P802", 1), 0);
  EXPECT_EQ(rig.state(), 5);
}

TEST(M07Status, BasicBlockOfAnEnabledDriveIsSeven) {
  BusRig rig;
  rig.run_up();
  EXPECT_EQ(rig.drive.pi()[0], 1031);
  EXPECT_EQ(rig.drive.pi()[0] & 0xFF, 7);
}

}  // namespace
}  // namespace ipos::tests
