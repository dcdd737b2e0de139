// Responses, reset, memory, conditional calls, and the values that are parameters and variables at once.
#include <gtest/gtest.h>

#include "tests/runtime/unit/program_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::ProgramRig;

TEST(FaultReaction, WritesTheParameterOfTheFault) {
  ProgramRig rig("SETFR 26 = IMMEDIATE STOP/WARNING\nEND\n");
  rig.run();
  EXPECT_EQ(rig.parameter("P830"), 5);
  rig.drive.raise_fault(26);
  EXPECT_FALSE(rig.drive.error());
  EXPECT_EQ(rig.drive.fault(), 26);
  rig.parameters.power_cycle();
  EXPECT_EQ(rig.parameter("P830"), 3) << "volatile";
}

TEST(FaultReaction, OfFaultsWithoutParameter) {
  ProgramRig rig("SETFR 78 = DISPLAY FAULT\nSETFR 39 = NO RESPONSE\nEND\n");
  rig.run();
  ASSERT_EQ(rig.machine.fault().number, 0);
  rig.drive.raise_fault(39);
  EXPECT_EQ(rig.drive.fault(), 0);
  rig.drive.raise_fault(78);
  EXPECT_EQ(rig.drive.fault(), 78);
  EXPECT_FALSE(rig.drive.error());
  rig.drive.power_cycle();
  rig.drive.raise_fault(39);
  EXPECT_TRUE(rig.drive.error()) << "volatile";
}

TEST(FaultReaction, FixedAndUnknownOnesAreF10) {
  for (const char* command :
       {"SETFR 10 = NO RESPONSE\n", "SETFR 41 = NO RESPONSE\n", "SETFR 250 = NO RESPONSE\n",
        "SETFR -1 = NO RESPONSE\n", "SETFR 266 = NO RESPONSE\n"}) {
    ProgramRig rig(std::string(command) + "END\n");
    rig.run();
    EXPECT_EQ(rig.machine.fault().number, 10) << command;
  }
}

// Where the list of the unit has no parameter for it, or the parameter not this response, the program stops with F10.
TEST(FaultReaction, WhatTheUnitCannotDoIsF10) {
  struct Row {
    const char *unit, *command, *told;
  };
  for (const Row& row :
       {Row{"mc07", "SETFR 26 = IMMEDIATE STOP/WARNING", "P830"}, Row{"mc07", "SETFR 31 = NO RESPONSE", ""},
        Row{"mdxb", "SETFR 26 = RAPID STOP/WARNING", nullptr}}) {
    ProgramRig rig(std::string(row.command) + "\nSET H0 = 1\nEND\n", row.unit);
    rig.run();
    EXPECT_EQ(rig.machine.fault().number, row.told == nullptr ? 0 : 10) << row.command;
    EXPECT_EQ(rig.h(0), row.told == nullptr ? 1 : 0);
    if (row.told != nullptr && *row.told != '\0') {
      EXPECT_NE(rig.told().find(row.told), std::string::npos) << rig.told();
    } else {
      EXPECT_EQ(rig.told(), "");
    }
  }
}

// H490 has the time (IPOSplus p. 34); 0 is one, a negative number is none.
TEST(WatchdogCommands, ByConstantAndByVariable) {
  for (const auto& [text, time, fault] :
       {std::tuple{"WDON 10\nEND\n", 10, 0}, {"WDON 0\nEND\n", 0, 0}, {"WDON H7\nEND\n", 25, 0}}) {
    ProgramRig rig(text);
    rig.h(7) = 25;
    rig.h("WdogTimer") = 3;
    rig.run();
    EXPECT_EQ(rig.machine.fault().number, fault) << text;
    EXPECT_EQ(rig.h("WdogTimer"), time) << text;
    EXPECT_TRUE(rig.timers.watchdog_runs());
  }
  ProgramRig negative("WDON H7\nEND\n");
  negative.h(7) = -1;
  negative.run();
  EXPECT_EQ(negative.machine.fault().number, 10);
  EXPECT_FALSE(negative.timers.watchdog_runs());
  ProgramRig off("WDON 10\nWDOFF\nEND\n");
  off.run();
  EXPECT_FALSE(off.timers.watchdog_runs());
}

TEST(Reset, TakesTheNumberAndResets) {
  ProgramRig rig("RESET H0\nRESET H1\nEND\n");
  rig.h(1) = 5;
  rig.drive.raise_fault(39);
  rig.run();
  EXPECT_EQ(rig.drive.resets(), 1U) << "only while there is something to reset";
  EXPECT_EQ(rig.h(0), 39);
  EXPECT_EQ(rig.h(1), 0);
  EXPECT_EQ(rig.drive.fault(), 0);
}

