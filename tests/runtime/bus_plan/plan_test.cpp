// The planner on the manual's examples and on plants with one mistake each.
#include "runtime/bus_plan/plan.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

BusPlan plan_of(const std::string& toml, const std::map<std::string, std::string>& sources = {}) {
  PlantRig rig(toml, sources);
  return make_plan(rig.get(), {});
}

std::vector<std::string> codes(const BusPlan& plan) {
  std::vector<std::string> list;
  for (const Finding& finding : plan.findings) list.emplace_back(finding_type(finding.kind).code);
  return list;
}

size_t count(const BusPlan& plan, FindingKind kind) {
  size_t n = 0;
  for (const Finding& finding : plan.findings) n += finding.kind == kind ? 1 : 0;
  return n;
}

const std::string& first_text(const BusPlan& plan, FindingKind kind) {
  static const std::string none;
  for (const Finding& finding : plan.findings)
    if (finding.kind == kind) return finding.text;
  return none;
}

// "receive 515", "transmit 516" ... of a station, MOVILINK only, without the sync telegram.
std::set<std::string> uses_of(const BusPlan& plan, const std::string& station) {
  std::set<std::string> list;
  for (const PlannedIdentifier& identifier : plan.lines[0].identifiers)
    for (const PlannedUse& use : identifier.uses)
      if (use.station == station && use.movilink && use.what != "sync telegram")
        list.insert((use.transmits ? "transmit " : "receive ") + std::to_string(identifier.id));
  return list;
}

std::set<uint32_t> closed(const BusPlan& plan, const std::string& station, bool transmit) {
  for (const ClosedIdentifiers& row : plan.lines[0].closed)
    if (row.station == station) {
      const auto& list = transmit ? row.transmit : row.receive;
      return {list.begin(), list.end()};
    }
  return {};
}

// Unit 1 calls the given addresses, one after the other.
std::string caller(const std::vector<int>& addresses) {
  std::string text =
      "#include <const.h>\nMOVLNK Ml; MLDATA Mld;\nmain() {\n Ml.BusType = 5; Ml.Format = 1; "
      "Ml.DPointer = numof(Mld);\n";
  for (const int address : addresses)
    text += " Ml.Address = " + std::to_string(address) + "; _MoviLink(Ml);\n";
  return text + "}\n";
}

// The plant of 1053 1610 p. 52: unit 1 at address 0, group 0, calls unit 2 at address 1, group 2.
std::string page_52(const std::string& unit) {
  return bus_text() + station_text("unit1", "P813 = 0\nP814 = 0\n", unit, "CALL.IPC") +
         station_text("unit2", "P813 = 1\nP814 = 2\n", unit);
}

TEST(Plan, IdentifierTableOfTheManual) {
  PROVES("EX-16", "EX-17");
  const BusPlan plan = plan_of(page_52("md60a"), {{"CALL.IPC", caller({1, 102})}});
  EXPECT_EQ(uses_of(plan, "unit1"),
            (std::set<std::string>{"receive 515", "transmit 516", "receive 3", "transmit 4", "receive 5",
                                   "receive 518", "receive 6", "transmit 523", "receive 524", "transmit 11",
                                   "receive 12", "transmit 13", "transmit 534", "transmit 22"}));
  EXPECT_EQ(uses_of(plan, "unit2"),
            (std::set<std::string>{"receive 523", "transmit 524", "receive 11", "transmit 12", "receive 13",
                                   "receive 534", "receive 22"}));
}

