// What a program can still do to the world beside its variables: to the bus, to the drive, to positions.
#include "runtime/unit/program_reach.hpp"

#include <gtest/gtest.h>

#include "tests/runtime/scom/objects_rig.hpp"
#include "tests/runtime/unit/program_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::ProgramRig;

TEST(SystemVariables, AreThoseOfTheTable) {
  for (const char* name :
       {"StatusWord", "InputLevel", "OutputLevel", "ControlWord", "ActPos_Mot", "Timer_0", "TargetPos"})
    EXPECT_TRUE(is_system_variable(stdlib::find_system_variable(std::string_view(name))->number)) << name;
  for (const size_t number : {0U, 127U, 128U, 400U, 600U, 1023U})
    EXPECT_FALSE(is_system_variable(number)) << number;
}

TEST(ProgramReach, FollowsFromTheCommandsThatAreAhead) {
  struct Row {
    const char* text;
    bool mute, modest, quiet, reads_position, reads_travel;
  };
  for (const Row& row :
       {Row{"END\n", true, true, true, false, false}, Row{"M01 : ADD H0 + 1\nJMP M01\n", true, true, true, false, false},
        Row{"MOVLNK H0\nEND\n", false, true, false, false, false}, Row{"SCOMON\nEND\n", false, true, false, false, false},
        Row{"SET H484 = 0\nEND\n", true, false, false, false, false},
        Row{"GOA NOWAIT #1000\nEND\n", true, true, false, false, false},
        Row{"SET H0 = H511\nEND\n", true, true, true, true, true}, Row{"SET H0 = H491\nEND\n", true, true, true, true, true},
        // While an axis is on its way its target stays; a lag is one of a travel.
        Row{"SET H0 = H492\nEND\n", true, true, true, true, false}, Row{"SET H0 = H495\nEND\n", true, true, true, false, true}}) {
    const ProgramRig rig(row.text);
    const ProgramReach reach(rig.machine, {});
    EXPECT_EQ(reach.mute, row.mute) << row.text;
    EXPECT_EQ(reach.modest, row.modest) << row.text;
    EXPECT_EQ(reach.quiet, row.quiet) << row.text;
    EXPECT_EQ(reach.reads_travel, row.reads_travel) << row.text;
    EXPECT_EQ(reach.reads_position, row.reads_position) << row.text;
    EXPECT_FALSE(reach.sends_position) << row.text;
  }
  const ProgramRig counts("M01 : ADD H7 + 1\nADD H9 + 1\nJMP M01\n");
  const ProgramReach reach(counts.machine, {});
  EXPECT_TRUE(reach.apart);
  EXPECT_EQ(std::vector<uint16_t>(reach.rollback.begin(), reach.rollback.end()),
            (std::vector<uint16_t>{7, 9}));
}

// A unit that positions refuses no command of positioning.
TEST(ProgramReach, CommandsOfPositioningAreNoFaultsWhereTheUnitPositions) {
  struct Row {
    const char* text;
    bool faults, faults_positioning;
  };
  for (const Row& row : {Row{"ADD H0 + 1\nEND\n", false, false}, Row{"GOA NOWAIT #1000\nEND\n", true, false},
                         Row{"GOR WAIT H7\nEND\n", true, false}, Row{"ASTOP ENABLE\nEND\n", true, false},
                         Row{"GOA NOWAIT #1000\nDIV H0 / H1\nEND\n", true, true},
                         Row{"GOA NOWAIT #1000\nMOVLNK H0\nEND\n", true, true}}) {
    const ProgramRig rig(row.text);
    EXPECT_EQ(ProgramReach(rig.machine, {}).may_fault, row.faults) << row.text;
    EXPECT_EQ(ProgramReach(rig.machine, {}, true).may_fault, row.faults_positioning) << row.text;
  }
}

// A telegram that sends a system variable, or brings one, ties the program to it: at its first or second variable.
TEST(ProgramReach, TelegramsOfSystemVariables) {
  struct Row {
    int32_t data, format;
    bool system;
  };
  for (const Row& row : {Row{426, 8, false}, Row{426, 4, false}, Row{511, 4, true}, Row{510, 8, true},
                         Row{300, 8, false}, Row{600, 8, false}, Row{511, 0, false}})
    for (const bool sent : {false, true}) {
      ProgramRig rig("M01 : ADD H0 + 1\nJMP M01\n");
      Outbox outbox;
      VariableObjects objects(rig.unit, 500'000, outbox, 100);
      std::string why;
      rig.set(20, sent ? std::initializer_list<int32_t>{1100, 10, 0, row.format, row.data}
                       : std::initializer_list<int32_t>{1100, row.format, row.data});
      ASSERT_TRUE(objects.define(sent ? ObjectKind::TransmitCyclic : ObjectKind::Receive, 20,
                                 rig.machine.variables(), why));
      ASSERT_EQ(why, "");
      const VariableObjects* const all[] = {&objects};
      const ProgramReach reach(rig.machine, all);
      EXPECT_EQ(reach.sends_position, sent && row.system) << row.data << ", " << row.format;
      EXPECT_EQ(reach.apart, sent || !row.system) << row.data << ", " << row.format;
    }
}

}  // namespace
}  // namespace ipos::runtime
