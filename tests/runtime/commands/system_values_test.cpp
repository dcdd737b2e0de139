// GETSYS and SETSYS value by value, in the units docs/reference/stdlib.md gives.
#include "runtime/commands/system_values.hpp"

#include <gtest/gtest.h>

#include "tests/harness/proves.hpp"
#include "tests/runtime/unit/program_rig.hpp"
#include "vm/isa/blocks.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::runtime {
namespace {

using tests::ProgramRig;

// Inhibit released, enabled clockwise with fixed setpoint n11.
constexpr uint16_t kRunning = 1 << 0 | 1 << 1 | 1 << 3 | 1 << 4;

TEST(GetSys, WhatTheDriveShows) {
  ProgramRig rig(R"(
M01 : GETSYS H0 = ACT.SPEED
      GETSYS H1 = SPEED SETPOINT
      GETSYS H2 = ACT.CURRENT
      GETSYS H3 = DC-LINK VOLTAGE
      GETSYS H4 = UNIT STATE
      GETSYS H5 = FAULT
      GETSYS H6 = ANALOG INPUTS
      JMP M01
)");
  rig.preset("P160", 600'000);
  AnalogInputs analog;
  analog.ai1.millivolt = 2500;
  analog.ai2.millivolt = -10'000;
  rig.drive.set_analog(analog);
  rig.tick(8);
  EXPECT_EQ(rig.h(4), 1) << "controller inhibit";
  EXPECT_EQ(rig.h(6), 2500);
  EXPECT_EQ(rig.h(7), -10'000);
  rig.drive.set_inputs(kRunning);
  for (int ms = 0; ms < 5000; ++ms) rig.tick(8);
  EXPECT_EQ(rig.h(0), 6000) << "0.1 rpm";
  EXPECT_EQ(rig.h(1), 6000);
  EXPECT_EQ(rig.h(2), rig.drive.axis().output_current / 100) << "0.1 % of IN";
  EXPECT_GT(rig.h(2), 100);
  EXPECT_EQ(rig.h(3), rig.drive.axis().dc_link / 1000) << "V";
  EXPECT_EQ(rig.h(4), 4) << "enable";
  EXPECT_EQ(rig.h(5), 0);
  rig.drive.raise_fault(26);
  rig.tick(8);
  EXPECT_EQ(rig.h(5), 26);
}

// Each value takes as many variables as the table of blocks says, which the compiler and the verifier go by.
TEST(GetSys, WritesItsBlockAndNoMore) {
  for (const vm::KeywordInfo& word : vm::keyword_table()) {
    if (word.set != "getsys" || word.text == "CAM") continue;
    const auto rows = vm::blocks_of(vm::Opcode::GetSys, 0, word.value);
    ASSERT_EQ(rows.size(), 1U);
    const uint32_t first = 1024U - rows[0].variables;
    ProgramRig rig("GETSYS H" + std::to_string(first) + " = " + std::string(word.text) + "\nEND\n");
    constexpr int32_t kUntouched = 0x5A5A5A5A;
    for (size_t n = 1000; n < 1024; ++n) rig.h(n) = kUntouched;
    rig.run();
    for (size_t n = 1000; n < 1024; ++n)
      EXPECT_EQ(rig.h(n) != kUntouched, n >= first) << word.text << " H" << n;
  }
}

TEST(GetSys, ProcessOutputData) {
  PROVES("MDB-MS-04");
  ProgramRig rig("M01 : GETSYS H10 = PO-DATA\nJMP M01\n");
  rig.preset("P100", 8);  // slave of a master over SBus: PO3 is the program's
  const uint16_t words[] = {6, 0xFFFF, 0x1234};
  rig.drive.take_po(PoSource::Sbus, words);
  rig.tick(4);
  EXPECT_EQ(rig.h(10), 6);
  EXPECT_EQ(rig.h(11), -1);
  EXPECT_EQ(rig.h(12), 0x1234);
}

TEST(SetSys, ProcessInputData) {
  ProgramRig rig("SETSYS PI-DATA = H10\nEND\n");
  rig.preset("P873", 9);
  rig.preset("P874", 6);
  rig.preset("P875", 9);
  rig.set(10, {0x1'2345, 99, -2});
  rig.tick();
  EXPECT_EQ(rig.drive.pi()[0], 0x2345);
  EXPECT_EQ(rig.drive.pi()[1], rig.drive.status_word_1());
  EXPECT_EQ(rig.drive.pi()[2], 0xFFFE);
}

// The forms with ten words have the first three of the short ones.
TEST(GetSys, TenProcessDataWords) {
  ProgramRig rig("GETSYS H10 = PO-DATA 10\nSETSYS PI-DATA 10 = H30\nEND\n");
  for (const char* number : {"P873", "P874", "P875"}) rig.preset(number, 9);
  const uint16_t words[] = {1, 2, 3, 4, 0x8005, 6, 7, 8, 9, 10};
  rig.drive.take_po(PoSource::Fieldbus, words);
  rig.set(30, {11, 12, 13, 14, -15, 16, 17, 18, 19, 0x1'2345});
  rig.tick(4);
  EXPECT_EQ(rig.h(10), 1);
  EXPECT_EQ(rig.h(13), 4);
  EXPECT_EQ(rig.h(14), 0x8005 - 0x10000);
  EXPECT_EQ(rig.h(19), 10);
  EXPECT_EQ(rig.h(20), 0) << "ten, and no more";
  EXPECT_EQ(rig.drive.pi(), (DriveWords{11, 12, 13}));
  EXPECT_EQ(rig.drive.further_pi(), (FurtherWords{14, 0xFFF1, 16, 17, 18, 19, 0x2345}));
  // A telegram of three words leaves the others as they are.
  rig.drive.take_po(PoSource::Fieldbus, std::span(words).first(3));
  EXPECT_EQ(rig.drive.further_po()[6], 10);
}

TEST(SetSys, ValuesThatAreParameters) {
  ProgramRig rig(R"(
      SETSYS FIXED SETPOINT 11 = H0
      SETSYS FIXED SETPOINT 12 = H1
      SETSYS FIXED SETPOINT 13 = H2
      SETSYS FIXED SETPOINT 21 = H3
      SETSYS FIXED SETPOINT 22 = H4
      SETSYS FIXED SETPOINT 23 = H5
      SETSYS MAX.CURRENT = H6
      SETSYS BRAKE FUNCTION = H7
      SETSYS RAMP TYPE = H8
      SETSYS OVERRIDE ON = H9
      SETSYS OPERATING MODE = H10
      END
)");
  rig.set(0, {5000, -5000, 15, -15, 2, 1, 1000, 0, 2, 1, 5});
  rig.run();
  ASSERT_EQ(rig.machine.fault().number, 0) << rig.machine.fault().reason << rig.told();
  EXPECT_EQ(rig.parameter("P160"), 500'000);
  EXPECT_EQ(rig.parameter("P161"), -500'000);
  EXPECT_EQ(rig.parameter("P162"), 1'400) << "steps of 0.2 rpm, toward 0";
  EXPECT_EQ(rig.parameter("P170"), -1'400);
  EXPECT_EQ(rig.parameter("P171"), 200);
  EXPECT_EQ(rig.parameter("P172"), 0);
  EXPECT_EQ(rig.parameter("P303"), 100'000);
  EXPECT_EQ(rig.parameter("P730"), 0);
  EXPECT_EQ(rig.parameter("P916"), 2);
  EXPECT_EQ(rig.parameter("P930"), 1);
  EXPECT_EQ(rig.parameter("P700"), 5);
  rig.parameters.power_cycle();
  EXPECT_EQ(rig.parameter("P160"), 150'000) << "volatile";
}

// Towards 0, both ways: a shaft that is dragged shows every figure between.
TEST(GetSys, SpeedsAreCutToTenthsOfARpm) {
  ProgramRig rig(
      "M01 : GETSYS H0 = ACT.SPEED\nGETSYS H1 = SPEED SETPOINT\nGETSYS H2 = ACT.CURRENT\nJMP M01\n");
  rig.preset("P160", -777'800);
  rig.drive.set_inputs(kRunning);
  int32_t least = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    rig.tick(8);
    least = std::min(least, rig.h(0));
    EXPECT_LE(std::abs(int64_t{rig.h(0)} * 100), std::abs(int64_t{rig.drive.axis().speed}));
    EXPECT_GT(std::abs(int64_t{rig.h(0)} * 100) + 100, std::abs(int64_t{rig.drive.axis().speed}));
    EXPECT_GE(rig.drive.axis().output_current, rig.h(2) * 100);
  }
  EXPECT_EQ(rig.h(1), -7'778);
  EXPECT_EQ(least, -7'778);
}

// What a parameter cannot hold is refused, also where the number times its factor does not fit into 32 bits.
TEST(SetSys, GreatNumbersAreRefused) {
  // Of these 42949673 x 100 is 4 and -42949673 x 100 is -4 behind 32 bits.
  for (const int32_t given : {55'001, -55'001, 42'949'673, -42'949'673, INT32_MAX, INT32_MIN}) {
    ProgramRig rig("SETSYS FIXED SETPOINT 11 = H0\nEND\n");
    rig.h(0) = given;
    rig.run();
    EXPECT_EQ(rig.machine.fault().number, 10) << given;
    EXPECT_EQ(rig.parameter("P160"), 150'000) << given;
    EXPECT_NE(rig.told().find("P160"), std::string::npos) << rig.told();
  }
  ProgramRig rig("SETSYS MAX.CURRENT = H0\nEND\n");
  rig.h(0) = 1'009;
  rig.run();
  EXPECT_EQ(rig.parameter("P303"), 100'000) << "steps of 1 %, toward 0";
}

// The shape P916 is locked only while it is not linear, another one is wanted, and the drive is enabled.
TEST(SetSys, TheRampTypeIsLockedWhileACurvedOneMoves) {
  for (const int32_t before : {0, 1, 2})
    for (const int32_t wanted : {0, 1, 2})
      for (const bool enabled : {false, true}) {
        ProgramRig rig("SETSYS RAMP TYPE = H0\nSET H1 = 1\nM01 : JMP M01\n");
        rig.preset("P916", before);
        rig.h(0) = wanted;
        if (enabled) rig.drive.set_inputs(kRunning);
        rig.tick(4);
        rig.tick(4);
        const bool locked = enabled && before != 0 && wanted != before;
        EXPECT_EQ(rig.parameter("P916"), locked ? before : wanted) << before << wanted << enabled;
        EXPECT_EQ(rig.drive.fault(), locked ? 99 : 0) << before << wanted << enabled;
        EXPECT_EQ(rig.h(1), 1) << "the program goes on";
        if (locked) {
          EXPECT_NE(rig.told().find("F99 caused by task 1"), std::string::npos) << rig.told();
        }
      }
}

TEST(SetSys, RefusedValuesAreF10WithAReason) {
  ProgramRig rig("SETSYS MAX.CURRENT = H0\nEND\n");
  rig.h(0) = 1501;  // 150.1 %, P303 ends at 150 %; rounded to a step of P303 it would pass
  rig.run();
  EXPECT_EQ(rig.machine.fault().number, 0);
  ProgramRig more("SETSYS MAX.CURRENT = H0\nEND\n");
  more.h(0) = 1510;
  more.run();
  EXPECT_EQ(more.machine.fault().number, 10);
  EXPECT_NE(more.told().find("P303"), std::string::npos) << more.told();
  ProgramRig lacking("SETSYS RAMP TYPE = H0\nEND\n", "mc07");
  lacking.run();
  EXPECT_EQ(lacking.machine.fault().number, 10);
}

TEST(SetSys, ModesThatDoNotExistAreF77) {
  for (const char* command : {"SETSYS OPERATING MODE = H0\n", "SETSYS RAMP TYPE = H0\n"}) {
    // F77 has no response by itself: the program gives it one, and goes on behind the fault.
    ProgramRig rig(std::string("SETFR 77 = RAPID STOP/FAULT\n") + command + "SET H1 = 1\nEND\n");
    rig.h(0) = 99;
    rig.run();
    EXPECT_EQ(rig.machine.fault().number, 0);
    EXPECT_EQ(rig.h(1), 1);
    EXPECT_EQ(rig.drive.fault(), 77);
    EXPECT_NE(rig.told().find("F77 caused by task 1"), std::string::npos) << rig.told();
    ProgramRig silent(std::string(command) + "END\n");
    silent.h(0) = 99;
    silent.run();
    EXPECT_EQ(silent.drive.fault(), 0) << "factory setting: no response";
    EXPECT_NE(silent.told().find("F77"), std::string::npos) << "but it is told";
  }
}

TEST(SetSys, ChangingARampThatIsNotLinearWhileEnabledIsF99) {
  ProgramRig rig(R"(
      SETSYS RAMP TYPE = H0
M01 : JMP H9 == 0 , M01
      SETSYS RAMP TYPE = H1
M02 : JMP M02
)");
  rig.set(0, {1, 2});
  for (int ms = 0; ms < 500; ++ms) {
    if (ms == 10) rig.drive.set_inputs(kRunning);
    rig.tick(4);
  }
  EXPECT_EQ(rig.parameter("P916"), 1);
  EXPECT_EQ(rig.drive.fault(), 0);
  rig.h(9) = 1;
  rig.tick(4);
  rig.tick(4);
  EXPECT_EQ(rig.drive.fault(), 99);
  EXPECT_TRUE(rig.drive.error());
  EXPECT_FALSE(rig.drive.axis().output_stage) << "immediate switch-off";
  EXPECT_EQ(rig.parameter("P916"), 1);
  EXPECT_EQ(rig.machine.fault().number, 0) << "the program goes on";
}

TEST(SetSys, ResetsTheFault) {
  ProgramRig rig("M01 : SETSYS RESET = H0\nJMP M01\n");
  rig.drive.raise_fault(39);
  rig.tick();
  EXPECT_EQ(rig.drive.fault(), 39);
  rig.h(0) = 1;
  rig.tick();
  EXPECT_EQ(rig.drive.fault(), 0);
  EXPECT_EQ(rig.drive.resets(), 1U) << "only while there is something to reset";
}

}  // namespace
}  // namespace ipos::runtime
