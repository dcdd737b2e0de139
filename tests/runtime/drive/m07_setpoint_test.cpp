// Setpoint cascade of MOVITRAC 07: figure and tables 2 and 3 of its manual, chapter 6.4, and the ranges of
// its parameters, chapter 10.3.
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

constexpr int kTooLarge = 0x15;
constexpr int kTooSmall = 0x16;
constexpr int kIncorrect = 0x1D;

struct M07 : DriveRig {
  explicit M07(DriveOptions options = {}) : DriveRig("mc07", options) { enable_terminals(); }
};

DriveOptions standard(uint8_t firmware) {
  DriveOptions options;
  options.logodrive = false;
  options.firmware = firmware;
  return options;
}
DriveOptions logodrive(uint8_t firmware) {
  DriveOptions options;
  options.firmware = firmware;
  return options;
}

TEST(M07Setpoint, ChoiceOfFixedSetpoints) {
  PROVES("M07-SETP-02");
  M07 rig;
  rig.set("P601", 6);  // DI02 FIX SETPT. SELECT
  for (const auto& [number, speed] :
       {std::pair{"P160", 110}, {"P161", 120}, {"P162", 130}, {"P170", 210}, {"P171", 220}, {"P172", 230}})
    rig.set(number, speed * 1000);
  rig.ai1(1000);  // 150 rpm: no fixed setpoint chosen
  constexpr int kTable[] = {150, 110, 120, 130, 150, 210, 220, 230};
  for (int bits = 0; bits < 8; ++bits) {
    rig.input("DI04", (bits & 1) != 0);
    rig.input("DI05", (bits & 2) != 0);
    rig.input("DI02", (bits & 4) != 0);
    EXPECT_EQ(rig.setpoint_rpm(), kTable[bits]) << bits;
  }
}

TEST(M07Setpoint, FixedReplacesAddsOrMultipliesAi1) {
  PROVES("M07-SETP-04", "M07-SETP-05", "M07-SETP-06");
  M07 rig;
  rig.ai1(5000);
  EXPECT_EQ(rig.setpoint_rpm(), 750);
  rig.input("DI04", true);
  EXPECT_EQ(rig.setpoint_rpm(), 150);
  rig.set("P100", 6);
  rig.ai1(2000);
  EXPECT_EQ(rig.setpoint_rpm(), 450);
  rig.set("P100", 7);
  rig.input("DI04", false);
  rig.input("DI05", true);
  rig.ai1(5000);
  EXPECT_EQ(rig.setpoint_rpm(), 375);
  rig.set("P302", 3'000'000);
  EXPECT_EQ(rig.setpoint_rpm(), 375) << "10 V are 100 %, not P302";
  rig.set("P112", 0);
  EXPECT_EQ(rig.setpoint_rpm(), 375);
}

