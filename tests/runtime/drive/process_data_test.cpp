// Process data words: scaling (MOVITRAC 07 chapter 6.1; 1053 1610 p. 35, 41, 48) and what they do to a drive.
#include "runtime/drive/process_data.hpp"

#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::PoAssignment;
using runtime::relative_of_speed;
using runtime::speed_of_relative;
using runtime::speed_of_word;
using runtime::word_of_current;
using runtime::word_of_speed;

constexpr uint16_t word(int value) { return static_cast<uint16_t>(value); }

TEST(ProcessWords, Speed) {
  PROVES("M07-PD-01", "M07-PD-02", "M07-PD-03", "PD-06");
  EXPECT_EQ(word_of_speed(400'000), 0x07D0);
  EXPECT_EQ(word_of_speed(-750'000), 0xF15A);
  EXPECT_EQ(word_of_speed(-750'000), word(-3750));
  EXPECT_EQ(speed_of_word(0xF15A), -750'000);
  EXPECT_EQ(word_of_speed(1'000'000), 5000);
  EXPECT_EQ(speed_of_word(5011), 1'002'200);
  EXPECT_EQ(speed_of_word(15'000), 3'000'000);
  EXPECT_EQ(speed_of_word(0x8000), -6'553'600);
  EXPECT_EQ(speed_of_word(0x7FFF), 6'553'400);
  EXPECT_EQ(word_of_speed(6'553'600), 0x7FFF) << "saturates";
  EXPECT_EQ(word_of_speed(-7'000'000), 0x8000);
  for (int value = INT16_MIN; value <= INT16_MAX; ++value)
    ASSERT_EQ(word_of_speed(speed_of_word(word(value))), word(value)) << value;
}

TEST(ProcessWords, RelativeSpeed) {
  PROVES("M07-PD-05", "M07-PD-06", "M07-PD-07");
  constexpr int32_t k1500 = 1'500'000;
  EXPECT_EQ(speed_of_relative(0x4000, k1500), k1500);
  EXPECT_EQ(speed_of_relative(0x1000, k1500), 375'000);
  EXPECT_EQ(speed_of_relative(0xD000, k1500), -1'125'000);
  EXPECT_EQ(relative_of_speed(375'000, k1500), 0x1000);
  EXPECT_EQ(relative_of_speed(-1'125'000, k1500), 0xD000);
  EXPECT_EQ(speed_of_relative(0x8000, k1500), -2 * k1500);
  // In 1/1000 % of 100 % = 100000: one digit is 0.0061035 %, 7FFFh is 199.9939 %.
  EXPECT_EQ(speed_of_relative(0x4000, 1'638'400'000), 1'638'400'000);
  EXPECT_EQ(speed_of_relative(1, 1'638'400'000), 100'000) << "1/16384";
  EXPECT_EQ(speed_of_relative(0x7FFF, 100'000), 199'994);
  EXPECT_EQ(relative_of_speed(3 * k1500, k1500), 0x7FFF);
  for (int value = INT16_MIN; value <= INT16_MAX; ++value)
    ASSERT_EQ(relative_of_speed(speed_of_relative(word(value), 16'384'000), 16'384'000), word(value))
        << value;
}

TEST(ProcessWords, RelativeWordsReferToP302) {
  PROVES("M07-PD-08");
  DriveRig rig("mc07");
  rig.bus_control();
  EXPECT_EQ(rig.parameters.table().find("P312"), nullptr);
  rig.set("P871", 11);
  rig.set("P874", 8);
  rig.po({0x0006, 0x4000, 0});
  EXPECT_EQ(rig.setpoint_rpm(), 1500);
  rig.set("P302", 3'000'000);
  EXPECT_EQ(rig.setpoint_rpm(), 3000);
  rig.settle();
  EXPECT_EQ(rig.drive.pi()[1], 0x4000);
}

TEST(ProcessWords, Current) {
  PROVES("M07-PD-09");
  EXPECT_EQ(word_of_current(45'000), 0x01C2);
  EXPECT_EQ(word_of_current(115'500), 0x0483);
  EXPECT_EQ(word_of_current(-3'276'800), 0x8000);
  EXPECT_EQ(word_of_current(3'276'700), 0x7FFF);
  EXPECT_EQ(word_of_current(3'276'800), 0x7FFF);
  // Both currents of a standing, magnetized motor without load: 60 % and 0.
  DriveRig rig("mc07");
  rig.bus_control();
  rig.set("P874", 2);
  rig.set("P875", 3);
  rig.po({0x0006, 0, 0});
  rig.run_ms(10);
  EXPECT_EQ(rig.drive.pi()[1], 600);
  EXPECT_EQ(rig.drive.pi()[2], 0);
}

TEST(ProcessWords, RampIsUnsignedMilliseconds) {
  PROVES("M07-PD-10", "PD-07");
  const auto ramp = [](uint16_t raw) {
    constexpr auto kRamp = static_cast<uint8_t>(PoAssignment::Ramp);
    return runtime::decode_order({0, 0, raw}, {0, 0, kRamp}, 0).ramp;
  };
  EXPECT_EQ(ramp(0x012C), 300);
  EXPECT_EQ(ramp(0x0578), 1400);
  EXPECT_EQ(ramp(0x0BB8), 3000);
  EXPECT_EQ(ramp(0xFFFF), 65'535);
  EXPECT_EQ(speed_of_relative(0x2000, 100'000), 50'000) << "2000h is 50 %";
  // 25 Hz of a four-pole motor are 750 rpm.
  DriveRig rig("mc07");
  rig.bus_control();
  rig.set("P872", 8);
  rig.po({0x0006, 3750, 1000});
  EXPECT_NEAR(rig.ms_until([&] { return rig.rpm() == 750; }), 500, 2);
}

TEST(ProcessWords, PiController) {
  PROVES("M07-PD-11");
  DriveRig rig("mc07");
  rig.bus_control();
  rig.set("P250", 1);
  rig.set("P252", 2000);
  rig.set("P871", 13);
  rig.set("P874", 10);
  rig.po({0x0006, 0x2000, 0});
  EXPECT_NEAR(rig.setpoint_rpm(), 750, 0.1) << "50 % deviation, gain 1, of P302";
  rig.ai1(2500);
  rig.run_ms(1);
  EXPECT_EQ(rig.drive.pi()[1], 0x1000) << "25 %";
  EXPECT_NEAR(rig.setpoint_rpm(), 375, 0.1);
}

TEST(ProcessWords, DisplaysOfTheProcessData) {
  PROVES("PAR-36");
  DriveRig rig("md60a");
  constexpr std::string_view kTexts[] = {"PARAM + 1PD", "1PD", "PARAM + 2PD",  "2PD", "PARAM + 3PD", "3PD",
                                         "PARAM + 6PD", "6PD", "PARAM + 10PD", "10PD"};
  const stdlib::Parameter* p090 = rig.parameters.table().find("P090");
  ASSERT_NE(p090, nullptr);
  EXPECT_EQ(p090->index, 8451);
  ASSERT_EQ(p090->texts.size(), std::size(kTexts));
  // Code 6 is not that of the telegram type 06h (ML_FT_PAR of const.h): those are numbers of their own.
  for (size_t code = 0; code < std::size(kTexts); ++code) {
    EXPECT_EQ(p090->texts[code].value, static_cast<int>(code));
    EXPECT_EQ(p090->texts[code].text, kTexts[code]);
  }
  EXPECT_EQ(rig.value("P090"), 4);
  rig.enable_terminals();
  rig.po({0x0006, 0x1388, 0x3A98});
  rig.run_ms(10);
  EXPECT_EQ(rig.value("P094"), 6);
  EXPECT_EQ(rig.value("P095"), 5000);
  EXPECT_EQ(rig.value("P096"), 15'000);
  const Words pi = rig.drive.pi();
  EXPECT_NE(pi[0], 0);
  EXPECT_EQ(rig.value("P097"), pi[0]);
  EXPECT_EQ(rig.value("P098"), pi[1]);
  EXPECT_EQ(rig.value("P099"), pi[2]);
}

TEST(ProcessWords, EnableP876) {
  PROVES("M07-PD-18");
  for (const char* name : {"mc07", "md60a"}) {
    DriveRig rig(name);
    rig.bus_control();
    rig.set("P876", 0);
    rig.po({0x0006, 5000, 7});
    rig.run_ms(500);
    EXPECT_EQ(rig.rpm(), 0) << name;
    EXPECT_EQ(rig.state(), 2) << name;
    EXPECT_EQ(rig.status() & 4, 0) << name << ": PI words are there and say that PO is not enabled";
    EXPECT_EQ(rig.value("P094"), 6);
    EXPECT_EQ(rig.value("P095"), 5000);
    EXPECT_EQ(rig.value("P096"), 7);
    rig.set("P876", 1);
    rig.run_ms(20);
    rig.settle();
    EXPECT_EQ(rig.rpm(), 1000) << name;
    rig.set("P876", 0);
    rig.ms_until_standing();
    EXPECT_EQ(rig.state(), 2) << name << ": neither control word nor speed count any more";
    EXPECT_EQ(rig.requested_rpm(), 0) << name;
  }
}

TEST(ProcessWords, MaximumSpeed) {
  PROVES("M07-PD-19");
  for (const char* name : {"mc07", "md60a"}) {
    DriveRig rig(name);
    rig.bus_control();
    rig.set("P302", 3'000'000);
    rig.set("P872", 5);
    rig.po({0x0006, 10'000, 5000});
    rig.settle();
    EXPECT_EQ(rig.rpm(), 1000) << name;
    EXPECT_EQ(rig.drive.setpoint().note, SetpointNote::Maximum);
    rig.po({0x0006, word(-10'000), 5000});
    rig.settle();
    EXPECT_EQ(rig.rpm(), -1000) << name;
    rig.po({0x0006, 10'000, 15'000});
    rig.settle();
    EXPECT_EQ(rig.rpm(), 2000) << name << ": 15000 are 3000 rpm";
    rig.po({0x0006, 30'000, 30'000});
    rig.settle();
    EXPECT_EQ(rig.rpm(), 3000) << name << ": P302 stays the end";
  }
}

TEST(ProcessWords, AssignmentsDecide) {
  PROVES("PD-04");
  DriveRig rig("md60a");
  rig.bus_control();
  rig.po({0x0006, 0x2000, 0});
  EXPECT_EQ(rig.requested_rpm(), 0x2000 / 5.0);
  rig.set("P871", 11);
  EXPECT_EQ(rig.requested_rpm(), 750);
  rig.set("P875", 0);
  rig.settle();
  EXPECT_NE(rig.rpm(), 0);
  EXPECT_EQ(rig.drive.pi()[2], 0);
  rig.set("P875", 1);
  EXPECT_EQ(rig.drive.pi()[2], 3750);
}

TEST(ProcessWords, ControlWordEnables) {
  PROVES("PD-08");
  runtime::ParameterStore parameters(unit("md60a"));
  Drive drive(parameters);
  ASSERT_TRUE(parameters.preset(8461, 10));
  ASSERT_TRUE(parameters.preset(8462, 3));
  drive.set_inputs(1 | 1 << 1 | 1 << 3);
  for (const auto& [control, enabled] : {std::pair{0x0006, true}, {0x0000, false}, {0x0006, true}}) {
    const uint16_t words[] = {word(control), 1000, 0};
    drive.take_po(PoSource::Sbus, words);
    drive.tick();
    EXPECT_EQ(drive.condition() == UnitCondition::Enable, enabled) << control;
  }
}

TEST(ProcessWords, SourcesOfSetpointAndControlAreChosenSeparately) {
  PROVES("PD-09");
  DriveRig setpoint("md60a");
  setpoint.enable_terminals();
  setpoint.set("P100", 10);
  setpoint.po({0x0001, 5000, 0});  // the control word is not heard
  setpoint.settle();
  EXPECT_EQ(setpoint.rpm(), 1000);
  setpoint.input("DI03", false);
  setpoint.ms_until_standing();
  EXPECT_EQ(setpoint.state(), 2);

  DriveRig control("md60a");
  control.enable_terminals();
  control.set("P101", 3);
  control.ai1(2000);
  control.po({0x0006, 5000, 0});
  control.settle();
  EXPECT_EQ(control.rpm(), 300) << "AI1, the speed word is not heard";
  EXPECT_EQ(control.drive.setpoint().note, SetpointNote::BusWordIgnored);
  control.po({0x0000, 5000, 0});
  control.ms_until_standing();
  EXPECT_EQ(control.state(), 2);
}

TEST(ProcessWords, ShorterTelegramsKeepTheOtherWords) {
  DriveRig rig("md60a");
  rig.enable_terminals();
  rig.set("P100", 2);
  rig.set("P101", 1);
  rig.po({0x0006, 5000, 0}, PoSource::Rs485);
  rig.settle();
  rig.silence();
  const uint16_t one[] = {0x0006};
  rig.drive.take_po(PoSource::Rs485, one);
  rig.run_ms(100);
  EXPECT_EQ(rig.rpm(), 1000);
  EXPECT_EQ(rig.drive.po(), (Words{0x0006, 5000, 0}));
}

// Special cases of the profile: the first of two words with the same meaning counts.
TEST(ProcessWords, TheFirstOfEqualAssignmentsCounts) {
  DriveRig rig("md60a");
  rig.bus_control();
  rig.set("P872", 11);  // SPEED [%] counts as SPEED
  rig.po({0x0006, 500, 0x4000});
  EXPECT_EQ(rig.requested_rpm(), 100);
  rig.set("P870", 0);  // no control word: as if enabled
  rig.po({0x0000, 500, 0});
  rig.settle();
  EXPECT_EQ(rig.rpm(), 100);
}

TEST(ProcessWords, MaximumCurrentLimitsTheTorque) {
  MachineData machine = light_machine();
  machine.inertia = 400;
  DriveRig rig("md60a", {}, machine);
  rig.bus_control();
  rig.set("P130", 0);
  rig.set("P872", 6);
  const auto ms_to_1000 = [&](uint16_t limit) {
    rig.po({0x0001, 0, limit});
    rig.run_ms(2000);
    rig.po({0x0006, 5000, limit});
    return rig.ms_until([&] { return rig.rpm() == 1000; }, 5000);
  };
  // Active current sqrt(limit^2 - 60^2); 80 % of it are the rated torque, that makes 1500 rpm in 250 ms.
  EXPECT_NEAR(ms_to_1000(1000), 1000.0 / 1500 * 250 / (80.0 / 80), 2) << "100 %: torque 100 %";
  EXPECT_NEAR(ms_to_1000(721), 1000.0 / 1500 * 250 / (40.0 / 80), 2) << "72.1 %: torque 50 %";
  EXPECT_EQ(ms_to_1000(500), 5001) << "less than the magnetizing current: no torque";
}

}  // namespace
}  // namespace ipos::tests
