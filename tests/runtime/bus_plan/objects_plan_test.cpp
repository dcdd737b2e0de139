// Variable objects in the planner and in the run: identifiers that are not free, formats, the missing start
// command.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "runtime/bus_plan/names.hpp"
#include "runtime/bus_plan/plan.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

std::string send_program(int id, const std::string& format = "4", bool start = true) {
  return "#include <const.h>\nSCTRCYCL Tr; long lData, lMore;\nmain()\n{\n lData = 287454020; Tr.ObjectNo "
         "= " +
         std::to_string(id) + "; Tr.CycleTime = 10; Tr.Offset = 0; Tr.Format = " + format +
         "; Tr.DPointer = numof(lData);\n _SBusCommDef(SCD_TRCYCL, Tr);\n" +
         (start ? " _SBusCommOn();\n" : "") + " while (1) {}\n}\n";
}

std::string receive_program(int id, const std::string& format = "4", bool start = true) {
  return "#include <const.h>\nSCREC Rec; long lData, lMore;\nmain()\n{\n Rec.ObjectNo = " +
         std::to_string(id) + "; Rec.Format = " + format +
         "; Rec.DPointer = numof(lData);\n _SBusCommDef(SCD_REC, Rec);\n" +
         (start ? " _SBusCommOn();\n" : "") + " while (1) {}\n}\n";
}

std::string two(const std::string& unit = "md60a") {
  return bus_text() + station_text("unit1", "P813 = 0\n", unit, "A.IPC") +
         station_text("unit2", "P813 = 1\n", unit, "B.IPC");
}

BusPlan plan_of(const std::string& toml, const std::map<std::string, std::string>& sources) {
  PlantRig rig(toml, sources);
  return make_plan(rig.get(), {});
}

std::vector<std::string> texts(const BusPlan& plan, FindingKind kind) {
  std::vector<std::string> list;
  for (const Finding& finding : plan.findings)
    if (finding.kind == kind) list.push_back(finding.text);
  return list;
}

TEST(Objects, OneSenderAndNoMovilinkIdentifiers) {
  PROVES("VAR-03");
  BusPlan plan = plan_of(two(), {{"A.IPC", send_program(1024)}, {"B.IPC", send_program(1024)}});
  EXPECT_EQ(texts(plan, FindingKind::DoubleIdentifier),
            std::vector<std::string>{
                "identifier 400h (1024) is sent by unit1 (object Tr) and by unit2 (object Tr)"});
  // 12 is the PI that unit 2 sends.
  plan = plan_of(two(), {{"A.IPC", send_program(12)}, {"B.IPC", send_program(1025)}});
  EXPECT_EQ(texts(plan, FindingKind::MovilinkIdentifier),
            std::vector<std::string>{
                "unit1: object 00Ch (12) in Tr cannot be sent: it is the process input data (PI) of "
                "address 1 that unit2 sends"});
  // 11 it only receives: no rule against sending it, as long as nobody sends PO.
  plan = plan_of(two(), {{"A.IPC", send_program(11)}, {"B.IPC", send_program(1025)}});
  EXPECT_TRUE(texts(plan, FindingKind::MovilinkIdentifier).empty());
}

// Sends `own` in an object of that number, receives the two others; the main loop is empty.
std::string exchanges(int own, int first, int second, int value) {
  const auto receives = [](const std::string& name, int id, const std::string& variable) {
    return name + ".ObjectNo = " + std::to_string(id) + "; " + name + ".Format = 4; " + name +
           ".DPointer = numof(" + variable + "); _SBusCommDef(SCD_REC, " + name + ");\n ";
  };
  return "#include <const.h>\nSCTRCYCL T; SCREC A, B; long lOwn, lFirst, lSecond;\nmain()\n{\n lOwn = " +
         std::to_string(value) + "; T.ObjectNo = " + std::to_string(own) +
         "; T.CycleTime = 10; T.Offset = 0; T.Format = 4; T.DPointer = numof(lOwn); "
         "_SBusCommDef(SCD_TRCYCL, T);\n " +
         receives("A", first, "lFirst") + receives("B", second, "lSecond") +
         "_SBusCommOn();\n while (1) {}\n}\n";
}

