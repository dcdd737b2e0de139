// Setpoints, ramps and switchovers of MOVIDRIVE (1053 1610 p. 72-80). Ramp times hold for 3000 rpm.
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

struct Mdx : DriveRig {
  Mdx() : DriveRig("md60a") {
    enable_terminals();
    set("P115", 0);
  }
  void ai2(int32_t millivolt) {
    auto analog = drive.analog();
    analog.ai2 = {millivolt, 0};
    drive.set_analog(analog);
  }
};

TEST(MovidriveSetpoint, BipolarAndUnipolar) {
  Mdx rig;
  rig.ai1(-4000);
  rig.set("P100", 0);
  EXPECT_EQ(rig.setpoint_rpm(), -600);
  rig.set("P100", 1);
  EXPECT_EQ(rig.setpoint_rpm(), 600) << "the amount";
  rig.input("DI01", false);
  rig.input("DI02", true);
  EXPECT_EQ(rig.setpoint_rpm(), -600) << "CCW by terminal";
}

// P112: modes 0, 1, 5, 6 as MOVITRAC 07; 2 to 4 are lines through (P113, P114) and (10 V, maximum), ours.
TEST(MovidriveSetpoint, ModesOfAi1) {
  PROVES("DRV-11");
  const auto at = [](int32_t mode, int32_t millivolt, int32_t microampere) {
    Mdx rig;
    rig.set("P100", 0);
    rig.set("P302", 2'000'000);
    rig.set("P112", mode);
    rig.set("P113", 2000);
    rig.set("P114", 400'000);
    auto analog = rig.drive.analog();
    analog.ai1 = {millivolt, microampere};
    rig.drive.set_analog(analog);
    return rig.setpoint_rpm();
  };
  EXPECT_EQ(at(0, 5000, 0), 1500);
  EXPECT_EQ(at(1, 5000, 0), 1000);
  EXPECT_EQ(at(2, 2000, 0), 0);
  EXPECT_EQ(at(2, 6000, 0), 1000);
  EXPECT_EQ(at(3, 0, 0), 400);
  EXPECT_EQ(at(3, 5000, 0), 1200);
  EXPECT_EQ(at(4, 2000, 0), 400);
  EXPECT_EQ(at(4, 6000, 0), 1200);
  for (const int32_t mode : {2, 3, 4}) EXPECT_EQ(at(mode, 10'000, 0), 2000) << mode;
  EXPECT_EQ(at(5, 0, 15'000), 1500);
  EXPECT_EQ(at(6, 0, 8000), 500);
}

TEST(MovidriveSetpoint, OffsetFactorAndFilterOfAi1) {
  PROVES("DRV-11");
  Mdx rig;
  rig.set("P100", 0);
  rig.ai1(1900);
  rig.set("P111", 100);
  EXPECT_EQ(rig.setpoint_rpm(), 300) << "2 V of 10 V of 1500 rpm";
  rig.set("P110", 500);
  EXPECT_EQ(rig.setpoint_rpm(), 150);
  // First order: 63.2 % after the time constant.
  rig.set("P115", 50'000);
  rig.set("P110", 1000);
  rig.ai1(9900);
  rig.run_ms(50);
  EXPECT_NEAR(rig.drive.setpoint().speed / 1000.0, 150 + 0.632 * 1350, 15);
  rig.run_ms(1000);
  EXPECT_EQ(rig.setpoint_rpm(), 1500);
}

TEST(MovidriveSetpoint, SecondAnalogInput) {
  PROVES("DRV-12");
  Mdx rig;
  rig.set("P100", 0);
  rig.ai1(2000);
  rig.ai2(1000);
  EXPECT_EQ(rig.setpoint_rpm(), 300) << "P120 = 0";
  rig.set("P120", 1);
  EXPECT_EQ(rig.setpoint_rpm(), 450);
  rig.ai2(-4000);
  EXPECT_EQ(rig.setpoint_rpm(), -300);

  // P120 = 2: 0..10 V are 0..P303. 72.1 % of current make 50 % torque: 1500 rpm of the bare rotor in 100 ms.
  Mdx limit;
  limit.set("P100", 0);
  limit.set("P130", 0);
  limit.set("P303", 144'000);
  limit.set("P120", 2);
  limit.ai2(5007);
  limit.ai1(10'000);
  limit.run_ms(50);
  EXPECT_NEAR(limit.drive.axis().output_current, 72'100, 200);
  EXPECT_NEAR(50 + limit.ms_until([&] { return limit.rpm() == 1500; }), 100, kRampTolerance);
}

TEST(MovidriveSetpoint, FixedSetpointsAndTheirSums) {
  Mdx rig;
  rig.set("P602", 6);  // DI03 FIX SETPT SW.OV
  rig.input("DI03", false);
  rig.ai1(2000);
  rig.set("P170", 500'000);
  const auto at = [&](int32_t p100, bool n11, bool other) {
    rig.set("P100", p100);
    rig.input("DI04", n11);
    rig.input("DI03", other);
    return rig.setpoint_rpm();
  };
  for (const int32_t p100 : {0, 1, 4}) {
    EXPECT_EQ(at(p100, true, false), 150) << p100;
    EXPECT_EQ(at(p100, true, true), 500) << p100;
  }
  EXPECT_EQ(at(6, true, false), 450);
  EXPECT_EQ(at(6, true, true), 800);
  EXPECT_EQ(at(6, false, false), 300);
  EXPECT_EQ(at(7, true, false), 30);
  EXPECT_EQ(at(7, true, true), 100);
  EXPECT_EQ(at(10, true, false), 0) << "a bus takes no fixed setpoint";
  EXPECT_EQ(rig.drive.setpoint().note, SetpointNote::NoBusData);
}

TEST(MovidriveSetpoint, MotorPotentiometer) {
  Mdx rig;
  rig.set("P100", 4);
  rig.set("P603", 9);   // DI04 MOTOR POT UP
  rig.set("P604", 10);  // DI05 MOTOR POT DOWN
  rig.set("P150", 10'000);
  rig.set("P151", 5000);
  rig.set("P301", 60'000);
  rig.set("P302", 900'000);
  EXPECT_EQ(rig.setpoint_rpm(), 60) << "starts at the minimum";
  rig.input("DI04", true);
  rig.run_ms(1000);  // 3000 rpm in 10 s
  EXPECT_NEAR(rig.drive.setpoint().speed, 360'000, 400);
  rig.input("DI05", true);
  rig.run_ms(1000);
  EXPECT_NEAR(rig.drive.setpoint().speed, 360'000, 400) << "both: no change";
  rig.input("DI04", false);
  rig.run_ms(300);  // 3000 rpm in 5 s
  EXPECT_NEAR(rig.drive.setpoint().speed, 180'000, 1000);
  rig.input("DI05", false);
  rig.input("DI04", true);
  rig.run_ms(10'000);
  EXPECT_EQ(rig.drive.setpoint().speed, 900'000) << "ends at the maximum";
  rig.input("DI04", false);
  // Without enable it falls back to the minimum, with P152 = ON it stays.
  for (const int32_t keep : {1, 0}) {
    rig.set("P152", keep);
    rig.input("DI03", false);
    rig.run_ms(10);
    rig.input("DI03", true);
    EXPECT_EQ(rig.setpoint_rpm(), keep == 1 ? 900 : 60);
  }
  // P100 = 5 adds AI1.
  rig.set("P100", 5);
  rig.ai1(1000);
  EXPECT_EQ(rig.setpoint_rpm(), 60 + 90);
}

TEST(MovidriveSetpoint, SetpointHold) {
  Mdx rig;
  rig.set("P604", 20);  // DI05 SETPOINT HOLD
  rig.ai1(2000);
  rig.settle();
  rig.input("DI05", true);
  rig.ai1(8000);
  rig.run_ms(2000);
  EXPECT_EQ(rig.rpm(), 300);
  rig.input("DI05", false);
  rig.settle();
  EXPECT_EQ(rig.rpm(), 1200);
}

TEST(MovidriveSetpoint, StopFunctionOfBothSets) {
  PROVES("DRV-13");
  for (const bool second : {false, true}) {
    Mdx rig;
    rig.set("P604", 7);  // DI05 PAR. SWITCHOVER
    rig.input("DI05", second);
    rig.set(second ? "P723" : "P720", 1);
    rig.set(second ? "P724" : "P721", 100'000);
    rig.set(second ? "P725" : "P722", 50'000);
    rig.set("P311", 0);
    rig.set("P100", 10);
    const auto runs_at = [&](int rpm) {
      rig.po({0, static_cast<uint16_t>(rpm * 5), 0});
      rig.run_ms(600);
      return rig.rpm() != 0;
    };
    EXPECT_TRUE(runs_at(160)) << second;
    EXPECT_TRUE(runs_at(101)) << second;
    EXPECT_FALSE(runs_at(99)) << second;
    EXPECT_EQ(rig.drive.verdict().reason, Block::StopFunction);
    EXPECT_FALSE(runs_at(149)) << second;
    EXPECT_TRUE(runs_at(-151)) << second;
  }
}

// Below its middle to the lower edge, from there to the upper one (ours).
TEST(MovidriveSetpoint, SkipWindow) {
  PROVES("DRV-14");
  Mdx rig;
  rig.bus_control();
  rig.set("P740", 600'000);
  rig.set("P741", 200'000);
  for (const auto& [sent, want] : {std::pair{499, 499},
                                   {500, 500},
                                   {501, 500},
                                   {599, 500},
                                   {600, 700},
                                   {699, 700},
                                   {700, 700},
                                   {701, 701},
                                   {-550, -500},
                                   {-650, -700}}) {
    rig.po({0x0006, static_cast<uint16_t>(sent * 5), 0});
    EXPECT_EQ(rig.setpoint_rpm(), want) << sent;
    EXPECT_EQ(rig.drive.setpoint().note == SetpointNote::Skipped, sent != want) << sent;
    rig.settle();
    EXPECT_EQ(rig.rpm(), want) << sent << ": the ramp passes through";
  }
  rig.set("P302", 650'000);  // the upper edge is beyond the maximum
  rig.po({0x0006, 640 * 5, 0});
  EXPECT_EQ(rig.setpoint_rpm(), 500);
  rig.set("P301", 550'000);  // the lower one below the minimum
  rig.set("P302", 1'500'000);
  rig.po({0x0006, 560 * 5, 0});
  EXPECT_EQ(rig.setpoint_rpm(), 700);
}

TEST(MovidriveSetpoint, ChangeOfDirection) {
  PROVES("DRV-15");
  Mdx rig;
  rig.bus_control();
  rig.set("P350", 1);
  rig.set("P130", 600);
  rig.set("P132", 3000);
  rig.po({0x0006, 5000, 0});
  EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() == -1000; }), mdx_ramp_ms(1000, 600), kRampTolerance)
      << "CW ramp, though the shaft turns the other way";
  EXPECT_EQ(rig.drive.pi()[1], 5000) << "the speed reads as it was ordered";
  EXPECT_EQ(rig.value("P000"), 1'000'000);
  EXPECT_EQ(rig.write("P350", 0), 0x1C) << "under controller inhibit only";
}

TEST(MovidriveRamps, FourOfSetOne) {
  Mdx rig;
  rig.bus_control();
  rig.set("P130", 300);
  rig.set("P131", 600);
  rig.set("P132", 1200);
  rig.set("P133", 1500);
  const auto ms_to = [&](int rpm) {
    rig.po({0x0006, static_cast<uint16_t>(rpm * 5), 0});
    return rig.ms_until([&] { return rig.rpm() == rpm; });
  };
  EXPECT_NEAR(ms_to(1000), mdx_ramp_ms(1000, 300), kRampTolerance);
  EXPECT_NEAR(ms_to(-1000), mdx_ramp_ms(1000, 600) + mdx_ramp_ms(1000, 1200), kRampTolerance);
  EXPECT_NEAR(ms_to(0), mdx_ramp_ms(1000, 1500), kRampTolerance);
}

TEST(MovidriveRamps, SwitchoverWithSPattern) {
  for (const int by : {0, 1, 2}) {  // terminal, control word, program
    for (const auto& [pattern, rounding] : {std::pair{0, 0}, {1, 3000 / 8}, {2, 3000 / 4}}) {
      Mdx rig;
      rig.bus_control();
      rig.set("P134", 3000);
      rig.set("P135", pattern);
      rig.set("P604", 8);  // DI05 RAMP SWITCHOVER
      if (by == 0) rig.input("DI05", true);
      if (by == 2) rig.program_word(1U << 8);
      const uint16_t enable = by == 1 ? 0x0016 : 0x0006;
      rig.po({enable, 5000, 0});
      EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() == 1000; }), mdx_ramp_ms(1000, 3000) + rounding, 5)
          << by << pattern;
      EXPECT_NE(rig.status() & 0x08, 0) << "integrator set 2";
      rig.po({static_cast<uint16_t>(enable & ~4U), 5000, 0});
      EXPECT_NEAR(rig.ms_until_standing(), 1000, 5 + rounding) << "a stop is linear, on t12";
    }
  }
}

TEST(MovidriveRamps, ProcessRampReplacesBoth) {
  Mdx rig;
  rig.bus_control();
  rig.set("P872", 8);
  rig.po({0x0016, 5000, 1500});
  EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() == 1000; }), mdx_ramp_ms(1000, 1500), kRampTolerance);
}

TEST(MovidriveRamps, HoldControlHoldsWithTorque) {
  for (const bool by_bus : {false, true}) {
    Mdx rig;
    rig.bus_control();
    rig.set("P131", 1200);
    rig.set("P604", 13);  // DI05 /HOLD CONTROL
    rig.input("DI05", true);
    rig.po({0x0006, 5000, 0});
    rig.settle();
    if (by_bus)
      rig.po({0x000E, 5000, 0});
    else
      rig.input("DI05", false);
    EXPECT_NEAR(rig.ms_until_standing(), mdx_ramp_ms(1000, 1200), kRampTolerance);
    rig.run_ms(2000);
    EXPECT_TRUE(rig.stage());
    EXPECT_TRUE(rig.brake_released());
    EXPECT_EQ(rig.state(), 7);
  }
}

TEST(MovidriveSets, SwitchoverWhileTheOutputStageIsOff) {
  for (const bool by_bus : {false, true}) {
    Mdx rig;
    rig.bus_control();
    rig.set("P604", 7);  // DI05 PAR. SWITCHOVER
    rig.set("P333", 0);
    rig.set("P311", 0);
    rig.set("P312", 600'000);
    rig.set("P140", 1500);
    rig.set("P132", 0);
    const uint16_t enable = by_bus ? 0x0026 : 0x0006;
    rig.po({0x0006, 10'000, 0});
    rig.settle();
    EXPECT_EQ(rig.rpm(), 1500);
    rig.input("DI05", !by_bus);
    rig.po({enable, 10'000, 0});
    rig.run_ms(100);
    EXPECT_EQ(rig.rpm(), 1500) << "not while it runs";
    EXPECT_EQ(rig.status() & 0x10, 0);
    rig.po({static_cast<uint16_t>(enable | 1U), 10'000, 0});
    rig.run_ms(2000);
    EXPECT_NE(rig.status() & 0x10, 0) << "parameter set 2";
    rig.po({enable, 10'000, 0});
    EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() == 600; }), mdx_ramp_ms(600, 1500), kRampTolerance);
    rig.run_ms(100);
    EXPECT_EQ(rig.rpm(), 600) << "P312";
  }
}

TEST(MovidriveSources, P100AndP101AreChangedUnderInhibit) {
  Mdx rig;
  rig.ai1(2000);
  rig.settle();
  EXPECT_EQ(rig.write("P100", 10), 0x1C);
  EXPECT_EQ(rig.write("P101", 3), 0x1C);
  EXPECT_EQ(rig.rpm(), 300);
  rig.input("DI00", false);
  rig.run_ms(1000);
  EXPECT_EQ(rig.write("P100", 10), 0);
  EXPECT_EQ(rig.write("P101", 3), 0);
  rig.input("DI00", true);
  rig.run_ms(100);
  EXPECT_EQ(rig.rpm(), 0) << "no control word yet";
  rig.po({0x0006, 5000, 0});
  rig.settle();
  EXPECT_EQ(rig.rpm(), 1000);
  // Back to the terminals.
  rig.input("DI00", false);
  rig.run_ms(1000);
  EXPECT_EQ(rig.write("P100", 1), 0);
  EXPECT_EQ(rig.write("P101", 0), 0);
  rig.input("DI00", true);
  rig.po({0x0000, 5000, 0});
  rig.settle();
  EXPECT_EQ(rig.rpm(), 300);
}

TEST(MovidriveLimits, LimitSwitchesStopTheirDirectionOnly) {
  Mdx rig;
  rig.bus_control();
  rig.set("P137", 300);
  rig.set("P603", 14);  // DI04 /LIM. SWITCH CW
  rig.set("P604", 15);  // DI05 /LIM. SWITCH CCW
  rig.input("DI04", true);
  rig.input("DI05", true);
  rig.po({0x0006, 5000, 0});
  rig.settle();
  rig.input("DI04", false);
  EXPECT_NEAR(rig.ms_until_standing(), mdx_ramp_ms(1000, 300), kRampTolerance);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 9);
  EXPECT_EQ(rig.drive.verdict().reason, Block::LimitCw);
  EXPECT_NE(rig.status() & 0x40, 0);
  rig.po({0x0006, static_cast<uint16_t>(-5000), 0});
  rig.settle();
  EXPECT_EQ(rig.rpm(), -1000) << "away from the switch";
  rig.input("DI04", true);
  rig.input("DI05", false);
  rig.ms_until_standing();
  EXPECT_EQ(rig.drive.verdict().reason, Block::LimitCcw);
  rig.input("DI04", false);
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.fault(), 27) << "both at once";
}

// A limit switch is an emergency stop of a drive that is enabled and turns towards it. What already stops the drive
// stays what it is.
TEST(MovidriveLimits, LimitSwitchesActOnAnEnabledDriveOnly) {
  struct Row {
    const char* input;  // taken away
    uint16_t control;
    Block reason;
  };
  const Row rows[] = {{"DI03", 6, Block::RapidStopTerminal}, {"DI01", 6, Block::NoDirection},
                      {"DI00", 6, Block::TerminalInhibit},   {"DI17", 6, Block::None},  // nothing
                      {"DI17", 4, Block::BusRapidStop},      {"DI17", 2, Block::BusStop},
                      {"DI17", 14, Block::BusHold}};
  for (const Row& row : rows)
    for (const int way : {1, -1})
      for (const int reached : {1, -1, 0}) {
        Mdx rig;
        rig.bus_control();
        rig.set("P603", 14);
        rig.set("P604", 15);
        for (const char* name : {"DI04", "DI05", "DI17"}) rig.input(name, true);
        rig.po({6, static_cast<uint16_t>(way * 5000), 0});
        rig.run_ms(100);
        if (reached != 0) rig.input(reached > 0 ? "DI04" : "DI05", false);
        rig.input(row.input, false);
        rig.po({row.control, static_cast<uint16_t>(way * 5000), 0});
        rig.run_ms(1);
        const bool stops = row.reason == Block::None && reached == way;
        EXPECT_EQ(rig.drive.verdict().reason,
                  stops ? (way > 0 ? Block::LimitCw : Block::LimitCcw) : row.reason)
            << row.input << ' ' << row.control << ", way " << way << ", reached " << reached;
        EXPECT_EQ(rig.drive.condition() == UnitCondition::LimitSwitch, stops);
        EXPECT_EQ(rig.drive.fault(), 0);
      }
}

// What the stop function P720 has stopped does not turn towards a switch, and its ramp is no emergency stop.
TEST(MovidriveLimits, LimitSwitchesSayNothingOfAStoppedDrive) {
  for (const int way : {1, -1}) {
    Mdx rig;
    rig.bus_control();
    rig.set("P603", 14);
    rig.set("P604", 15);
    rig.set("P720", 1);
    rig.set("P721", 300'000);
    for (const char* name : {"DI04", "DI05"}) rig.input(name, true);
    rig.po({6, static_cast<uint16_t>(way * 5000), 0});
    rig.settle();
    rig.po({6, static_cast<uint16_t>(way * 1000), 0});  // 200 rpm
    rig.run_ms(10);
    rig.input(way > 0 ? "DI04" : "DI05", false);
    rig.run_ms(1);
    EXPECT_EQ(rig.drive.verdict().command, runtime::Command::Stop);
    EXPECT_EQ(rig.drive.verdict().reason, Block::StopFunction);
    rig.po({6, static_cast<uint16_t>(way * 5000), 0});
    rig.run_ms(2);
    EXPECT_EQ(rig.drive.verdict().reason, way > 0 ? Block::LimitCw : Block::LimitCcw);
  }
}

// More than the torque of P303 = 150 %: friction blocks the motor, a hanging load drags it backwards.
TEST(MovidriveLimits, SpeedMonitoring) {
  PROVES("DRV-16");
  for (const bool dragged : {false, true})
    for (int32_t mode = 0; mode <= 3; ++mode) {
      MachineData machine = light_machine();
      (dragged ? machine.load_torque : machine.friction) = 200'000;
      machine.brake_torque = 400'000;
      DriveRig rig("md60a", {}, machine);
      rig.enable_terminals();
      rig.set("P500", mode);
      rig.set("P501", 200);
      rig.set("P130", 100);
      rig.ai1(10'000);
      const int ms = rig.ms_until([&] { return rig.drive.fault() == 8; }, 300);
      const bool trips = mode == 3 || mode == (dragged ? 2 : 1);
      EXPECT_EQ(ms <= 300, trips) << mode << dragged;
      if (trips) {
        EXPECT_NEAR(ms, 201, 3) << mode << dragged;
      }
    }
}

// 1053 1610 p. 32: value 3000 with conversion -3 is 3 s. Its text says UP, the lists (p. 72) and the other
// languages DOWN.
TEST(MovidriveRamp, P131IsTheRampDown) {
  PROVES("EX-07");
  const DriveRig fresh("md60a");
  EXPECT_EQ(fresh.parameters.table().find(8471)->name, "Ramp t11 DOWN CW");
  EXPECT_EQ(fresh.index("P131"), 8471);
  DriveRig rig("md60a");
  rig.bus_control();
  rig.set("P302", 3'000'000);
  EXPECT_EQ(rig.write("P131", 3000), 0);
  rig.po({0x0006, 15000, 0});
  EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() >= 3000; }), 2000, 3) << "P130 is still 2 s";
  rig.po({0x0006, 0, 0});
  EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() <= 0; }), 3000, 3);
}

}  // namespace
}  // namespace ipos::tests