TEST(Plan, ForbiddenIdentifiersOfTheManual) {
  PROVES("EX-18", "EX-19", "VAR-05");
  const std::set<uint32_t> unit1 = {515, 516, 3, 4, 5, 518, 6, 523, 524, 11, 12, 13, 534, 22};
  BusPlan plan = plan_of(page_52("md60a"), {{"CALL.IPC", caller({1, 102})}});
  EXPECT_EQ(closed(plan, "unit1", true), unit1);
  EXPECT_EQ(closed(plan, "unit1", false), unit1);
  EXPECT_EQ(closed(plan, "unit2", true), (std::set<uint32_t>{523, 524, 11, 12, 13, 534, 22, 516, 4}));
  EXPECT_EQ(closed(plan, "unit2", false), (std::set<uint32_t>{523, 524, 11, 12, 13, 534, 22}));
  // A further partner at address 2: 20, not the 29 of the print.
  plan = plan_of(page_52("md60a") + station_text("unit3", "P813 = 2\nP814 = 9\n"),
                 {{"CALL.IPC", caller({1, 102, 2})}});
  std::set<uint32_t> more = unit1;
  more.insert({531, 532, 19, 20, 21});
  EXPECT_EQ(closed(plan, "unit1", true), more);
  EXPECT_EQ(closed(plan, "unit1", false), more);
  EXPECT_EQ(more.count(29), 0U);
}

TEST(Plan, ForbiddenIdentifiersOfMovitrac07) {
  PROVES("M07-SCOM-12", "M07-SCOM-13", "M07-SCOM-14", "M07-SCOM-15", "M07-SCOM-16");
  const BusPlan plan = plan_of(page_52("mc07"), {{"CALL.IPC", caller({1, 102})}});
  const std::set<uint32_t> unit1 = {3, 4, 11, 12, 6, 22, 515, 516, 523, 524, 518, 534};
  EXPECT_EQ(closed(plan, "unit1", true), unit1);
  EXPECT_EQ(closed(plan, "unit1", false), unit1);
  EXPECT_EQ(closed(plan, "unit2", true), (std::set<uint32_t>{4, 11, 12, 22, 516, 523, 524, 534}));
  EXPECT_EQ(closed(plan, "unit2", false), (std::set<uint32_t>{11, 12, 22, 523, 524, 534}));
  // Rule 1: sent by MOVILINK, so closed for sending anywhere. 3 and 515 may be received by unit 2.
  std::set<uint32_t> sent;
  for (const PlannedIdentifier& identifier : plan.lines[0].identifiers)
    for (const PlannedUse& use : identifier.uses)
      if (use.transmits && use.movilink) sent.insert(identifier.id);
  EXPECT_EQ(sent, (std::set<uint32_t>{4, 516, 11, 523, 22, 534, 12, 524}));
  for (const PlannedIdentifier& identifier : plan.lines[0].identifiers)
    for (const PlannedUse& use : identifier.uses) {
      if (identifier.id == 523) {
        EXPECT_EQ(use.what, "parameter request of address 1");
      }
      if (identifier.id == 22) {
        EXPECT_EQ(use.what, "group process output data (GPO) of group 2");
      }
    }
}

