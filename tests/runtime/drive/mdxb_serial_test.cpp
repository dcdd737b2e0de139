// MOVIDRIVE B as slave on RS-485: waiting, timeout and master/slave as its manual has them (MDX60B/61B
// sections 4.2, 4.3.1, 4.4.1).
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

struct MdxbRig : DriveRig {
  MdxbRig() : DriveRig("mdxb") {
    enable_terminals();
    set("P100", 2);
    set("P101", 0);  // the enable comes from the terminals
    set("P136", 600);
    set("P137", 1200);
  }
  void telegram() { drive.take_po(PoSource::Rs485, Words{0x0006, 5000, 0}); }
};

TEST(MdxbSerial, NoMotionBeforeTheFirstRequest) {
  PROVES("MDB-PAR-15");
  MdxbRig rig;
  for (int round = 0; round < 2; ++round) {
    rig.run_ms(2000);
    EXPECT_EQ(rig.drive.display(), 't') << round;
    EXPECT_EQ(rig.rpm(), 0) << round;
    EXPECT_FALSE(rig.stage()) << round;
    rig.telegram();
    rig.run_ms(200);
    EXPECT_NE(rig.drive.display(), 't') << round;
    EXPECT_GT(rig.rpm(), 0) << round;
    rig.drive.raise_fault(1);  // after a fault reset it waits again
    rig.run_ms(2000);
    rig.drive.reset_fault();
  }
}

TEST(MdxbSerial, TimeoutOfAFreshUnitIsARapidStopWithWarning) {
  PROVES("MDB-PAR-12", "MDB-PAR-16");
  const DriveRig fresh("mdxb");
  EXPECT_EQ(fresh.value("P833"), 7);
  for (const auto& text : fresh.parameters.table().find("P833")->texts)
    if (text.value == 7) {
      EXPECT_NE(text.text.find("RAPID"), std::string_view::npos) << text.text;
    }
  MdxbRig rig;
  rig.set("P812", 500);
  rig.po({0x0006, 5000, 0}, PoSource::Rs485);
  rig.settle();
  EXPECT_EQ(rig.rpm(), 1000);
  rig.silence();
  rig.telegram();
  rig.run_ms(501);
  EXPECT_EQ(rig.drive.fault(), 43);
  EXPECT_FALSE(rig.drive.error()) << "a warning";
  EXPECT_NEAR(rig.ms_until_standing(), mdx_ramp_ms(1000, 600), 2) << "P136, not P137";
  rig.run_ms(1000);
  // Communication is back, without reset: the last process data act again.
  rig.drive.take_request(PoSource::Rs485);
  rig.run_ms(300);
  EXPECT_EQ(rig.drive.fault(), 0);
  EXPECT_GT(rig.rpm(), 0);
  rig.drive.take_request(PoSource::Rs485);
  rig.run_ms(499);
  EXPECT_EQ(rig.rpm(), 1000);
}

// P100 decides whether the telegrams of a master are taken. With P100 = RS485 they are ordinary group
// telegrams.
TEST(MdxbSerial, OnlyP100MasterFollowsTheMaster) {
  PROVES("MDB-MS-02");
  for (int32_t source = 0; source <= 10; ++source) {
    if (source == 2) continue;
    MdxbRig rig;
    rig.set("P100", source);
    rig.po({0x0006, 5000, 0}, PoSource::Rs485);
    rig.run_ms(3000);
    EXPECT_EQ(rig.rpm(), source == 9 ? 1000 : 0) << source;
    MdxbRig sbus;
    sbus.set("P100", source);
    sbus.po({0x0006, 5000, 0}, PoSource::Sbus);
    sbus.run_ms(3000);
    if (source != 10) {
      EXPECT_EQ(sbus.rpm(), source == 8 ? 1000 : 0) << source;
    }
  }
}

// Section 4.2: terminals and program stay effective whatever P101 is.
TEST(MdxbSerial, TerminalsAndProgramStayEffective) {
  PROVES("MDB-PAR-08");
  const DriveRig fresh("mdxb");
  const auto has = [&](const char* number, const char* word) {
    for (const auto& text : fresh.parameters.table().find(number)->texts)
      if (text.text.find(word) != std::string_view::npos) return true;
    return false;
  };
  for (const char* word : {"BIPOL", "RS-485", "FIELDBUS", "SBus"}) EXPECT_TRUE(has("P100", word)) << word;
  for (const char* word : {"TERMINALS", "RS-485", "FIELDBUS", "SBus"}) EXPECT_TRUE(has("P101", word)) << word;
  struct Source {
    int32_t p100, p101;
    PoSource bus;
  };
  for (const Source& source : {Source{2, 0, PoSource::Rs485}, Source{2, 1, PoSource::Rs485},
                               Source{3, 2, PoSource::Fieldbus}, Source{10, 3, PoSource::Sbus}}) {
    DriveRig rig("mdxb");
    rig.enable_terminals();
    rig.set("P100", source.p100);
    rig.set("P101", source.p101);
    rig.po({0x0006, 5000, 0}, source.bus);
    const auto runs = [&] {
      rig.run_ms(5000);
      return rig.rpm() > 900;
    };
    EXPECT_TRUE(runs()) << source.p101;
    for (const char* input : {"DI00", "DI01", "DI03"}) {
      rig.input(input, false);
      EXPECT_FALSE(runs()) << source.p101 << input;
      rig.input(input, true);
      EXPECT_TRUE(runs()) << source.p101 << input;
    }
    for (const uint32_t word : {1U << 30, 1U << 1}) {  // H484: controller inhibit, no enable
      rig.program_word(word);
      EXPECT_FALSE(runs()) << source.p101 << " " << word;
      rig.program_word(0);
      EXPECT_TRUE(runs()) << source.p101 << " " << word;
    }
  }
}

// PO1 control word 1, PO2 speed, PO3 IPOS PO; PI1 status word 1, PI2 speed, PI3 IPOS PI.
TEST(MdxbSerial, ProcessDataOfAFollowerAreFixed) {
  MdxbRig rig;
  for (const char* number : {"P870", "P871", "P872", "P873", "P874", "P875"}) rig.set(number, 0);
  rig.set("P100", 9);
  rig.po({0x0006, 5000, 0}, PoSource::Rs485);
  rig.run_ms(3000);
  EXPECT_EQ(rig.rpm(), 1000) << "PO2 is the speed, whatever P871 says";
}

// Read so, too, and writes have no effect. In torque control PO2 is the current.
TEST(MdxbSerial, ProcessDataOfAFollowerReadAsTheyAre) {
  PROVES("MDB-MS-03");
  const char* const numbers[] = {"P870", "P871", "P872", "P873", "P874", "P875"};
  for (const int32_t source : {8, 9})
    for (const int32_t mode : {0, 12, 17}) {
      MdxbRig rig;
      rig.set("P100", source);
      rig.set("P700", mode);
      const std::vector<int32_t> fixed = {9, mode == 0 ? 1 : 2, 12, 6, 1, 9};
      for (const int32_t written : {0, 1, 5}) {
        for (const char* number : numbers) rig.write(number, written);
        std::vector<int32_t> read;
        for (const char* number : numbers) read.push_back(rig.value(number));
        EXPECT_EQ(read, fixed) << source << " " << mode;
        EXPECT_EQ(rig.value("P876"), 1);
      }
    }
}

}  // namespace
}  // namespace ipos::tests
