// Lines of RS-485, RS-232 and PROFIBUS in a plan: who is on them, their telegrams and times, and what is against the
// rules.
#include <gtest/gtest.h>

#include "runtime/bus_plan/plan.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

struct PlannedRig {
  explicit PlannedRig(const std::string& toml, const std::map<std::string, std::string>& sources = {},
                      Time trial = 100 * kMillisecond)
      : rig(toml, sources), plan(make_plan(rig.get(), {.trial = trial})) {}
  std::vector<std::string> texts(FindingKind kind) const {
    std::vector<std::string> all;
    for (const Finding& finding : plan.findings)
      if (finding.kind == kind) all.push_back(finding.text);
    return all;
  }
  PlantRig rig;
  BusPlan plan;
};

using PlanTexts = std::vector<std::string>;

std::string serial_bus(const std::string& name, const std::string& keys = "",
                       const std::string& kind = "rs485") {
  return "[[bus]]\nname = '" + name + "'\nkind = '" + kind + "'\n" + keys;
}
std::string serial_unit_at(const std::string& name, int address, const std::string& keys = "rs485 = 'r'\n",
                           const std::string& more = "") {
  return "[[station]]\nname = '" + name + "'\nunit = 'mdxb'\n" + keys +
         "[station.parameters]\nP810 = " + std::to_string(address) + "\n" + more;
}

// Calls the addresses over X13 (bus type 2) again and again.
std::string serial_caller(const std::vector<int>& addresses, const std::string& first = "",
                          const std::string& last = "") {
  std::string text =
      std::string(
          "#include <constb.h>\nMOVLNK m; MLDATA d;\nmain() {\n m.BusType = 2; m.Format = ML_FT_PAR3; "
          "m.Service = ML_S_RD; m.Index = 8318; m.DPointer = numof(d);\n ") +
      first + "while (1) {\n";
  for (const int address : addresses)
    text += "  m.Address = " + std::to_string(address) + "; _MoviLink(m);\n";
  return text + last + " }\n}\n";
}

// Too long, resistors beside those of the units, planted faults of the cable.
TEST(SerialLinePlan, WhatDisturbs) {
  const auto codes_of = [](const std::string& keys, const std::string& faults = "") {
    std::string codes;
    const PlannedRig of(serial_bus("r", keys) + serial_unit_at("a", 3) + faults);
    for (const Finding& finding : of.plan.findings) codes += std::string(finding_type(finding.kind).code) + " " + finding.text + "; ";
    return codes;
  };
  const std::string fault = "[[fault]]\nbus = 'r'\nkind = ";
  EXPECT_EQ(codes_of("length = 200\n"), "");
  EXPECT_EQ(codes_of("length = 201\n"), "B06 201 m of cable, a RS-485 line may have 200 m; ");
  EXPECT_EQ(codes_of("terminated = true\n"), "B07 the units have terminating resistors; connect no others; ");
  EXPECT_EQ(codes_of("", fault + "'noise'\n"), "");
  EXPECT_EQ(codes_of("", fault + "'swap'\nstation = 'a'\n").substr(0, 35), "B22 a has A and B interchanged: it ");
  EXPECT_EQ(codes_of("", fault + "'baud'\nstation = 'a'\n").substr(0, 27), "B21 a has another baud rate");
  EXPECT_EQ(codes_of("", fault + "'terminator'\nrate = 5\n"),
            "B21 the line disturbs a frame by reflections: a terminating resistor is missing; ");
}

