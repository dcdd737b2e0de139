// MOVLNK and variable telegrams as programs use them, in a plant of two units: results, memory, blocking,
// spellings.
#include <gtest/gtest.h>

#include "compiler/asm/disassembler.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

// A MOVLNK to address 1 after `setup`; `after` follows the call in the next line.
std::string call(const std::string& setup, const std::string& after = "") {
  return "#include <const.h>\nMOVLNK Ml; MLDATA Mld; long lCopy, lDone;\nmain()\n{\n Ml.BusType = 5; "
         "Ml.Address = 1; "
         "Ml.Format = 6; Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = numof(Mld);\n " +
         setup + "\n _MoviLink(Ml);\n " + after + "\n lDone = 1;\n while (1) {}\n}\n";
}

std::string two(const std::string& unit = "md60a", const std::string& slave = "") {
  return bus_text() + station_text("unit1", "P813 = 0\nP814 = 5\n", unit, "A.IPC") +
         station_text("unit2", "P813 = 1\nP814 = 2\n" + slave, unit);
}

struct Call {
  explicit Call(const std::string& setup, const std::string& after = "", const std::string& unit = "md60a")
      : rig(two(unit), {{"A.IPC", call(setup, after)}}) {
    rig.run_until(300 * kMillisecond);
  }
  int32_t operator[](const std::string& name) { return rig.variable(0, name); }
  PlantRig rig;
};

TEST(Movlnk, ResultsOfAGoodCallABadIndexAndAnAbsentUnit) {
  PROVES("MOVLNK-09", "MOVLNK-10", "M07-SCOM-07");
  for (const char* unit : {"md60a", "mc07"}) {
    Call good("Ml.Index = 8600;", "", unit);
    EXPECT_EQ(good["Ml.Result"], 0);
    EXPECT_EQ(good["Mld.ReadPar"], 1);
    Call bad("Mld.ReadPar = 77; Mld.PI1 = 11; Ml.Index = 8299; Ml.Format = 4;", "", unit);
    EXPECT_EQ(bad["Ml.Result"], 0x08000010);  // class 8, additional code 10h: invalid index
    EXPECT_EQ(bad["Mld.ReadPar"], 77);
    EXPECT_EQ(bad["Mld.PI1"], 11);
    Call absent("Ml.Address = 9; Mld.ReadPar = 77; Mld.PI3 = 5; Ml.Format = 4;", "", unit);
    EXPECT_EQ(absent["Ml.Result"], 0x06020000);
    EXPECT_EQ(absent["Mld.ReadPar"], 77);
    EXPECT_EQ(absent["Mld.PI3"], 5);
    EXPECT_EQ(absent["lDone"], 1);  // the task goes on
  }
  // The documented time: 50 ms for each answer.
  PlantRig rig(two(), {{"A.IPC", call("Ml.Address = 9;")}});
  rig.run_until(45 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "lDone"), 0);
  rig.run_until(60 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "lDone"), 1);
}

TEST(Movlnk, WritesAreKeptOrNot) {
  PROVES("MOVLNK-07", "M07-SCOM-05");
  for (const char* unit : {"md60a", "mc07"})
    for (const int service : {2, 3}) {
      const uint16_t index = std::string(unit) == "md60a" ? 8470 : 8807;  // P130, factory setting 2 s
      Call write("Ml.Service = " + std::to_string(service) + "; Ml.Index = " + std::to_string(index) +
                     "; Mld.WritePar = 3000;",
                 "", unit);
      EXPECT_EQ(write["Ml.Result"], 0);
      ASSERT_EQ(write.rig.with(523).size(), 1U);
      EXPECT_EQ(write.rig.with(523)[0].frame.data[0], 0x30 + service);
      ParameterStore& slave = write.rig.station(1).drive().parameters();
      EXPECT_EQ(slave.value(index), 3000);
      slave.power_cycle();
      EXPECT_EQ(slave.value(index), service == 2 ? 3000 : 2000);
    }
  Call read("", "", "mc07");
  EXPECT_EQ(read.rig.with(523)[0].frame.data[0], 0x31);
}