TEST(Objects, ThreeStationsSendAndHearTheTwoOthers) {
  PROVES("VAR-02");
  const std::string plant = bus_text() + station_text("unit1", "P813 = 0\n", "md60a", "A.IPC") +
                            station_text("unit2", "P813 = 1\n", "md60a", "B.IPC") +
                            station_text("unit3", "P813 = 2\n", "md60a", "C.IPC");
  PlantRig rig(plant, {{"A.IPC", exchanges(1024, 1025, 1026, 11)},
                       {"B.IPC", exchanges(1025, 1024, 1026, 22)},
                       {"C.IPC", exchanges(1026, 1024, 1025, 33)}});
  rig.run_until(kSecond);
  const int expected[3][2] = {{22, 33}, {11, 33}, {11, 22}};
  for (size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(rig.variable(n, "lFirst"), expected[n][0]) << n;
    EXPECT_EQ(rig.variable(n, "lSecond"), expected[n][1]) << n;
  }
  // All three in one millisecond, round by round.
  const auto first = rig.with(1024), second = rig.with(1025), third = rig.with(1026);
  ASSERT_GE(first.size(), 90U);
  ASSERT_EQ(first.size(), second.size());
  ASSERT_EQ(first.size(), third.size());
  EXPECT_EQ(rig.frames.size(), 3 * first.size());
  for (size_t n = 0; n < first.size(); ++n) {
    EXPECT_EQ(first[n].start / kMillisecond, second[n].start / kMillisecond);
    EXPECT_EQ(first[n].start / kMillisecond, third[n].start / kMillisecond);
  }
  EXPECT_EQ(rig.journal(), "");
}

std::string example_source(const char* name) {
  std::ifstream in(std::filesystem::path(IPOS_EXAMPLES) / name);
  EXPECT_TRUE(in) << name;
  return {std::istreambuf_iterator<char>(in), {}};
}

// The sample programs (1053 1610 p. 57 to 59): 1024 every 100 ms and 1025 every 120 ms, from the millisecond
// in which _SBusCommOn was carried out.
TEST(Objects, SendTimesOfTheSamplesCountFromTheStartCommand) {
  PROVES("EX-27");
  PlantRig rig(two(),
               {{"A.IPC", example_source("scom/SCOM1.IPC")}, {"B.IPC", example_source("scom/SCOM2.IPC")}});
  std::array<Time, 2> start = {kNever, kNever};
  for (Time now = 0; now < 50 * kMillisecond; now += kMillisecond) {
    rig.run_until(now);
    EXPECT_TRUE(rig.frames.empty() || start[0] != kNever || start[1] != kNever)
        << "nothing before the command";
    for (size_t n = 0; n < 2; ++n)
      if (start[n] == kNever && rig.station(n).sbus(1)->objects().started()) start[n] = now;
  }
  rig.run_until(kSecond);
  const std::pair<uint32_t, Time> telegrams[] = {{1024, 100}, {1025, 120}};
  for (size_t station = 0; station < 2; ++station) {
    ASSERT_NE(start[station], kNever);
    EXPECT_GT(start[station], 0);
    const auto& [id, period] = telegrams[station];
    const auto frames = rig.with(id);
    ASSERT_EQ(frames.size(), static_cast<size_t>((kSecond - start[station]) / (period * kMillisecond)) + 1);
    for (size_t n = 0; n < frames.size(); ++n) {
      const Time due = start[station] + static_cast<Time>(n) * period * kMillisecond;
      EXPECT_LE(std::abs(frames[n].start - due), kMillisecond) << id << " " << n;
    }
  }
}