TEST(SerialLinePlan, StationsAndCable) {
  const PlannedRig of(serial_bus("r", "length = 12.001\n") + serial_bus("s", "length = 5\n", "rs232") +
                      serial_bus("x") +
                      serial_unit_at("a", 3, "rs485 = 'r'\nrs485_xt = 'x'\n", "P811 = 150\n") +
                      serial_unit_at("b", 4) + serial_unit_at("c", 5, "rs485 = 's'\n"));
  ASSERT_EQ(of.plan.serial_lines.size(), 3U);
  const SerialLinePlan& line = of.plan.serial_lines[0];
  EXPECT_EQ(std::tuple(line.name, line.kind, line.baud, line.length, line.length_limit),
            std::tuple("r", "RS-485", 9'600U, 13U, 200U));
  ASSERT_EQ(line.stations.size(), 2U);
  const auto is = [](const PlannedSerialStation& station, const char* name, const char* socket, int address,
                     int group) {
    EXPECT_EQ(std::tuple(station.name, station.socket, station.address, station.group),
              std::tuple(name, socket, address, group));
  };
  is(line.stations[0], "a", "X13", 3, 150);
  is(line.stations[1], "b", "X13", 4, 100);
  const SerialLinePlan& other = of.plan.serial_lines[1];
  EXPECT_EQ(std::tuple(other.kind, other.length, other.length_limit), std::tuple("RS-232", 5U, 5U));
  const SerialLinePlan& xt = of.plan.serial_lines[2];
  EXPECT_EQ(std::tuple(xt.length, xt.length_limit), std::tuple(0U, 3U));
  is(xt.stations.at(0), "a", "XT", 3, 150);
  EXPECT_EQ(of.texts(FindingKind::BaudRate),
            PlanTexts{"a has 57600 baud at XT, the line has 9600 baud: it neither hears nor answers"});
}

TEST(SerialLinePlan, TelegramsOfTheTrial) {
  const std::string plant =
      serial_bus("r") + serial_unit_at("m", 0, "rs485 = 'r'\nprogram = 'M.IPC'\n") + serial_unit_at("a", 3);
  const PlannedRig of(plant, {{"M.IPC", serial_caller({3})}});
  const auto& telegrams = of.plan.serial_lines.at(0).telegrams;
  ASSERT_EQ(telegrams.size(), 2U);
  const uint8_t bytes = telegrams[0].bytes;
  for (const PlannedSerialTelegram& telegram : telegrams) {
    EXPECT_EQ(telegram.address, 3);
    EXPECT_GT(telegram.count, 1U);
    EXPECT_EQ(telegram.bytes, bytes) << "request and answer have one format";
    // 11 bits a character at 9600 baud.
    EXPECT_NEAR(static_cast<double>(telegram.wire), bytes * 11 / 9600.0 * 1e9, bytes * 1e3);
    EXPECT_GT(telegram.closest, 2 * telegram.wire) << "there and back";
    EXPECT_LT(telegram.closest, 100 * kMillisecond);
    EXPECT_EQ(telegram.format, telegrams[0].format);
    EXPECT_FALSE(telegram.format.empty());
  }
  EXPECT_EQ(std::pair(telegrams[0].sender, telegrams[0].response), std::pair(std::string("m"), false));
  EXPECT_EQ(std::pair(telegrams[1].sender, telegrams[1].response), std::pair(std::string("a"), true));
  EXPECT_TRUE(of.plan.findings.empty()) << of.plan.findings[0].text;
}

TEST(SerialLinePlan, NobodyAndSeveralMasters) {
  const std::string master = "rs485 = 'r'\nprogram = 'M.IPC'\n";
  const auto nobody = [&](const std::string& keys, const std::vector<int>& addresses) {
    return PlannedRig(serial_bus("r", keys) + serial_unit_at("m", 0, master) + serial_unit_at("a", 3),
                      {{"M.IPC", serial_caller(addresses)}})
        .texts(FindingKind::NobodyThere);
  };
  EXPECT_EQ(nobody("", {7, 7}), PlanTexts{"m calls address 7, which no station has"});
  EXPECT_EQ(nobody("", {3}), PlanTexts{});
  EXPECT_EQ(nobody("", {254, 255, 101}), PlanTexts{}) << "to all, and to a group";
  EXPECT_EQ(nobody("port = 'pty:/tmp/r'\n", {7}), PlanTexts{}) << "it may be behind the port";
  const PlannedRig two(
      serial_bus("r") + serial_unit_at("m", 0, master) +
          serial_unit_at("n", 1, "rs485 = 'r'\nprogram = 'N.IPC'\n") + serial_unit_at("a", 3),
      {{"M.IPC", serial_caller({3}, "", "_Wait(1000);")}, {"N.IPC", serial_caller({3}, "_Wait(150); ")}},
      300 * kMillisecond);
  EXPECT_EQ(two.texts(FindingKind::SeveralMasters), PlanTexts{"m, n are masters on this line"});
}

TEST(SerialLinePlan, FindingsOfTheSettings) {
  const PlannedRig same(serial_bus("r") + serial_unit_at("a", 3) + serial_unit_at("b", 3));
  EXPECT_EQ(same.texts(FindingKind::SerialSettings),
            PlanTexts{"r: a and b both have address P810 = 3; their answers collide"});
  EXPECT_TRUE(same.plan.has_errors());
  const PlannedRig keypad(serial_bus("r") +
                          serial_unit_at("a", 3, "rs485 = 'r'\nkeypad = true\n", "P812 = 100\n"));
  EXPECT_EQ(
      keypad.texts(FindingKind::SerialHint),
      PlanTexts{
          "a: the keypad sends requests all the time, so P812 does not monitor the other RS-485 interface"});
  EXPECT_FALSE(keypad.plan.has_errors());
  EXPECT_EQ(keypad.plan.serial_lines.size(), 1U) << "that of the keypad is not planned";
}

std::string dp_bus(const std::string& keys = "") { return "[[bus]]\nname = 'p'\nkind = 'profibus'\n" + keys; }
std::string dp_station(const std::string& name, int address, const std::string& keys = "") {
  return "[[station]]\nname = '" + name +
         "'\nunit = 'mc31'\noption = 'ffp31'\nprofibus = 'p'\nprofibus_address = " + std::to_string(address) +
         "\n" + keys;
}
std::string dp_slave_at(int address, const std::string& keys = "") {
  return "[[control.slave]]\naddress = " + std::to_string(address) + "\n" + keys;
}
const std::string kDpControl = "[[control]]\nname = 'plc'\nprofibus = 'p'\naddress = 2\n";

// 33 bits of SYN, 33 of the token and TID2 150; of each slave SYN 33, two frames of 99 and 11 a data octet, TSDR 30 and
// TID1 37; of the GAP poll SYN 33, 66 and the slot, 200 at 500 kbaud (docs/reference/protocols/profibus.md).
TEST(ProfibusLinePlan, CycleAndStations) {
  const PlannedRig of(dp_bus("length = 100.001\n") + dp_station("a", 8) + dp_station("b", 9) + kDpControl +
                      dp_slave_at(9, "cfg = 'F0'\nwatchdog = '200ms'\n") + dp_slave_at(8));
  EXPECT_TRUE(of.texts(FindingKind::ProfibusLine).empty()) << of.texts(FindingKind::ProfibusLine)[0];
  const ProfibusLinePlan& line = of.plan.profibus_lines.at(0);
  EXPECT_EQ(std::tuple(line.name, line.baud, line.length, line.length_limit, line.masters),
            std::tuple("p", 500'000U, 101U, 400U, std::vector<uint8_t>{2}));
  const uint64_t slaves = 2 * (33 + 30 + 37) + 2 * (99 + 11 * 6) + 2 * (99 + 11 * 2);
  EXPECT_EQ(line.cycle_bits, 33U + 33U + 150U + slaves + 33U + 66U + 200U);
  EXPECT_EQ(line.cycle, static_cast<Time>(line.cycle_bits) * 2 * kMicrosecond);
  ASSERT_EQ(line.stations.size(), 2U);
  const auto is = [&](size_t n, const char* name, int address, int octets, Time watchdog) {
    const PlannedProfibusStation& station = line.stations[n];
    EXPECT_EQ(std::tuple(station.name, station.address, station.ident, station.octets, station.watchdog),
              std::tuple(name, address, 0x3100, octets, watchdog));
  };
  is(0, "a", 8, 6, kNever);
  is(1, "b", 9, 2, 200 * kMillisecond);
  const PlannedRig without(dp_bus() + dp_station("a", 8) + kDpControl + "gap = 0\n" + dp_slave_at(8));
  EXPECT_EQ(without.plan.profibus_lines.at(0).cycle_bits, 33U + 33U + 150U + 100U + 2U * (99U + 66U));
}

PlanTexts profibus_findings(const std::string& text) {
  return PlannedRig(text).texts(FindingKind::ProfibusLine);
}

TEST(ProfibusLinePlan, WhatIsAgainstTheRules) {
  const std::string good =
      dp_station("a", 8) + dp_station("b", 9) + kDpControl + dp_slave_at(8) + dp_slave_at(9);
  EXPECT_EQ(profibus_findings(dp_bus() + good), PlanTexts{});
  EXPECT_EQ(profibus_findings(dp_bus("length = 400\nimpedance = 135\ncapacitance = 30\n") + good),
            PlanTexts{});
  EXPECT_EQ(profibus_findings(dp_bus("length = 400.5\n") + good),
            PlanTexts{"400.5 m of cable; at 500000 baud a segment has at most 400 m"});
  EXPECT_EQ(profibus_findings(dp_bus("impedance = 120\n") + good),
            PlanTexts{"surge impedance of the cable is 120 ohm, type A has 135 to 165"});
  EXPECT_EQ(profibus_findings(dp_bus("capacitance = 40\n") + good),
            PlanTexts{"capacitance of the cable is 40 pF/m, type A has less than 30"});
  EXPECT_EQ(profibus_findings(dp_bus() + good + dp_slave_at(10)),
            PlanTexts{"master 2 configures a slave with the address 10, which no station has"});
  EXPECT_EQ(profibus_findings(dp_bus("port = 'pty:/tmp/p'\n") + good + dp_slave_at(10)), PlanTexts{});
  EXPECT_EQ(profibus_findings(dp_bus() + dp_station("a", 2) + kDpControl + dp_slave_at(2)),
            PlanTexts{"a: address 2 is given twice"})
      << "the master has it";
  EXPECT_EQ(profibus_findings(dp_bus() + dp_station("a", 8) + kDpControl),
            PlanTexts{"a: 0 octets are no configuration of this unit"});
  EXPECT_EQ(profibus_findings(dp_bus() + dp_station("a", 8) + kDpControl + dp_slave_at(8, "ident = 1\n")),
            PlanTexts{"a: the master expects ident 0001h, the unit has 3100h"});
  EXPECT_EQ(profibus_findings(dp_bus("baud = 9600\n") + dp_station("a", 8) + kDpControl +
                              dp_slave_at(8, "watchdog = '10ms'\n"))
                .size(),
            1U);
}

// A slave takes one master; the other finds Master_Lock (MOVITRAC 31 PROFIBUS, 3.4.1).
TEST(ProfibusLinePlan, TwoMastersOfOneSlave) {
  const std::string second = "[[control]]\nname = 'plc2'\nprofibus = 'p'\naddress = 3\n";
  const PlannedRig of(dp_bus() + dp_station("a", 8) + kDpControl + dp_slave_at(8) + second + dp_slave_at(8) +
                      dp_slave_at(9));
  EXPECT_EQ(of.plan.profibus_lines.at(0).masters, (std::vector<uint8_t>{2, 3}));
  const std::vector<std::string> wanted = {
      "masters 2 and 3 both configure the slave 8: it takes the first that parameterises it, and the other "
      "gets "
      "Master_Lock",
      "master 3 configures a slave with the address 9, which no station has"};
  EXPECT_EQ(of.texts(FindingKind::ProfibusLine), wanted);
}

// Where the file says nothing of terminators, they are where they belong; from the first that is given on all count.
TEST(ProfibusLinePlan, Terminators) {
  const auto findings = [](const char* a, const char* b) {
    const auto key = [](const char* terminator) {
      return *terminator == 0 ? std::string() : std::string("terminator = ") + terminator + "\n";
    };
    return profibus_findings(dp_bus() + dp_station("a", 8, key(a)) + dp_station("b", 9, key(b)) + kDpControl +
                             dp_slave_at(8) + dp_slave_at(9));
  };
  const std::string open = "b is the last on the line and not terminated";
  const std::string inner = "a is terminated, but not at an end of the line";
  EXPECT_EQ(findings("", ""), PlanTexts{});
  EXPECT_EQ(findings("false", "true"), PlanTexts{});
  EXPECT_EQ(findings("", "true"), PlanTexts{});
  EXPECT_EQ(findings("", "false"), PlanTexts{open});
  EXPECT_EQ(findings("false", ""), PlanTexts{open});
  EXPECT_EQ(findings("false", "false"), PlanTexts{open});
  EXPECT_EQ(findings("true", "true"), PlanTexts{inner});
  EXPECT_EQ(findings("true", "false"), (PlanTexts{inner, open}));
}

TEST(ProfibusLinePlan, CardsAndGatewaysInTheOrderOfTheFile) {
  const PlannedRig of(
      dp_bus() + bus_text() + dp_station("a", 8) +
      "[[station]]\nname = 'g'\nunit = 'gateway'\nprofibus = 'p'\nprofibus_address = 10\nsbus = 'sbus'\n"
      "[[station]]\nname = 's'\nunit = 'mc31'\noption = 'size0'\nprofibus = 'p'\nprofibus_address = 11\n"
      "[[station]]\nname = 'd'\nunit = 'mdxb'\nsbus = 'sbus'\noption = 'dfp'\nprofibus = "
      "'p'\nprofibus_address = 12\n" +
      kDpControl + dp_slave_at(8) + dp_slave_at(10, "cfg = 'F3 F2'\n") + dp_slave_at(11) +
      dp_slave_at(12, "cfg = 'F9'\n"));
  EXPECT_EQ(of.texts(FindingKind::ProfibusLine), PlanTexts{});
  std::string order;
  for (const PlannedProfibusStation& station : of.plan.profibus_lines.at(0).stations)
    order += station.name + std::to_string(station.octets) + " ";
  EXPECT_EQ(order, "a6 g14 s6 d20 ");
}

}  // namespace
}  // namespace ipos::tests