TEST(Movlnk, GroupsGetNoReply) {
  PROVES("MOVLNK-14");
  Call write(
      "Ml.Address = 102; Ml.Format = 4; Ml.Service = 2; Ml.Index = 8470; Mld.WritePar = 3000; Mld.PO2 = 9; "
      "Mld.ReadPar = 77; Mld.PI1 = 11;");
  EXPECT_EQ(write["Ml.Result"], 0);
  EXPECT_EQ(write["Mld.ReadPar"], 77);
  EXPECT_EQ(write["Mld.PI1"], 11);
  EXPECT_EQ(write.rig.ids(), (std::vector<uint32_t>{534, 22}));
  EXPECT_LT(write.rig.frames.back().end, 20 * kMillisecond);
  EXPECT_EQ(write.rig.station(1).drive().parameters().value(8470), 3000);
  EXPECT_EQ(write.rig.station(1).drive().state().po()[1], 9);
  Call read("Ml.Address = 102; Ml.Format = 4;");
  EXPECT_NE(read["Ml.Result"], 0);
  EXPECT_TRUE(read.rig.frames.empty());
}

TEST(Movlnk, TheCallHasFinishedInTheNextLine) {
  PROVES("MOVLNK-15");
  Call copy("Ml.Index = 8600;", "lCopy = Mld.ReadPar;");
  EXPECT_EQ(copy["lCopy"], 1);
}

TEST(Movlnk, TwoMastersAtATimeAreReported) {
  PROVES("MOVLNK-13", "M07-SCOM-10");
  for (const char* unit : {"md60a", "mc07"}) {
    PlantRig rig(bus_text() + station_text("m1", "P813 = 0\n", unit, "A.IPC") +
                     station_text("m2", "P813 = 2\n", unit, "B.IPC") +
                     station_text("s1", "P813 = 1\n", unit) + station_text("s3", "P813 = 3\n", unit),
                 {{"A.IPC", call("", "while (1) { _MoviLink(Ml); }")},
                  {"B.IPC", call("Ml.Address = 3;", "while (1) { _MoviLink(Ml); }")}});
    rig.run_until(100 * kMillisecond);
    EXPECT_EQ(rig.says("m1 and m2 are masters at the same time; only one may be active in the network"), 1U);
  }
}

TEST(Movlnk, ReservedBusTypesSendNothing) {
  PROVES("M07-SCOM-02");
  for (const int type : {0, 1, 3, 4}) {
    Call reserved("Ml.BusType = " + std::to_string(type) + ";", "", "mc07");
    EXPECT_NE(reserved["Ml.Result"], 0) << type;
    EXPECT_TRUE(reserved.rig.frames.empty());
  }
}