// SCD_TRACYCL without _SBusCommOn. The calls stand in a loop; a loop with another single command in their
// place takes the same time.
TEST(Objects, AnAcyclicTelegramIsSentByTheCallAndNobodyWaits) {
  PROVES("SCOM-16");
  const auto program = [](const std::string& body) {
    return "#include <const.h>\nSCTRACYCL T; long lData, lCalls, n;\nmain()\n{\n T.ObjectNo "
           "= 1024; "
           "T.Format = 4; T.DPointer = numof(lData);\n" +
           body + "}\n";
  };
  const std::string plant = bus_text() + station_text("unit1", "P813 = 0\n", "md60a", "A.IPC") +
                            station_text("unit2", "P813 = 1\n");
  // One frame a call, with the values of the call. The status is 1 until the frame is through, then 2.
  PlantRig calls(
      plant, {{"A.IPC", program(" for (n = 0; n < 5; n++)\n {\n  lData = 100 + n; T.Result = 0;\n  "
                                "_SBusCommDef(SCD_TRACYCL, T); _Wait(20); lCalls++;\n }\n while (1) {}\n")}});
  std::vector<int32_t> status;
  for (Time now = 0; now < 300 * kMillisecond; now += 20 * kMicrosecond) {
    calls.run_until(now);
    const int32_t present = calls.variable(0, "T.Result");
    if (status.empty() || status.back() != present) {
      status.push_back(present);
      if (present == 2) {
        EXPECT_LE(calls.frames.back().end, now);
      }
    }
  }
  EXPECT_EQ(status, (std::vector<int32_t>{0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(calls.variable(0, "lCalls"), 5);
  ASSERT_EQ(calls.frames.size(), 5U);
  for (size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(calls.frames[k].frame.id, 1024U);
    EXPECT_EQ(calls.frames[k].frame.data[3], 100 + k);
  }
  const auto rounds = [&](const std::string& command) {
    PlantRig rig(plant, {{"A.IPC", program(" while (1) { lCalls++; " + command + " }\n")}});
    rig.run_until(500 * kMillisecond);
    return rig.variable(0, "lCalls");
  };
  EXPECT_EQ(rounds("_SBusCommDef(SCD_TRACYCL, T);"), rounds("lData = 1;"));
  EXPECT_GT(rounds("lData = 1;"), 10);
}

// Rule 2 of p. 51; numbers that the compiler does not know.
TEST(Objects, OneUnitSendsOrReceivesAnIdentifier) {
  const auto both = [](const std::string& kind, const std::string& structure, const std::string& result) {
    return "#include <const.h>\n" + structure +
           " T; SCREC R; long k, lData, lGot;\nmain()\n{\n k = 1000; lData = 7; T.ObjectNo = k + 24; "
           "T.Format = 4; "
           "T.DPointer = numof(lData);\n" +
           result + " _SBusCommDef(" + kind +
           ", T);\n R.ObjectNo = k + 24; R.Format = 4; R.DPointer = numof(lGot);\n _SBusCommDef(SCD_REC, "
           "R);\n"
           " _SBusCommOn();\n while (1) {}\n}\n";
  };
  const std::map<std::string, std::string> cyclic = {
      {"A.IPC", both("SCD_TRCYCL", "SCTRCYCL", " T.CycleTime = 10; T.Offset = 0;")},
      {"B.IPC", receive_program(1024)}};
  PlantRig rig(two(), cyclic);
  rig.run_until(50 * kMillisecond);
  EXPECT_EQ(rig.says("unit1: object 400h (1024) would be sent and received by this unit"), 1U)
      << rig.journal();
  EXPECT_EQ(rig.variable(1, "lData"), 7);
  EXPECT_EQ(texts(plan_of(two(), cyclic), FindingKind::ObjectRefused).size(), 1U);
  const std::map<std::string, std::string> acyclic = {{"A.IPC", both("SCD_TRACYCL", "SCTRACYCL", "")},
                                                      {"B.IPC", receive_program(1024)}};
  PlantRig once(two(), acyclic);
  once.run_until(50 * kMillisecond);
  EXPECT_EQ(once.says("unit1: object 400h (1024) stands in two structures of this unit"), 1U)
      << once.journal();
  EXPECT_EQ(texts(plan_of(two(), acyclic), FindingKind::DoubleIdentifier),
            std::vector<std::string>{"identifier 400h (1024) is sent (T) and received (R) by unit1"});
}

// A unit that calls address 1 with MOVLNK, and has an object on one of the telegrams of these calls.
TEST(Objects, ObjectsOnTheUnitsOwnMovlnk) {
  for (const auto& [id, text] : {std::pair{12, "00Ch (12)| process input data (PI) of address 1"},
                                 {524, "20Ch (524)| parameter response of address 1"},
                                 {11, "00Bh (11)| process output data (PO) of address 1"},
                                 {523, "20Bh (523)| parameter request of address 1"}}) {
    const std::string program =
        "#include <const.h>\nMOVLNK Ml; MLDATA Mld; SCREC R; long k, lGot;\nmain()\n{\n k = " +
        std::to_string(id) +
        "; R.ObjectNo = k; R.Format = 8; R.DPointer = 300;\n _SBusCommDef(SCD_REC, R); _SBusCommOn();\n "
        "Ml.BusType = 5; Ml.Address = 1; Ml.Format = 4; Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = "
        "numof(Mld);\n while (1) { _MoviLink(Ml); _Wait(10); }\n}\n";
    const std::map<std::string, std::string> sources = {{"A.IPC", program}};
    const std::string plant = bus_text() + station_text("unit1", "P813 = 0\n", "md60a", "A.IPC") +
                              station_text("unit2", "P813 = 1\n");
    PlantRig rig(plant, sources);
    rig.run_until(100 * kMillisecond);
    EXPECT_EQ(rig.variable(0, "H300"), 0);
    EXPECT_EQ(rig.variable(0, "Ml.Result"), 0);
    std::string expected = text;
    expected.replace(expected.find('|'), 1, " has the identifier of a telegram of this unit's own MOVLNK,");
    EXPECT_EQ(rig.says("unit1: object " + expected + ": the telegram does not reach the receive object"), 1U)
        << rig.journal();
    EXPECT_EQ(texts(plan_of(plant, sources), FindingKind::MovilinkIdentifier).size(), 1U);
  }
}

TEST(Objects, NumbersFrom0To2047) {
  PROVES("VAR-06");
  for (const int id : {2048, -1}) {
    PlantRig rig(two(), {{"A.IPC", send_program(id)}, {"B.IPC", receive_program(1024)}});
    rig.run_until(50 * kMillisecond);
    EXPECT_TRUE(rig.frames.empty());
    EXPECT_EQ(rig.says("unit1: object number " + std::to_string(id) + " is not 0..2047"), 1U);
    EXPECT_EQ(texts(plan_of(two(), {{"A.IPC", send_program(id)}, {"B.IPC", receive_program(1024)}}),
                    FindingKind::ObjectRefused)
                  .size(),
              1U);
  }
  for (const int id : {2047, 0}) {
    PlantRig rig(two(), {{"A.IPC", send_program(id)}, {"B.IPC", receive_program(id)}});
    rig.run_until(50 * kMillisecond);
    EXPECT_EQ(rig.variable(1, "lData"), 287454020) << id;
    // With P817 = 0 units take telegram 0 as sync: a warning, and a hint in the plan.
    EXPECT_EQ(rig.says("object number 000h (0) is also the sync telegram"), id == 0 ? 2U : 0U);
    EXPECT_EQ(texts(plan_of(two(), {{"A.IPC", send_program(id)}, {"B.IPC", receive_program(id)}}),
                    FindingKind::SyncObject)
                  .empty(),
              id != 0);
  }
}

TEST(Objects, ObjectsOnIdentifiersOfMovilink) {
  PROVES("DIAG-09", "M07-SCOM-31");
  // Unit 1 is master to address 1, unit 3 sends an object 11: the slave takes it for PO.
  const std::string call =
      "#include <const.h>\nMOVLNK Ml; MLDATA Mld;\nmain() { Ml.BusType = 5; Ml.Address = 1; Ml.Format = 5; "
      "Ml.DPointer = numof(Mld); Mld.PO1 = 6; while (1) { _MoviLink(Ml); _Wait(50); } }\n";
  for (const char* unit : {"md60a", "mc07"}) {
    const std::string plant = bus_text() + station_text("unit1", "P813 = 0\nP814 = 5\n", unit, "A.IPC") +
                              station_text("unit2", "P813 = 1\nP814 = 6\n", unit, "B.IPC") +
                              station_text("unit3", "P813 = 2\nP814 = 7\n", unit, "C.IPC");
    const std::map<std::string, std::string> sources = {
        {"A.IPC", call}, {"B.IPC", receive_program(523)}, {"C.IPC", send_program(11, "6")}};
    PlantRig rig(plant, sources);
    rig.run_until(30 * kMillisecond);
    EXPECT_EQ(rig.station(1).drive().state().po()[1], 0x1122) << "the object's bytes are taken for PO";
    EXPECT_EQ(rig.says("identifier 00Bh (11) is sent by unit1 and by unit3"), 1U) << rig.journal();
    EXPECT_EQ(
        rig.says("unit2: object number 20Bh (523) is an identifier of the unit's own MOVILINK telegrams"),
        1U);
    EXPECT_EQ(rig.variable(1, "lData"), 0);
    const BusPlan plan = plan_of(plant, sources);
    const std::vector<std::string> found = texts(plan, FindingKind::MovilinkIdentifier);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(
        found[0],
        "unit2: object 20Bh (523) in Rec cannot be received: it is the parameter request of address 1 that "
        "unit2 receives");
    EXPECT_EQ(
        found[1],
        "unit3: object 00Bh (11) in Tr cannot be sent: it is the process output data (PO) of address 1 that "
        "unit1 sends");
    // Different formats of one object.
    EXPECT_EQ(texts(plan_of(two(unit),
                            {{"A.IPC", send_program(1024, "8")}, {"B.IPC", receive_program(1024, "0x108")}}),
                    FindingKind::Formats),
              std::vector<std::string>{
                  "object 400h (1024) is sent by unit1 with 8 bytes MOTOROLA and received by unit2 with 8 "
                  "bytes INTEL"});
  }
}

TEST(Objects, MixedFormatsSwapTheContent) {
  PROVES("DIAG-10", "M07-SCOM-30");
  for (const char* unit : {"md60a", "mc07"}) {
    const std::map<std::string, std::string> sources = {{"A.IPC", send_program(1024, "8")},
                                                        {"B.IPC", receive_program(1024, "0x108")}};
    PlantRig rig(two(unit), sources);
    rig.run_until(50 * kMillisecond);
    EXPECT_EQ(rig.variable(1, "lMore"), 0x44332211);
    EXPECT_EQ(texts(plan_of(two(unit), sources), FindingKind::Formats).size(), 1U);
    EXPECT_TRUE(texts(plan_of(two(unit), {{"A.IPC", send_program(1024, "0x108")},
                                          {"B.IPC", receive_program(1024, "0x108")}}),
                      FindingKind::Formats)
                    .empty());
  }
  // Format and Len are one member: the same code.
  std::string with_len = send_program(1024);
  with_len.replace(with_len.find("Tr.Format"), 9, "Tr.Len");
  EXPECT_EQ(compiler::compile("a", "a", with_len).image->code,
            compiler::compile("a", "a", send_program(1024)).image->code);
  std::string receive_len = receive_program(1024);
  receive_len.replace(receive_len.find("Rec.Format"), 10, "Rec.Len");
  EXPECT_EQ(compiler::compile("a", "a", receive_len).image->code,
            compiler::compile("a", "a", receive_program(1024)).image->code);
}

TEST(Objects, WithoutTheStartCommandOnlyAcyclicOnesGoOut) {
  PROVES("DIAG-11", "M07-SCOM-32");
  std::string program = send_program(1024, "4", false);
  program.insert(
      program.find(" while"),
      " As.ObjectNo = 1026; As.Format = 4; As.DPointer = numof(lData); _SBusCommDef(SCD_TRACYCL, As);\n");
  program.replace(program.find("SCTRCYCL Tr;"), 12, "SCTRCYCL Tr; SCTRACYCL As;");
  for (const char* unit : {"md60a", "mc07"}) {
    const std::map<std::string, std::string> sources = {{"A.IPC", program},
                                                        {"B.IPC", receive_program(1026, "4", false)}};
    PlantRig rig(two(unit), sources);
    rig.run_until(kSecond);
    EXPECT_EQ(rig.ids(), std::vector<uint32_t>{1026});
    EXPECT_EQ(rig.variable(1, "lData"), 0);
    const std::vector<std::string> found = texts(plan_of(two(unit), sources), FindingKind::NotStarted);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NE(found[0].find("unit1 defines cyclic or receive objects, but _SBusCommOn was not reached"),
              std::string::npos);
  }
}

TEST(Objects, CommandsBeyondTheTrialAreNamed) {
  std::string late = send_program(1024);
  late.replace(late.find(" lData ="), 8, " _Wait(1000);\n lData =");
  const BusPlan plan = plan_of(two(), {{"A.IPC", late}, {"B.IPC", receive_program(1024)}});
  EXPECT_EQ(texts(plan, FindingKind::NotReached),
            std::vector<std::string>{"unit1: SCOM at A.IPC:7:2 was not reached"});
  EXPECT_FALSE(plan.has_errors());
}

TEST(Objects, DictionaryOfAPlant) {
  PlantRig rig(two(), {{"A.IPC", send_program(1024, "8")}, {"B.IPC", receive_program(1024, "8")}});
  rig.run_until(50 * kMillisecond);
  const TelegramNames names = telegram_names(*rig.plant);
  EXPECT_EQ(describe(names, rig.frames.back().frame).text,
            "400 lData = 287454020 (11223344h), lMore = 0 (00000000h) <- unit1");
  EXPECT_EQ(describe(names, {523, 8, {0x31, 0, 0x2C, 0x9D}, false, false}).text,
            "20B read 11421 Rec.Format -> unit2");
}

}  // namespace
}  // namespace ipos::tests