TEST(M07Setpoint, ModesOfAi1) {
  PROVES("M07-SETP-07");
  M07 rig;
  rig.ai1(5000);
  rig.set("P112", 0);
  EXPECT_EQ(rig.setpoint_rpm(), 1500);
  rig.set("P112", 1);
  rig.set("P302", 1'400'000);
  EXPECT_EQ(rig.setpoint_rpm(), 700);
  rig.set("P112", 5);
  rig.ai1_current(5000);
  EXPECT_EQ(rig.setpoint_rpm(), 350);
  rig.set("P112", 6);
  rig.ai1_current(12'000);
  EXPECT_EQ(rig.setpoint_rpm(), 700);
  rig.ai1_current(4000);
  EXPECT_EQ(rig.setpoint_rpm(), 0);
  rig.ai1_current(0);
  EXPECT_EQ(rig.setpoint_rpm(), 0) << "below live zero";
}

TEST(M07Setpoint, FactorOfAi1) {
  PROVES("M07-SETP-08");
  M07 rig;
  EXPECT_EQ(rig.value("P110"), 1000);
  rig.ai1(5000);
  rig.set("P110", 2000);
  EXPECT_EQ(rig.setpoint_rpm(), 1500);
  rig.set("P110", -1000);
  EXPECT_EQ(rig.setpoint_rpm(), -750);
  EXPECT_EQ(rig.write("P110", -10'000), 0);
  EXPECT_EQ(rig.write("P110", 10'000), 0);
  EXPECT_EQ(rig.write("P110", 10'010), kTooLarge);
  EXPECT_EQ(rig.write("P110", -10'010), kTooSmall);
  EXPECT_EQ(rig.write("P110", 1005), kIncorrect);
  EXPECT_EQ(rig.parameters.table().find("P110")->conversion, -3);
}

// Transmitted in hundredths of a kHz (mc07.tsv).
TEST(M07Setpoint, FrequencyInput) {
  PROVES("M07-SETP-09");
  M07 rig;
  EXPECT_EQ(rig.index("P102"), 8840);
  const stdlib::Parameter& row = *rig.parameters.table().find("P102");
  EXPECT_EQ(stdlib::parameter_text(row, rig.value("P102")), "10.00 kHz");
  EXPECT_EQ(rig.write("P102", 10), 0);
  EXPECT_EQ(stdlib::parameter_text(row, rig.value("P102")), "0.10 kHz");
  EXPECT_EQ(rig.write("P102", 6500), 0);
  EXPECT_EQ(stdlib::parameter_text(row, rig.value("P102")), "65.00 kHz");
  EXPECT_EQ(rig.write("P102", 9), kTooSmall);
  EXPECT_EQ(rig.write("P102", 6501), kTooLarge);
  EXPECT_EQ(rig.write("P102", 1000), 0);
  rig.set("P100", 11);
  for (const auto& [hertz, want] : {std::pair{5000, 750}, {10'000, 1500}, {0, 0}}) {
    auto analog = rig.drive.analog();
    analog.frequency = hertz;
    rig.drive.set_analog(analog);
    EXPECT_EQ(rig.setpoint_rpm(), want);
  }
  rig.set("P102", 2000);
  auto analog = rig.drive.analog();
  analog.frequency = 5000;
  rig.drive.set_analog(analog);
  EXPECT_EQ(rig.setpoint_rpm(), 375);
}

TEST(M07Setpoint, BusSetpointPassesAssignmentAndEnable) {
  PROVES("M07-SETP-10");
  M07 rig;
  rig.set("P100", 10);
  rig.set("P876", 0);
  rig.po({0, 5000, 0});
  EXPECT_EQ(rig.requested_rpm(), 0);
  EXPECT_EQ(rig.drive.setpoint().note, SetpointNote::PoDisabled);
  rig.set("P876", 1);
  rig.po({0, 5000, 0});
  EXPECT_EQ(rig.requested_rpm(), 1000);
  rig.set("P871", 0);
  EXPECT_EQ(rig.requested_rpm(), 0);
  rig.set("P872", 1);
  rig.po({0, 5000, 250});
  EXPECT_EQ(rig.requested_rpm(), 50);
  // RS-485 is another source: its words count with P100 = 2 only.
  rig.silence();
  const uint16_t words[] = {0, 0, 500};
  rig.drive.take_po(PoSource::Rs485, words);
  EXPECT_EQ(rig.requested_rpm(), 50);
  rig.set("P100", 2);
  EXPECT_EQ(rig.requested_rpm(), 100);
}

TEST(M07Setpoint, MotorPotentiometerRemembersWithP152) {
  PROVES("M07-SETP-11");
  for (const int32_t keep : {0, 1}) {
    M07 rig;
    EXPECT_EQ(rig.value("P150"), 20'000);
    EXPECT_EQ(rig.value("P152"), 0);
    rig.set("P301", 60'000);
    rig.set("P100", 4);
    rig.set("P603", 9);  // DI04 MOTOR POT UP
    rig.set("P152", keep);
    rig.input("DI04", true);
    rig.run_ms(4000);  // 300 rpm above the minimum
    rig.input("DI04", false);
    EXPECT_NEAR(rig.setpoint_rpm(), 360, 0.2);
    rig.drive.power_cycle();
    EXPECT_NEAR(rig.setpoint_rpm(), keep == 1 ? 360 : 60, 0.2);
  }
}

TEST(M07Setpoint, AmountIsLimitedAndTheSignIsKept) {
  PROVES("M07-SETP-12");
  M07 rig;
  rig.bus_control();
  rig.set("P301", 15'000);
  for (const auto& [sent, want] : {std::pair{2000, 1500}, {5, 15}, {-5, -15}, {-2000, -1500}, {700, 700}}) {
    rig.po({0x0006, static_cast<uint16_t>(sent * 5), 0});
    EXPECT_EQ(rig.setpoint_rpm(), want);
    rig.settle();
    EXPECT_EQ(rig.rpm(), want);
  }
  rig.input("DI03", false);
  rig.ms_until_standing();
  rig.run_ms(10);
  EXPECT_EQ(rig.rpm(), 0) << "without enable";
  // Direction by terminals: the limit acts in that direction.
  M07 terminals;
  terminals.set("P301", 15'000);
  terminals.input("DI01", false);
  terminals.input("DI02", true);  // CCW/STOP
  EXPECT_EQ(terminals.setpoint_rpm(), -15);
  terminals.ai1(10'000);
  EXPECT_EQ(terminals.setpoint_rpm(), -1500);
}

TEST(M07Setpoint, SpeedLimits) {
  PROVES("M07-SETP-13", "M07-SETP-14");
  const runtime::ParameterStore fresh(unit("mc07"));
  EXPECT_EQ(fresh.value(8516), 15'000);
  EXPECT_EQ(fresh.value(8517), 1'500'000);
  M07 rig;
  EXPECT_EQ(rig.write("P302", 5'500'001), kTooLarge);
  EXPECT_EQ(rig.write("P302", 5'500'000), 0);
  EXPECT_EQ(rig.write("P302", 0), 0);
  EXPECT_EQ(rig.write("P302", 100), kIncorrect);
}

TEST(M07Setpoint, CodesOfP121) {
  PROVES("M07-SETP-15");
  M07 rig;
  EXPECT_EQ(rig.value("P121"), 0);
  for (const int32_t code : {0, 1, 2}) EXPECT_EQ(rig.write("P121", code), 0);
  EXPECT_NE(rig.write("P121", 3), 0);
}

// Table 3, row by row. The potentiometer stands at 100 rpm (P302 = 1000, a tenth of its travel).
struct PotRig : M07 {
  PotRig(DriveOptions options, int32_t p121) : M07(options) {
    set("P302", 1'000'000);
    set("P121", p121);
    potentiometer(100);
  }
  double with_n11() {
    input("DI04", true);
    const double rpm = setpoint_rpm();
    input("DI04", false);
    return rpm;
  }
};

TEST(M07Potentiometer, AddedToAnalogAndFixedSetpoints) {
  PROVES("M07-SETP-16", "M07-SETP-17");
  for (const auto& [options, n11] : {std::pair{standard(10), 150},
                                     {standard(11), 150},
                                     {standard(12), 150},
                                     {standard(13), 250},
                                     {standard(14), 250},
                                     {standard(15), 250},
                                     {logodrive(12), 250},
                                     {logodrive(16), 250}}) {
    PotRig rig(options, 1);
    EXPECT_EQ(rig.with_n11(), n11) << int{options.firmware};
    EXPECT_EQ(rig.setpoint_rpm(), 100);
    rig.ai1(2000);
    EXPECT_EQ(rig.setpoint_rpm(), 300) << "AI1 + potentiometer";
  }
  for (const DriveOptions& options : {standard(15), logodrive(16)}) {
    PotRig rig(options, 2);
    EXPECT_EQ(rig.with_n11(), 150);
    EXPECT_EQ(rig.setpoint_rpm(), 100);
  }
  for (const DriveOptions& options : {standard(10), standard(14), logodrive(12), logodrive(15)}) {
    M07 rig(options);
    EXPECT_EQ(rig.write("P121", 2), kIncorrect) << int{options.firmware};
    EXPECT_FALSE(rig.parameters.preset(rig.index("P121"), 2));
    EXPECT_EQ(rig.value("P121"), 0);
    EXPECT_EQ(rig.write("P121", 1), 0);
  }
}

TEST(M07Potentiometer, FirmwareIsShownInP076) {
  // Part number and version as in the example of chapter 10.3.
  EXPECT_EQ(M07(standard(11)).value("P076"), 822'609'711);
  EXPECT_EQ(M07().value("P076") % 100, 16);
}

TEST(M07Potentiometer, NeverAddedToCodes6And7) {
  PROVES("M07-SETP-18");
  for (const int32_t source : {6, 7})
    for (const int32_t p121 : {0, 1, 2}) {
      PotRig rig(logodrive(16), p121);
      rig.set("P100", source);
      rig.ai1(5000);
      EXPECT_EQ(rig.with_n11(), source == 6 ? 650 : 75) << source << p121;
      EXPECT_EQ(rig.setpoint_rpm(), source == 6 ? 500 : 0);
    }
}

TEST(M07Potentiometer, MotorPotentiometerItselfGetsNone) {
  PROVES("M07-SETP-19");
  for (const auto& [options, p121, n11] : {std::tuple{standard(11), 1, 150},
                                           {standard(13), 1, 250},
                                           {logodrive(12), 1, 250},
                                           {standard(15), 2, 150},
                                           {logodrive(16), 2, 150}}) {
    PotRig rig(options, p121);
    rig.set("P100", 4);
    rig.set("P604", 9);  // DI05 MOTOR POT UP
    rig.input("DI05", true);
    rig.run_ms(4000);
    rig.input("DI05", false);
    EXPECT_NEAR(rig.setpoint_rpm(), 300, 0.2) << int{options.firmware};
    EXPECT_EQ(rig.with_n11(), n11) << int{options.firmware} << p121;
  }
}

TEST(M07Potentiometer, AddedToTheBusSetpoint) {
  PROVES("M07-SETP-20");
  for (const auto& [options, p121, want] : {std::tuple{standard(11), 1, 500},
                                            {standard(13), 1, 500},
                                            {standard(15), 2, 500},
                                            {standard(11), 0, 400},
                                            {logodrive(16), 0, 400},
                                            {logodrive(16), 1, 500},
                                            {logodrive(16), 2, 500}})
    for (const auto& [source, code] : {std::pair{PoSource::Rs485, 2}, {PoSource::Sbus, 10}}) {
      PotRig rig(options, p121);
      rig.set("P100", code);
      rig.po({0x0006, 2000, 0}, source);
      EXPECT_EQ(rig.setpoint_rpm(), want) << int{options.firmware} << p121 << code;
    }
}

TEST(M07Potentiometer, FrequencyInputFromFirmware13) {
  PROVES("M07-SETP-21");
  for (const uint8_t firmware : {uint8_t{10}, uint8_t{11}, uint8_t{12}}) {
    M07 old(standard(firmware));
    old.input("DI01", false);
    EXPECT_EQ(old.write("P100", 11), kIncorrect);
    EXPECT_FALSE(old.parameters.preset(old.index("P100"), 11));
  }
  for (const auto& [options, p121, frequency, n11] : {std::tuple{standard(13), 1, 600, 250},
                                                      {logodrive(12), 1, 600, 250},
                                                      {standard(15), 2, 600, 150},
                                                      {standard(15), 1, 600, 250},
                                                      {standard(15), 0, 500, 150}}) {
    PotRig rig(options, p121);
    rig.set("P100", 11);
    auto analog = rig.drive.analog();
    analog.frequency = 5000;
    rig.drive.set_analog(analog);
    EXPECT_EQ(rig.setpoint_rpm(), frequency);
    EXPECT_EQ(rig.with_n11(), n11);
  }
}

TEST(M07Potentiometer, Modes) {
  PROVES("M07-SETP-23");
  for (const auto& [mode, low, high] : {std::tuple{0, 0, 1000}, {1, 0, -1000}, {2, -1000, 1000}}) {
    PotRig rig({}, 1);
    rig.set("P122", mode);
    rig.potentiometer(0);
    EXPECT_EQ(rig.setpoint_rpm(), low) << mode;
    rig.potentiometer(1000);
    EXPECT_EQ(rig.setpoint_rpm(), high) << mode;
  }
}

// With gain 1 and a long integral time the first output is the deviation, in % of P302.
struct PiRig : M07 {
  explicit PiRig(int32_t mode) {
    set("P250", mode);
    set("P252", 2000);
  }
};

TEST(M07Pi, PotentiometerIsTheSetpointWithoutFixedOne) {
  PROVES("M07-SETP-22");
  PiRig rig(1);
  rig.potentiometer(400);
  EXPECT_NEAR(rig.setpoint_rpm(), 0.4 * 1500, 0.1);
  rig.potentiometer(200);
  EXPECT_NEAR(rig.setpoint_rpm(), 0.2 * 1500, 0.1);
  rig.input("DI04", true);
  const double with_fixed = rig.setpoint_rpm();
  EXPECT_NEAR(with_fixed, 0.03 * 1500, 0.1);
  rig.potentiometer(900);
  EXPECT_NEAR(rig.setpoint_rpm(), with_fixed, 0.1);
}

TEST(M07Pi, ModesGainAndRanges) {
  PROVES("M07-SETP-24");
  for (const int32_t mode : {0, 1, 2}) {
    PiRig rig(mode);
    rig.input("DI05", true);  // n12: 15 %
    rig.ai1(500);             // 5 %
    EXPECT_NEAR(rig.setpoint_rpm(), mode == 0 ? 750 : mode == 1 ? 0.10 * 1500 : 0, 0.1) << mode;
    rig.ai1(3500);  // 35 %
    EXPECT_NEAR(rig.setpoint_rpm(), mode == 0 ? 750 : mode == 1 ? 0 : 0.20 * 1500, 0.5) << mode;
  }
  PiRig rig(1);
  rig.set("P251", 3);
  rig.input("DI05", true);
  EXPECT_NEAR(rig.setpoint_rpm(), 0.45 * 1500, 0.1);
  const M07 fresh;
  EXPECT_EQ(fresh.value("P250"), 0);
  EXPECT_EQ(fresh.value("P251"), 1);
  EXPECT_EQ(fresh.value("P252"), 1);
  EXPECT_EQ(fresh.parameters.table().find("P252")->conversion, 0);
  EXPECT_EQ(rig.write("P250", 3), kTooLarge);
  EXPECT_EQ(rig.write("P251", 64), 0);
  EXPECT_EQ(rig.write("P251", 65), kTooLarge);
  EXPECT_EQ(rig.write("P251", -1), kTooSmall);
  EXPECT_EQ(rig.write("P252", 2000), 0);
  EXPECT_EQ(rig.write("P252", 2001), kTooLarge);
}

TEST(M07Pi, IntegralPart) {
  PiRig rig(1);
  rig.set("P252", 2);  // 10 % deviation for 2 s make another 10 %
  rig.input("DI05", true);
  rig.ai1(500);
  rig.run_ms(2000);
  EXPECT_NEAR(rig.setpoint_rpm(), 0.20 * 1500, 0.3);
  rig.run_ms(100'000);
  EXPECT_EQ(rig.setpoint_rpm(), 1500) << "100 % is the end";
}

TEST(M07Pi, OwnFixedSetpoints) {
  PROVES("M07-SETP-25");
  const M07 fresh;
  const int defaults[] = {3, 15, 30, 3, 15, 30};
  for (int n = 0; n < 6; ++n)
    EXPECT_EQ(fresh.parameters.value(static_cast<uint16_t>(8814 + n)), defaults[n]) << n;
  PiRig rig(1);
  EXPECT_EQ(rig.write("P164", 101), kTooLarge);
  EXPECT_EQ(rig.write("P164", -1), kTooSmall);
  rig.input("DI05", true);
  EXPECT_NEAR(rig.setpoint_rpm(), 0.15 * 1500, 0.1);
  rig.set("P601", 6);  // DI02 FIX SETPT. SELECT
  rig.set("P174", 40);
  rig.input("DI02", true);
  EXPECT_NEAR(rig.setpoint_rpm(), 0.40 * 1500, 0.1);
}

TEST(M07Pi, ActualValueFromAi1) {
  PROVES("M07-SETP-26");
  PiRig rig(1);
  rig.set("P163", 80);
  rig.input("DI04", true);
  const auto controller = [&] { return 80 - rig.setpoint_rpm() / 15; };
  rig.ai1(2000);
  EXPECT_NEAR(controller(), 20, 0.1);
  rig.set("P112", 5);
  rig.ai1_current(5000);
  EXPECT_NEAR(controller(), 25, 0.1);
  rig.set("P253", 6);
  EXPECT_EQ(rig.value("P112"), 6);
  rig.ai1_current(12'000);
  EXPECT_NEAR(controller(), 50, 0.1);
  rig.ai1_current(6000);
  rig.set("P254", 2000);
  EXPECT_EQ(rig.value("P110"), 2000);
  EXPECT_NEAR(controller(), 25, 0.1);
  rig.set("P255", 10);
  EXPECT_NEAR(controller(), 35, 0.1);
  EXPECT_EQ(rig.write("P255", 101), kTooLarge);
  EXPECT_EQ(rig.value("P253"), 6);
  rig.set("P254", 1000);
  EXPECT_EQ(rig.parameters.value(8463), 1000);
  EXPECT_EQ(stdlib::parameter_text(*rig.parameters.table().find("P254"), 1000).substr(0, 1), "1");
}

TEST(M07Setpoint, RampsAndTheirSteps) {
  PROVES("M07-SETP-27");
  M07 rig;
  const M07 fresh;
  EXPECT_EQ(fresh.value("P130"), 2000);
  EXPECT_EQ(fresh.value("P131"), 2000);
  EXPECT_EQ(fresh.value("P136"), 2000);
  EXPECT_EQ(fresh.value("P150"), 20'000);
  for (const char* number : {"P130", "P131"}) {
    for (const int32_t good : {0, 10, 1000, 1100, 10'000, 11'000, 100'000, 110'000, 2'000'000})
      EXPECT_EQ(rig.write(number, good), 0) << number << good;
    for (const int32_t bad : {5, 1005, 1050, 10'500, 105'000})
      EXPECT_EQ(rig.write(number, bad), kIncorrect) << number << bad;
    EXPECT_EQ(rig.write(number, 2'010'000), kTooLarge);
  }
  EXPECT_EQ(rig.write("P136", 20'000), 0);
  EXPECT_EQ(rig.write("P136", 2'000'000), kTooLarge);
  EXPECT_EQ(rig.write("P150", 190), kTooSmall);
  EXPECT_EQ(rig.write("P150", 200), 0);
  EXPECT_EQ(rig.write("P150", 50'000), 0);
  EXPECT_EQ(rig.write("P150", 51'000), kTooLarge);
}

TEST(M07Setpoint, StopFunction) {
  PROVES("M07-SETP-28");
  M07 rig;
  EXPECT_EQ(rig.value("P720"), 0);
  EXPECT_EQ(rig.value("P721"), 30'000);
  EXPECT_EQ(rig.value("P722"), 30'000);
  EXPECT_EQ(rig.write("P721", 500'200), kTooLarge);
  EXPECT_EQ(rig.write("P722", 500'000), 0);
  rig.set("P722", 30'000);
  rig.set("P100", 10);
  const auto runs_at = [&](int rpm) {
    rig.po({0, static_cast<uint16_t>(rpm * 5), 0});
    rig.run_ms(200);
    return rig.rpm() != 0;
  };
  EXPECT_TRUE(runs_at(29)) << "P720 = OFF";
  rig.set("P720", 1);
  EXPECT_TRUE(runs_at(100));
  EXPECT_FALSE(runs_at(29));
  EXPECT_EQ(rig.state(), 2);
  EXPECT_FALSE(runs_at(59)) << "stays stopped";
  EXPECT_TRUE(runs_at(61));
  EXPECT_TRUE(runs_at(31)) << "stays running";
  EXPECT_TRUE(runs_at(-61));
  EXPECT_FALSE(runs_at(-29));
}

}  // namespace
}  // namespace ipos::tests