TEST(Movlnk, AddressesAndFormatsOfMovitrac07) {
  PROVES("M07-SCOM-03", "M07-SCOM-04", "M07-SCOM-06");
  const auto trace = [](const std::string& setup) { return Call(setup, "", "mc07").rig.ids(); };
  EXPECT_EQ(trace("Ml.Address = 150; Ml.Format = 4; Ml.Service = 2; Ml.Index = 8470; Mld.WritePar = 3000;"),
            (std::vector<uint32_t>{918, 406}));
  for (const int address : {64, 99}) {
    Call outside("Ml.Address = " + std::to_string(address) + ";", "", "mc07");
    EXPECT_NE(outside["Ml.Result"], 0);
    EXPECT_TRUE(outside.rig.frames.empty());
  }
  EXPECT_EQ(trace("Ml.Format = 4;"), (std::vector<uint32_t>{523, 524, 11, 12}));
  EXPECT_EQ(trace("Ml.Format = 5;"), (std::vector<uint32_t>{11, 12}));
  EXPECT_EQ(trace("Ml.Format = 6;"), (std::vector<uint32_t>{523, 524}));
  // 1..127 over CANopen: SDO requests, which nobody here answers, so that an abort follows.
  for (const int address : {1, 63, 64, 127}) {
    Call canopen("Ml.BusType = 6; Ml.Format = 6; Ml.Address = " + std::to_string(address) + ";", "", "mc07");
    EXPECT_EQ(canopen["Ml.Result"], 0x0602'0000) << "no answer";
    const auto id = static_cast<uint32_t>(0x600 + address);
    EXPECT_EQ(canopen.rig.ids(), (std::vector<uint32_t>{id, id}));
  }
  for (const int address : {0, 128, 150, -1}) {
    Call outside("Ml.BusType = 6; Ml.Format = 6; Ml.Address = " + std::to_string(address) + ";", "", "mc07");
    EXPECT_EQ(outside["Ml.Result"], 0x0505'0000) << address;
    EXPECT_TRUE(outside.rig.frames.empty()) << address;
  }
  for (const int words : {1, 2, 3}) {
    Call format("Ml.Format = " + std::to_string(2 * words - 1) + "; Mld.PO1 = 1; Mld.PO2 = 2; Mld.PO3 = 3;",
                "", "mc07");
    const Frame po = format.rig.with(11)[0].frame;
    EXPECT_EQ(po.length, 6);
    for (int n = 0; n < 3; ++n) EXPECT_EQ(po.data[static_cast<size_t>(2 * n + 1)], n < words ? n + 1 : 0);
  }
  // DPointer 20: read value in H21, PI1 in H25, PI3 in H27.
  Call pointer("Ml.Format = 4; Ml.DPointer = 20; Ml.Index = 8600;", "", "mc07");
  EXPECT_EQ(pointer["H21"], 1);
  const Frame pi = pointer.rig.with(12)[0].frame;
  EXPECT_EQ(pointer["H25"], static_cast<int16_t>(pi.data[0] << 8 | pi.data[1]));
  EXPECT_NE(pointer["H25"], 0);
}

// --- spellings and structures

std::vector<uint32_t> code_of(const std::string& source) {
  const compiler::Compilation compiled = compiler::compile("a.IPC", "a.IPC", source);
  EXPECT_TRUE(compiled.image) << compiler::render_text(compiled.diagnostics.all(), *compiled.sources, false);
  return compiled.image ? compiled.image->code : std::vector<uint32_t>{};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

const std::string kScom =
    "#include <const.h>\nSCTRCYCL TrCycl; long lTrDataLow, lTrDataHigh; SCREC Rec; SCTRACYCL Ac;\nmain()\n{\n"
    " TrCycl.ObjectNo = 1024; TrCycl.CycleTime = 100; TrCycl.Offset = 0; TrCycl.Format = 8; "
    "TrCycl.DPointer = numof(lTrDataLow);\n _SBusCommDef(SCD_TRCYCL, TrCycl);\n _SBusCommDef(SCD_REC, Rec);\n"
    " _SBusCommDef(SCD_TRACYCL, Ac);\n _SBusCommOn();\n}\n";

TEST(Scom, NamesAndSpellings) {
  PROVES("SCOM-01", "SCOM-06", "M07-SCOM-33");
  EXPECT_EQ(code_of(replaced(kScom, "_SBusCommDef", "_SBusComDef")), code_of(kScom));
  EXPECT_EQ(code_of(replaced(kScom, "TrCycl.Format", "TrCycl.Len")), code_of(kScom));
  EXPECT_EQ(code_of(replaced(kScom, "CycleTime", "Cycletime")), code_of(kScom));
  const std::string text = compiler::disassemble(*compiler::compile("a", "a", kScom).image);
  EXPECT_NE(text.find("SCOM TRANSMIT CYCLIC, H420"), std::string::npos) << text;
  EXPECT_NE(text.find("SCOMON"), std::string::npos);
}

TEST(Scom, KindsAndStructures) {
  PROVES("SCOM-02", "SCOM-03");
  for (const char* kind : {"SCD_TRCYCL", "SCD_REC", "SCD_TRACYCL"})
    EXPECT_NE(kScom.find(kind), std::string::npos);  // all three compile above
  for (const char* wrong : {"SCD_NONE", "7", "0"}) {
    const compiler::Compilation compiled = compiler::compile("a", "a", replaced(kScom, "SCD_TRCYCL", wrong));
    EXPECT_FALSE(compiled.image) << wrong;
    EXPECT_TRUE(compiled.diagnostics.has_errors());
  }
  const compiler::Compilation compiled = compiler::compile("a", "a", kScom);
  const std::string text = compiler::disassemble(*compiled.image, compiler::VariableNames::Numbers);
  EXPECT_NE(text.find("SCOM TRANSMIT CYCLIC, H420"), std::string::npos);
  EXPECT_NE(text.find("SET H424 = 426"), std::string::npos) << text;  // numof(x) with x at H426
}

TEST(Scom, OffsetsOfMovlnkAndItsData) {
  PROVES("M07-SCOM-01");
  const compiler::Compilation compiled =
      compiler::compile("a", "a", "#include <const.h>\nMOVLNK Ml;\nmain() { Ml.Result = 1; }\n");
  const char* members[] = {"BusType", "Address", "Format", "Service", "Index", "DPointer", "Result"};
  ASSERT_EQ(compiled.image->symbols.size(), 7U);
  for (size_t n = 0; n < 7; ++n) {
    EXPECT_EQ(compiled.image->symbols[n].name, std::string("Ml.") + members[n]);
    EXPECT_EQ(compiled.image->symbols[n].variable, 420 + n);
  }
  // The VM takes them from there: a call to the own unit.
  Call own("Ml.Address = 253; Ml.Index = 8601;");
  EXPECT_EQ(own["H420"], 5);
  EXPECT_EQ(own["H426"], 0);
  EXPECT_EQ(own["Mld.ReadPar"], 5);  // P814 of unit 1
}

// --- one-shot telegrams

std::string shot() {
  return "#include <const.h>\nSCTRACYCL Ac; long lData, lFirst;\nmain()\n{\n Ac.ObjectNo = 1030; Ac.Format = "
         "4; "
         "Ac.DPointer = numof(lData);\n lData = 5;\n _SBusCommDef(SCD_TRACYCL, Ac);\n lFirst = Ac.Result;\n "
         "while (1) "
         "{}\n}\n";
}

TEST(Scom, OneShotGoesOutAtOnceAndReportsItsFate) {
  PROVES("M07-SCOM-25", "M07-SCOM-26");
  PlantRig good(two("mc07"), {{"A.IPC", shot()}}, vm::Rates{{20, 20, 20}});
  good.run_until(kSecond);
  EXPECT_EQ(good.ids(), std::vector<uint32_t>{1030});
  EXPECT_EQ(good.variable(0, "lFirst"), 1);  // in progress
  EXPECT_EQ(good.variable(0, "Ac.Result"), 2);
  // A short circuit drives the unit bus-off.
  PlantRig shorted(two("mc07") + fault_text("short", "until = \"500ms\"\n"), {{"A.IPC", shot()}});
  shorted.run_until(100 * kMillisecond);
  EXPECT_TRUE(shorted.frames.empty());
  EXPECT_EQ(shorted.says("unit1 is bus-off"), 1U);
  EXPECT_EQ(shorted.variable(0, "Ac.Result"), 3);
  // A disturbed frame is repeated by the controller: sent, not failed.
  PlantRig disturbed(two("mc07") + fault_text("corrupt", "frame = 1\n"), {{"A.IPC", shot()}});
  disturbed.run_until(100 * kMillisecond);
  EXPECT_EQ(disturbed.variable(0, "Ac.Result"), 2);
}

// A setpoint of several commands in a cyclic object: the telegram sends what the variable holds.
TEST(Atomic, SetpointsInTelegrams) {
  const std::string sender =
      "#include <constb.h>\nSCTRCYCL tx; long lSetp, lDummy, lHalf;\nmain() { tx.ObjectNo = 1100; "
      "tx.CycleTime = 7;"
      " tx.Format = 4; tx.DPointer = numof(lSetp); lSetp = 6000; lHalf = 20480; _SBusCommDef(SCD_TRCYCL, tx);"
      " _SBusCommOn(); while (1) { lSetp = lHalf * 2 * 100 / 4096 + 5000; } }";
  const auto torn = [&](bool atomic) {
    PlantRig rig(bus_text() + station_text("a", "P881 = 1\n", "mdxb", "A.IPC") +
                     station_text("b", "P881 = 2\n", "mdxb"),
                 {{"A.IPC", sender}}, {}, atomic);
    rig.run_until(5 * kSecond);
    const auto sent = rig.with(1100);
    EXPECT_GT(sent.size(), 700U);
    return std::count_if(sent.begin(), sent.end(), [](const FrameRecord& record) {
      const auto& data = record.frame.data;
      return ((data[0] << 24) | (data[1] << 16) | (data[2] << 8) | data[3]) != 6000;
    });
  };
  EXPECT_GT(torn(false), 200);
  EXPECT_EQ(torn(true), 0);
}

}  // namespace
}  // namespace ipos::tests
