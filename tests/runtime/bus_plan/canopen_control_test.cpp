// A master of CANopen as a control of a plant file, and what else runs on its line.
#include <gtest/gtest.h>

#include "runtime/bus_plan/plan.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

const std::string kInputs = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";

std::string node(const std::string& name, int address) {
  return station_text(name,
                      "P880 = 1\nP886 = " + std::to_string(address) + "\nP100 = 10\nP101 = 3\nP301 = 0\n",
                      "mdxb") +
         kInputs;
}

std::string control(const std::string& keys) {
  return "[[control]]\nname = \"plc\"\nkind = \"canopen\"\nsbus = \"sbus\"\n" + keys;
}

TEST(CanopenControl, BringsItsNodesUpAndDrivesThem) {
  PlantRig rig(
      bus_text() + node("saw", 5) + node("feed", 6) +
      control("cycle = \"5ms\"\n"
              "[[control.target]]\naddress = 5\npo = [6, 5000]\nguard = \"50ms\"\n"
              "[control.target.parameters]\nP131 = \"1 s\"\n"
              "[[control.target]]\naddress = 6\npo = [6, 2500]\nheartbeat = \"100ms\"\n"
              "[[control.target.pdo]]\nnumber = 2\ntransmit = true\ntype = 4\nmap = [\"PI2\", \"PI1\"]\n"));
  ASSERT_TRUE(rig.errors.empty()) << rig.errors[0];
  rig.run_until(3 * kSecond);
  EXPECT_EQ(rig.station(0).drive().state().axis().speed, 1'000'000);
  EXPECT_EQ(rig.station(1).drive().state().axis().speed, 500'000);
  EXPECT_EQ(rig.station(0).drive().value("131"), 1'000);
  for (const char* text : {"plc: CANopen: node 5 boots up", "plc: CANopen: node 5 is configured and started",
                           "plc: CANopen: node 6 is configured and started"})
    EXPECT_EQ(rig.says(text), 1U) << text;
  // TPDO2 of node 6 at each fourth SYNC, speed in front; guarding of 5 and heartbeat of 6.
  const auto mapped = rig.with(0x286);
  ASSERT_GT(mapped.size(), 140U);
  EXPECT_EQ(mapped.back().frame.length, 4);
  EXPECT_EQ(mapped.back().frame.data[0] | mapped.back().frame.data[1] << 8, 2500);
  EXPECT_NEAR(static_cast<double>(mapped.back().end - mapped[mapped.size() - 2].end), 20.0 * kMillisecond,
              0.2 * kMillisecond);
  EXPECT_GT(rig.with(0x705).size(), 100U);
  EXPECT_NEAR(static_cast<double>(rig.with(0x706).size()), 30, 2);
  EXPECT_EQ(rig.station(0).fault(), 0);
}

TEST(CanopenControl, TellsWhatGoesWrong) {
  PlantRig refused(bus_text() + node("saw", 5) +
                   control("[[control.target]]\naddress = 5\nheartbeat = \"50ms\"\n"
                           "[[control.target.pdo]]\nnumber = 1\ntype = 251\nmap = [\"PO1\"]\n"));
  refused.run_until(200 * kMillisecond);
  EXPECT_EQ(
      refused.says("plc: CANopen: node 5 refuses to write 1400h:2 RPDO1 transmission type: value not allowed "
                   "(06090030h); it is not started"),
      1U)
      << refused.journal();
  PlantRig fault(bus_text() + node("saw", 5) + control("[[control.target]]\naddress = 5\npo = [6, 5000]\n"));
  fault.run_until(500 * kMillisecond);
  fault.station(0).drive().state().raise_fault(26);
  fault.run_until(kSecond);
  EXPECT_EQ(fault.says("plc: CANopen: node 5 sends EMCY FF00h fault"), 1U) << fault.journal();
}

TEST(CanopenControl, TwoNodesWithOneAddress) {
  PlantRig rig(bus_text() + node("saw", 5) + node("feed", 5));
  rig.run_until(10 * kMillisecond);
  EXPECT_EQ(rig.says("sbus: saw and feed both have CANopen address 5: they send the same identifiers"), 1U);
  PlantRig other(bus_text() + node("saw", 5) + node("feed", 6));
  other.run_until(10 * kMillisecond);
  EXPECT_EQ(other.says("both have CANopen address"), 0U);
}

TEST(CanopenControl, IsPlanned) {
  PlantRig rig(bus_text() + node("saw", 5) +
               control("cycle = \"4ms\"\nheartbeat = \"20ms\"\n[[control.target]]\naddress = 5\n"));
  const BusPlan plan = make_plan(rig.get(), {});
  std::map<uint32_t, Time> periods;
  for (const PlannedTelegram& telegram : plan.lines.at(0).telegrams)
    if (telegram.rhythm == Rhythm::Cyclic) periods[telegram.id] = telegram.period;
  EXPECT_EQ(periods, (std::map<uint32_t, Time>{{0x080, 4 * kMillisecond},
                                               {0x185, 4 * kMillisecond},
                                               {0x205, 4 * kMillisecond},
                                               {0x77F, 20 * kMillisecond}}));
  PlantRig nobody(bus_text() + node("saw", 5) + control("[[control.target]]\naddress = 9\n"));
  const BusPlan lost = make_plan(nobody.get(), {});
  ASSERT_FALSE(lost.findings.empty());
  EXPECT_EQ(lost.findings[0].kind, FindingKind::NobodyThere);
}

// A PDO of types 1 to 240 is sent at each n-th SYNC, one of an event as often as its inhibit time lets it, or by its timer
// (CiA 301); a word has two bytes.
TEST(CanopenControl, IsPlannedByTheTypesOfThePdos) {
  const auto pdo = [](int number, const std::string& keys) {
    return "[[control.target.pdo]]\nnumber = " + std::to_string(number) + "\ntransmit = true\n" + keys;
  };
  PlantRig rig(bus_text() + node("saw", 5) +
               control("cycle = \"4ms\"\n[[control.target]]\naddress = 5\nheartbeat = \"100ms\"\n" +
                       pdo(2, "type = 254\ninhibit = \"2500us\"\nevent = \"20ms\"\nmap = [\"PI1\"]\n") +
                       pdo(3, "type = 255\nevent = \"20ms\"\nmap = [\"PI1\", \"PI2\"]\n") +
                       pdo(4, "type = 10\nmap = [\"PI1\", \"PI2\", \"PI3\", \"PI4\"]\n")));
  ASSERT_TRUE(rig.errors.empty()) << rig.errors[0];
  const BusPlan plan = make_plan(rig.get(), {});
  std::map<uint32_t, std::pair<Time, int>> cyclic;
  for (const PlannedTelegram& telegram : plan.lines.at(0).telegrams)
    if (telegram.rhythm == Rhythm::Cyclic) cyclic[telegram.id] = {telegram.period, telegram.bytes};
  EXPECT_EQ(cyclic, (std::map<uint32_t, std::pair<Time, int>>{{0x080, {4 * kMillisecond, 0}},
                                                              {0x185, {4 * kMillisecond, 6}},
                                                              {0x205, {4 * kMillisecond, 6}},
                                                              {0x285, {2'500 * kMicrosecond, 2}},
                                                              {0x385, {20 * kMillisecond, 4}},
                                                              {0x485, {40 * kMillisecond, 8}},
                                                              {0x705, {100 * kMillisecond, 1}}}));
  std::map<uint32_t, std::string> names;
  for (const PlannedIdentifier& identifier : plan.lines.at(0).identifiers)
    for (const PlannedUse& use : identifier.uses)
      if (use.station == "saw") names[identifier.id] = (use.transmits ? "> " : "< ") + use.what;
  EXPECT_EQ(names, (std::map<uint32_t, std::string>{{0x000, "< NMT"},
                                                    {0x080, "< SYNC"},
                                                    {0x085, "> EMCY"},
                                                    {0x185, "> TPDO1"},
                                                    {0x205, "< RPDO1"},
                                                    {0x285, "> TPDO2"},
                                                    {0x385, "> TPDO3"},
                                                    {0x485, "> TPDO4"},
                                                    {0x585, "> SDO response"},
                                                    {0x605, "< SDO request"},
                                                    {0x705, "> guarding or heartbeat"}}));
}

TEST(CanopenControl, MistakesHaveTheirPlaces) {
  const std::pair<const char*, const char*> cases[] = {
      {"[[control.target]]\n", "9: a [[control.target]] needs address = ..."},
      {"[[control.target]]\naddress = 128\n", "10: "},
      {"[[control.target]]\naddress = 0\n", "10: address is 1 to 127"},
      {"[[control.target]]\naddress = 5\nguard = \"5ms\"\nheartbeat = \"5ms\"\n",
       "12: a node has guarding or heartbeat, never both"},
      {"[[control.target]]\naddress = 5\npo = [1,2,3,4,5,6,7,8,9,10,11]\n", "11: po is a list of up to ten"},
      {"[[control.target]]\naddress = 5\npo = [70000]\n", "11: a process data word has 16 bits"},
      {"[[control.target]]\naddress = 5\n[[control.target.pdo]]\nmap = [\"PI1\"]\n",
       "12: a PDO that a node receives carries PO1 to PO10"},
      {"[[control.target]]\naddress = 5\n[[control.target.pdo]]\nmap = "
       "[\"PO1\",\"PO2\",\"PO3\",\"PO4\",\"PO5\"]\n",
       "12: a PDO carries at most four words"},
      {"[[control.target]]\naddress = 5\n[[control.target.pdo]]\nnumber = 5\nmap = []\n", "12: "},
      {"[[control.target]]\naddress = 5\n[control.target.parameters]\nP999 = 1\n",
       "12: unit mdxb has no parameter"},
      {"[[control.target]]\naddress = 5\n[[control.target]]\naddress = 5\n",
       "11: node 5 is a target already"},
      {"sync = 1\n", "9: "}};
  for (const auto& [keys, expected] : cases) {
    const PlantRig rig(bus_text() + control(keys));
    ASSERT_FALSE(rig.errors.empty()) << keys;
    EXPECT_EQ(rig.errors[0].rfind(expected, 0), 0U) << keys << ": " << rig.errors[0];
  }
  const PlantRig kind(bus_text() + "[[control]]\nname = \"plc\"\nkind = \"dp\"\nsbus = \"sbus\"\n");
  ASSERT_FALSE(kind.errors.empty());
  EXPECT_NE(kind.errors[0].find("'dp' is no kind of control; known are sbus, canopen"), std::string::npos);
}

// SBus 1 speaks MOVILINK, SBus 2 CANopen; variable telegrams run on both.
TEST(CanopenControl, VariablesDoNotDependOnTheProfile) {
  PROVES("MDB-TOC-21");
  const auto talk = [](const std::string& bus, int send, int receive, int value) {
    return "SCTRCYCL Tr" + bus + "; SCREC Rec" + bus + "; long lData" + bus + ", lGot" + bus + ";\nDefine" +
           bus + "()\n{\n lData" + bus + " = " + std::to_string(value) + ";\n Tr" + bus +
           ".ObjectNo = SCD_SBUS" + bus + " + " + std::to_string(send) + "; Tr" + bus +
           ".CycleTime = 10; Tr" + bus + ".Offset = 0; Tr" + bus + ".Format = 4; Tr" + bus +
           ".DPointer = numof(lData" + bus + ");\n Rec" + bus + ".ObjectNo = SCD_SBUS" + bus + " + " +
           std::to_string(receive) + "; Rec" + bus + ".Format = 4; Rec" + bus + ".DPointer = numof(lGot" +
           bus + ");\n _SBusCommDef(SCD_TRCYCL, Tr" + bus + ");\n _SBusCommDef(SCD_REC, Rec" + bus +
           ");\n}\n";
  };
  PlantRig rig(
      bus_text() + "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n" +
          station_text("both", "P881 = 1\nP890 = 1\nP896 = 7\n", "mdxb", "A.IPC", "sbus2 = \"can\"\n") +
          station_text("first", "P881 = 2\n", "mdxb", "B.IPC") +
          "[[station]]\nname = \"second\"\nunit = \"mdxb\"\nsbus2 = \"can\"\nprogram = \"C.IPC\"\n"
          "[station.parameters]\nP890 = 1\nP896 = 8\n"
          "[[control]]\nname = \"plc\"\nkind = \"canopen\"\nsbus = \"can\"\n[[control.target]]\naddress = 7\n"
          "[[control.target]]\naddress = 8\n",
      {{"A.IPC", "#include <constb.h>\n" + talk("1", 1024, 1025, 11) + talk("2", 1024, 1025, 22) +
                     "main() { Define1(); Define2(); _SBusCommOn(); while (1) {} }\n"},
       {"B.IPC", "#include <constb.h>\n" + talk("1", 1025, 1024, 33) +
                     "main() { Define1(); _SBusCommOn(); while (1) {} }\n"},
       {"C.IPC", "#include <constb.h>\n" + talk("2", 1025, 1024, 44) +
                     "main() { Define2(); _SBusCommOn(); while (1) {} }\n"}});
  ASSERT_TRUE(rig.errors.empty()) << rig.errors[0];
  rig.run_until(300 * kMillisecond);
  EXPECT_EQ(rig.variable(0, "lGot1"), 33);
  EXPECT_EQ(rig.variable(0, "lGot2"), 44);
  EXPECT_EQ(rig.variable(1, "lGot1"), 11);
  EXPECT_EQ(rig.variable(2, "lGot2"), 22);
  EXPECT_EQ(rig.says("node 7 is configured and started"), 1U);
  EXPECT_EQ(rig.says("node 8 is configured and started"), 1U);
}

}  // namespace
}  // namespace ipos::tests