TEST(Memorize, KeepsTheFirst128Variables) {
  ProgramRig rig(R"(
      MEM NOTHING
      MEM STORE DATA
      SET H0 = 2
      SET H127 = 2
      SET H128 = 2
      MEM LOAD ALL
      END
)");
  rig.h(0) = rig.h(127) = rig.h(128) = 1;
  rig.run();
  EXPECT_EQ(rig.h(0), 1);
  EXPECT_EQ(rig.h(127), 1);
  EXPECT_EQ(rig.h(128), 2);
  EXPECT_EQ(rig.drive.fault(), 0);
}

// A memory that fails: F25, and the program goes on.
TEST(Memorize, FailureIsF25) {
  struct Broken final : RetainedMemory {
    bool memorize(Memorize) override { return false; }
  } broken;
  ProgramRig rig("MEM STORE ALL\nSET H0 = 1\nEND\n");
  SystemCommands commands(rig.services(broken), rig.journal, "unit1", &rig.image);
  vm::Machine machine(rig.machine.program(), commands.host());
  machine.start();
  machine.run(1, 10);
  EXPECT_EQ(machine.variables()[0], 1);
  EXPECT_EQ(rig.drive.fault(), 25);
}

TEST(InputCall, AllInputsOfTheMask) {
  ProgramRig rig(R"(
M01 : INPCALL HIGH 6 , M02
      INPCALL LOW 6 , M03
      INPCALL HIGH 0 , M04
      END
M02 : ADD H0 + 1
      RET
M03 : ADD H1 + 1
      RET
M04 : ADD H2 + 1
      RET
)");
  const struct {
    uint16_t levels;
    int32_t high, low;
  } rows[] = {{0b0110, 1, 0}, {0b0111, 2, 0}, {0b0100, 2, 0}, {0b0010, 2, 0}, {0b1001, 2, 1}, {0, 2, 2}};
  for (const auto& row : rows) {
    rig.drive.set_inputs(row.levels);
    rig.machine.start();
    rig.tick();
    EXPECT_EQ(rig.h(0), row.high) << row.levels;
    EXPECT_EQ(rig.h(1), row.low) << row.levels;
  }
  EXPECT_EQ(rig.h(2), 6) << "no input is missing in an empty mask";
}

TEST(SystemCall, Events) {
  ProgramRig rig(R"(
      SYSCALL ALWAYS , M02
      SYSCALL STANDSTILL , M03
      SYSCALL NOT IN POSITION , M04
      SYSCALL NOT REFERENCED , M05
      END
M02 : ADD H0 + 1
      RET
M03 : ADD H1 + 1
      RET
M04 : ADD H2 + 1
      RET
M05 : ADD H3 + 1
      RET
)");
  rig.run();
  EXPECT_EQ((std::array{rig.h(0), rig.h(1), rig.h(2), rig.h(3)}), (std::array{1, 1, 1, 1}));
  rig.h("StatusWord") = 1 << 19 | 1 << 20;
  rig.preset("P160", 600'000);
  rig.drive.set_inputs(1 << 0 | 1 << 1 | 1 << 3 | 1 << 4);
  for (int ms = 0; ms < 1000; ++ms) rig.drive.tick();
  rig.machine.start();
  rig.run();
  EXPECT_EQ((std::array{rig.h(0), rig.h(1), rig.h(2), rig.h(3)}), (std::array{2, 1, 1, 1}));
}

// PID_Mode and the others are the same datum as their parameters (IPOSplus p. 38, 39).
TEST(Mirrored, VariableAndParameterAreOne) {
  ProgramRig rig("M01 : JMP M01\n");
  rig.tick();
  EXPECT_EQ(rig.h("PID_K_p"), 1000) << "default 1.000";
  EXPECT_EQ(rig.h("PID_SetpMax"), 7500);
  rig.h("PID_K_p") = 2500;
  rig.tick();
  EXPECT_EQ(rig.parameter("P263"), 2500);
  const uint16_t index = rig.parameters.table().find("P263")->index;
  ASSERT_TRUE(rig.parameters.execute(ParameterService::Write, index, 300));
  rig.tick();
  EXPECT_EQ(rig.h("PID_K_p"), 300);
  rig.h("PID_K_p") = 32'001;  // beyond the printed range
  rig.tick();
  EXPECT_EQ(rig.h("PID_K_p"), 300);
}

}  // namespace
}  // namespace ipos::runtime