std::string four_inverters(const std::string& unit, const std::string& control = "") {
  const auto inverter = [&](int n, int address, bool end) {
    return station_text("inverter" + std::to_string(n),
                        "P813 = " + std::to_string(address) + "\nP814 = 50\nP816 = 2\n", unit, "",
                        std::string("terminator = ") + (end ? "true\n" : "false\n"));
  };
  return bus_text(500'000, "length = 80\n") + inverter(1, 33, true) + inverter(2, 17, false) + control +
         inverter(3, 11, false) + inverter(4, 7, true);
}

TEST(Plan, ProjectExampleOfTheManual) {
  PROVES("EX-32", "EX-33");
  const std::string control = "[[control]]\nname = \"control\"\nsbus = \"sbus\"\nterminator = false\n";
  const BusPlan plan = plan_of(four_inverters("md60a", control));
  EXPECT_TRUE(codes(plan).empty());
  const std::map<std::string, std::vector<uint32_t>> expected = {{"inverter1", {267, 268, 269, 779, 780}},
                                                                 {"inverter2", {139, 140, 141, 651, 652}},
                                                                 {"inverter3", {91, 92, 93, 603, 604}},
                                                                 {"inverter4", {59, 60, 61, 571, 572}}};
  std::set<uint32_t> all;
  for (const auto& [station, ids] : expected) {
    std::vector<uint32_t> found;
    for (const PlannedIdentifier& identifier : plan.lines[0].identifiers)
      for (const PlannedUse& use : identifier.uses)
        if (use.station == station && use.what.find("address") != std::string::npos)
          found.push_back(identifier.id);
    EXPECT_EQ(found, ids) << station;
    all.insert(found.begin(), found.end());
  }
  EXPECT_EQ(all.size(), 20U);
}

TEST(Plan, ProjectExampleOfMovitrac07) {
  PROVES("M07-SBUS-20", "M07-SBUS-21", "M07-SBUS-22");
  BusPlan plan = plan_of(four_inverters("mc07"));
  EXPECT_TRUE(codes(plan).empty());
  std::vector<uint32_t> ids;
  for (const PlannedIdentifier& identifier : plan.lines[0].identifiers) ids.push_back(identifier.id);
  EXPECT_EQ(ids, (std::vector<uint32_t>{59, 60, 91, 92, 139, 140, 267, 268, 406, 571, 572, 603, 604, 651, 652,
                                        779, 780, 918}));
  plan = plan_of(bus_text() + station_text("a", "P813 = 17\n") + station_text("b", "P813 = 33\n") +
                 station_text("c", "P813 = 17\n"));
  ASSERT_EQ(count(plan, FindingKind::DoubleAddress), 1U);
  EXPECT_EQ(first_text(plan, FindingKind::DoubleAddress), "a and c both have SBus address 17");
}

TEST(Plan, AddressesAndTheirLimits) {
  PROVES("SBUS-11", "M07-SBUS-07");
  for (const char* unit : {"md60a", "mc07"})
    for (const uint16_t index : std::initializer_list<uint16_t>{8600, 8601}) {
      ParameterStore fresh(*stdlib::find_unit(unit));
      EXPECT_EQ(fresh.value(index), 0);
      EXPECT_TRUE(fresh.execute(ParameterService::Write, index, 63));
      const auto large = fresh.execute(ParameterService::Write, index, 64);
      ASSERT_FALSE(large);
      EXPECT_EQ(large.error().packed(), 0x08000015U);
      EXPECT_EQ(fresh.execute(ParameterService::Write, index, -1).error().additional, 0x16);
      EXPECT_EQ(fresh.value(index), 63);
    }
  const auto addresses = [](int a, int b, int c, int d) {
    std::string text = bus_text();
    int n = 0;
    for (const int address : {a, b, c, d})
      text += station_text("u" + std::to_string(n++), "P813 = " + std::to_string(address) + "\n");
    return plan_of(text);
  };
  EXPECT_TRUE(codes(addresses(33, 17, 11, 7)).empty());
  EXPECT_EQ(count(addresses(33, 17, 11, 33), FindingKind::DoubleAddress), 1U);
}

TEST(Plan, AtMostSixtyFourStations) {
  PROVES("SBUS-12", "M07-SBUS-10");
  std::string text = bus_text();
  for (int n = 0; n < 64; ++n)
    text += station_text("u" + std::to_string(n), "P813 = " + std::to_string(n) + "\n");
  EXPECT_EQ(count(plan_of(text), FindingKind::TooManyStations), 0U);
  EXPECT_EQ(plan_of(text).lines[0].stations, 64U);
  text += "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n";
  EXPECT_EQ(count(plan_of(text), FindingKind::TooManyStations), 1U);
}

TEST(Plan, BaudRates) {
  PROVES("SBUS-13", "M07-SBUS-08");
  constexpr uint32_t rates[] = {125'000, 250'000, 500'000, 1'000'000};
  for (const char* unit : {"md60a", "mc07"}) {
    ParameterStore fresh(*stdlib::find_unit(unit));
    EXPECT_EQ(fresh.value(8603), 2);  // 500 kbaud
    EXPECT_EQ(fresh.execute(ParameterService::Write, 8603, 4).error().packed(), 0x08000015U);
    for (int code = 0; code < 4; ++code)
      for (int line = 0; line < 4; ++line)
        EXPECT_EQ(count(plan_of(bus_text(rates[line]) +
                                station_text("u", "P816 = " + std::to_string(code) + "\n", unit)),
                        FindingKind::BaudRate),
                  code == line ? 0U : 1U);
  }
  PlantRig wrong(bus_text(800'000) + station_text("u", ""));
  ASSERT_EQ(wrong.errors.size(), 1U);
  EXPECT_NE(wrong.errors[0].find("4: the SBus has 125000, 250000, 500000 or 1000000 baud"),
            std::string::npos);
}

TEST(Plan, CableLength) {
  PROVES("SBUS-14", "M07-SBUS-11");
  const std::pair<uint32_t, int> limits[] = {{125'000, 320}, {250'000, 160}, {500'000, 80}, {1'000'000, 40}};
  for (const auto& [baud, metres] : limits)
    for (const int more : {0, 1}) {
      const BusPlan plan = plan_of(bus_text(baud, "length = " + std::to_string(metres + more) + "\n") +
                                   station_text("u", "P816 = " +
                                                         std::to_string(baud == 125'000   ? 0
                                                                        : baud == 250'000 ? 1
                                                                        : baud == 500'000 ? 2
                                                                                          : 3) +
                                                         "\n"));
      EXPECT_EQ(codes(plan), more == 0 ? std::vector<std::string>{} : std::vector<std::string>{"B06"});
      if (more == 1) {
        EXPECT_NE(plan.findings[0].text.find(std::to_string(metres) + " m"), std::string::npos);
        EXPECT_NE(plan.findings[0].text.find(std::to_string(baud / 1000) + " kbaud"), std::string::npos);
      }
    }
}

TEST(Plan, TerminatingResistors) {
  PROVES("SBUS-15", "M07-SBUS-12", "DIAG-05");
  const auto line = [](const std::vector<std::string>& keys) {
    std::string text = bus_text();
    for (size_t n = 0; n < keys.size(); ++n)
      text +=
          station_text("u" + std::to_string(n), "P813 = " + std::to_string(n) + "\n", "md60a", "", keys[n]);
    return codes(plan_of(text));
  };
  const std::string on = "terminator = true\n", off = "terminator = false\n";
  const std::vector<std::string> good, bad{"B07"};
  EXPECT_EQ(line({on, off, off, on}), good);
  EXPECT_EQ(line({"", "", ""}), good);  // nothing stated
  EXPECT_EQ(line({on, off, off, off}), bad);
  EXPECT_EQ(line({off, off, on}), bad);
  EXPECT_EQ(line({on, on, off, on}), bad);
  EXPECT_EQ(line({on, on + "branch = true\n", on}), bad);
  EXPECT_EQ(line({on + "branch = true\n", off, on}), bad);
  EXPECT_EQ(line({on, off + "branch = true\n", on}), good);
  const BusPlan too_long = plan_of(bus_text(500'000, "length = 81\n") + station_text("u", ""));
  EXPECT_EQ(first_text(too_long, FindingKind::LineTooLong), "81 m of cable, at 500 kbaud at most 80 m");
}

TEST(Plan, CableData) {
  PROVES("M07-SBUS-13");
  const auto cable = [](const std::string& keys) {
    return codes(plan_of(bus_text(500'000, keys) + station_text("u", "", "mc07")));
  };
  EXPECT_TRUE(cable("impedance = 120\ncapacitance = 40\n").empty());
  EXPECT_TRUE(cable("capacitance = 1\n").empty());
  const std::vector<std::string> wrong{"B08"};
  for (const int picofarad : {41, 100})
    EXPECT_EQ(cable("capacitance = " + std::to_string(picofarad) + "\n"), wrong);
  for (const int ohm : {1, 60, 100, 119, 121, 150, 1000})
    EXPECT_EQ(cable("impedance = " + std::to_string(ohm) + "\ncapacitance = 40\n"), wrong) << ohm;
  EXPECT_EQ(cable("impedance = 60\ncapacitance = 41\n"), (std::vector<std::string>{"B08", "B08"}));
  const BusPlan plan = plan_of(bus_text(500'000, "capacitance = 41\n") + station_text("u", "", "mc07"));
  EXPECT_TRUE(plan.has_errors());
  EXPECT_EQ(first_text(plan, FindingKind::CableData), "cable of 41 pF/m, at most 40 pF/m");
}

TEST(Plan, Mch42aAtOneMegabaud) {
  PROVES("SBUS-16");
  const auto mixed = [](uint32_t baud, const std::string& code, const std::string& other) {
    return codes(
        plan_of(bus_text(baud) +
                station_text("a", "P813 = 1\nP816 = " + code + "\n", "compact", "", "device = \"MCH42A\"\n") +
                station_text("b", "P813 = 2\nP816 = " + code + "\n", "md60a", "", other)));
  };
  EXPECT_EQ(mixed(1'000'000, "3", ""), std::vector<std::string>{"B09"});
  EXPECT_TRUE(mixed(500'000, "2", "").empty());
  EXPECT_TRUE(mixed(1'000'000, "3", "device = \"MCH42A\"\n").empty());
}

TEST(Plan, SyncIdentifierMustBeFree) {
  PROVES("SYNC-02");
  const BusPlan plan =
      plan_of(bus_text() + station_text("a", "P813 = 1\nP817 = 11000\n") + station_text("b", "P813 = 2\n"));
  EXPECT_EQ(first_text(plan, FindingKind::SyncIdentifier),
            "sync identifier 00Bh (11) of a is process output data (PO) of address 1 of a");
  EXPECT_TRUE(codes(plan_of(bus_text() + station_text("a", "P813 = 1\nP817 = 128000\n"))).empty());
  // A unit with P817 = 128 takes 128 and not 0.
  PlantRig rig(
      bus_text() + station_text("a", "P813 = 1\nP817 = 128000\n") +
      "[[control]]\nname = \"c0\"\nsbus = \"sbus\"\nsync = 0\n" +
      "[[control]]\nname = \"c128\"\nsbus = \"sbus\"\nsync = 128\n[[control.target]]\naddress = 1\n");
  rig.run_until(49 * kMillisecond);
  EXPECT_EQ(rig.with(0).size(), 10U);
  // PO-sync at 3 ms of each cycle; PI only after telegram 128, which is also the one of c128.
  const auto answers = rig.with(12);
  EXPECT_EQ(answers.size(), 9U);
  const auto syncs = rig.with(128);
  ASSERT_EQ(syncs.size(), 10U);
  for (size_t n = 0; n < answers.size(); ++n) {
    EXPECT_GT(answers[n].start, syncs[n + 1].end);
    EXPECT_LT(answers[n].start, syncs[n + 1].end + kMillisecond);
  }
}

TEST(Plan, OneFindingForEachCauseOfASilentBus) {
  PROVES("M07-SBUS-24", "M07-SCOM-17");
  const std::string two = station_text("a", "P813 = 1\n", "mc07") + station_text("b", "P813 = 2\n", "mc07");
  const std::string object =
      "#include <const.h>\nSCTRCYCL Tr; long d, e;\nmain() { Tr.ObjectNo = 1024; Tr.CycleTime = 10; "
      "Tr.Offset = 0; "
      "Tr.Format = 4; Tr.DPointer = numof(d); _SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); while (1) {} }\n";
  const std::string hear =
      "#include <const.h>\nSCREC Rec; long d;\nmain() { Rec.ObjectNo = 1024; Rec.Format = 4; Rec.DPointer = "
      "numof(d); "
      "_SBusCommDef(SCD_REC, Rec); _SBusCommOn(); while (1) {} }\n";
  const auto one_code = [](const BusPlan& plan) {
    std::set<std::string> all;
    for (const std::string& code : codes(plan)) all.insert(code);
    return all.size() == 1 ? *all.begin() : std::to_string(all.size()) + " codes";
  };
  EXPECT_EQ(one_code(plan_of(bus_text() + two + fault_text("cut", "behind = \"a\"\n"))), "B21");
  EXPECT_EQ(one_code(plan_of(bus_text() + two + fault_text("swap", "station = \"b\"\n"))), "B22");
  EXPECT_EQ(one_code(plan_of(bus_text() + two + station_text("c", "P813 = 3\nP816 = 1\n", "mc07"))), "B05");
  EXPECT_EQ(one_code(plan_of(bus_text() + station_text("a", "P813 = 1\n", "mc07", "", "terminator = true\n") +
                             station_text("b", "P813 = 2\n", "mc07"))),
            "B07");
  const std::string senders = bus_text() + station_text("a", "P813 = 1\n", "mc07", "SEND.IPC") +
                              station_text("b", "P813 = 2\n", "mc07", "SEND.IPC");
  EXPECT_EQ(one_code(plan_of(senders, {{"SEND.IPC", object}})), "B02");
  std::string one_sender = bus_text() + station_text("a", "P813 = 1\n", "mc07", "SEND.IPC");
  for (int n = 2; n < 5; ++n)
    one_sender +=
        station_text("r" + std::to_string(n), "P813 = " + std::to_string(n) + "\n", "mc07", "HEAR.IPC");
  EXPECT_TRUE(codes(plan_of(one_sender, {{"SEND.IPC", object}, {"HEAR.IPC", hear}})).empty());
  EXPECT_EQ(one_code(plan_of(bus_text(500'000, "length = 81\n") + two)), "B06");
  const std::string call = bus_text() + station_text("a", "P813 = 1\nP814 = 4\n", "mc07", "CALL.IPC") +
                           station_text("b", "P813 = 3\nP814 = 5\n", "mc07");
  EXPECT_EQ(one_code(plan_of(call, {{"CALL.IPC", caller({2})}})), "B11");
  EXPECT_EQ(one_code(plan_of(call, {{"CALL.IPC", caller({107})}})), "B11");
  // Behind a port there may be more units than the plant knows.
  const std::string with_port = bus_text(500'000, "port = \"can0\"\n") + call.substr(bus_text().size());
  EXPECT_TRUE(codes(plan_of(with_port, {{"CALL.IPC", caller({2})}})).empty());
}

TEST(Plan, MasterSlave) {
  PROVES("MS-03");
  const auto pair = [](const std::string& slave, uint32_t baud = 500'000, const std::string& code = "2") {
    return bus_text(baud) + station_text("master", "P813 = 1\nP814 = 2\nP750 = 2\nP816 = " + code + "\n") +
           station_text("slave", "P813 = 2\nP100 = 8\nP816 = " + code + "\n" + slave);
  };
  EXPECT_TRUE(codes(plan_of(pair("P814 = 2\n"))).empty());
  EXPECT_TRUE(codes(plan_of(pair("P814 = 2\n", 1'000'000, "3"))).empty());
  const BusPlan other_group = plan_of(pair("P814 = 3\n"));
  EXPECT_EQ(count(other_group, FindingKind::MasterSlave), 2U);
  EXPECT_NE(other_group.findings[1].text.find(
                "slave follows a master (P100 = MASTER-SBus), but no master (P750) has its "
                "group 3"),
            std::string::npos);
  PlantRig good(pair("P814 = 2\n"));
  good.run_until(10 * kMillisecond);
  EXPECT_EQ(good.with(22).size(), 10U);
  PlantRig apart(pair("P814 = 3\n"));
  apart.run_until(10 * kMillisecond);
  EXPECT_EQ(apart.station(1).drive().state().po(), (Drive::Words{0, 0, 0}));
  for (const auto& [baud, code] : {std::pair{125'000U, "0"}, std::pair{250'000U, "1"}}) {
    EXPECT_GE(count(plan_of(pair("P814 = 2\n", baud, code)), FindingKind::MasterSlave), 1U);
    PlantRig slow(pair("P814 = 2\n", baud, code));
    slow.run_until(10 * kMillisecond);
    EXPECT_TRUE(slow.frames.empty());
    EXPECT_EQ(slow.says("master: P750 = 2: no slave setpoints are sent"), 1U);
  }
  // The group telegram every millisecond is in the plan.
  const BusPlan plan = plan_of(pair("P814 = 2\n"));
  ASSERT_EQ(plan.lines[0].telegrams.size(), 1U);
  EXPECT_EQ(plan.lines[0].telegrams[0].id, 22U);
  EXPECT_EQ(plan.lines[0].load_bits, 115'000U);
}

// A control sends one kind of process data to each target; identifiers by 1053 1610 p. 37.
TEST(Plan, IdentifiersOfAControl) {
  const auto uses = [](const std::string& target) {
    return uses_of(
        plan_of(bus_text() + station_text("u", "P813 = 1\nP814 = 2\nP817 = 1100000\n") +
                "[[control]]\nname = 'plc'\nsbus = 'sbus'\nsync = 1100\n[[control.target]]\n" + target),
        "plc");
  };
  EXPECT_EQ(uses("address = 1\nevery = '10ms'\n"), (std::set<std::string>{"transmit 11", "receive 12"}));
  EXPECT_EQ(uses("address = 1\n"), (std::set<std::string>{"transmit 13", "receive 12"}));
  EXPECT_EQ(uses("group = 2\nevery = '10ms'\n"), (std::set<std::string>{"transmit 22"}));
}

TEST(Plan, LoadAndResponseTimes) {
  // Two units with 8 bytes every 2 ms at 125 kbaud: 2 x 135 bits x 500 = 135 kbit/s.
  std::string text = bus_text(125'000);
  std::map<std::string, std::string> sources;
  for (int n = 0; n < 2; ++n) {
    const std::string file = "S" + std::to_string(n) + ".IPC";
    text +=
        station_text("u" + std::to_string(n), "P813 = " + std::to_string(n) + "\nP816 = 0\n", "md60a", file);
    sources[file] =
        "#include <const.h>\nSCTRCYCL Tr; long d, e;\nmain() { Tr.ObjectNo = " + std::to_string(1024 + n) +
        "; Tr.CycleTime = 2; Tr.Offset = 0; Tr.Format = 8; Tr.DPointer = numof(d); "
        "_SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); while (1) {} }\n";
  }
  const BusPlan plan = plan_of(text, sources);
  EXPECT_EQ(plan.lines[0].load_bits, 135'000U);
  EXPECT_EQ(first_text(plan, FindingKind::Overload), "worst-case load 108.0 %, at most 70 % may be planned");
  // 1024: blocked by one frame, then itself, 2 x 1.08 ms and a bit. 1025 waits for ever.
  EXPECT_EQ(first_text(plan, FindingKind::TooLate),
            "object Tr of u0, identifier 400h (1024), may take 2168 us, its period is 2000 us");
  EXPECT_EQ(plan.lines[0].telegrams[0].response.worst, 2 * 135 * 8000 + 8000);
  EXPECT_FALSE(plan.lines[0].telegrams[1].response.bounded);
  EXPECT_TRUE(plan.has_errors());
  EXPECT_EQ(count(plan, FindingKind::TooLate), 2U);
}

TEST(Plan, AnswersCarryTheJitterOfTheirRequests) {
  const BusPlan plan =
      plan_of(bus_text() + station_text("u", "P813 = 1\nP100 = 10\nP101 = 3\n") +
              "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n[[control.target]]\naddress = 1\n"
              "every = \"10ms\"\n");
  EXPECT_TRUE(codes(plan).empty());
  ASSERT_EQ(plan.lines[0].telegrams.size(), 2U);
  const PlannedTelegram& po = plan.lines[0].telegrams[0];
  const PlannedTelegram& pi = plan.lines[0].telegrams[1];
  EXPECT_EQ(po.response.worst, 2 * 115 * 2000 + 2000);  // blocked by the PI, itself, a bit
  EXPECT_EQ(pi.response.worst, po.response.worst + kMillisecond + 2 * 115 * 2000 + 2000);
  EXPECT_EQ(pi.rhythm, Rhythm::Answer);
}

}  // namespace
}  // namespace ipos::tests
