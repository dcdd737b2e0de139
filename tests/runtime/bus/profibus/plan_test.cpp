// A line on paper: cable type A, terminators, who fits where, and the cycle against its closed form.
#include "runtime/bus/profibus/line_plan.hpp"

#include <tuple>

#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;

LinePlan good(int count = 2) {
  LinePlan plan;
  for (int n = 0; n < count; ++n) {
    PlannedStation station;
    station.name = "inv" + std::to_string(n);
    station.address = static_cast<uint8_t>(10 + n);
    station.terminated = n + 1 == count;
    plan.stations.push_back(station);
  }
  return plan;
}

// The only finding, or all of them with "|".
std::string findings(const LinePlan& plan) {
  std::string text;
  for (const std::string& finding : check_plan(plan)) text += (text.empty() ? "" : "|") + finding;
  return text;
}

TEST(LinePlan, CableAndTerminators) {
  PROVES("DP-ID-10");
  LinePlan plan = good();
  plan.cable.ohms = 150;
  plan.cable.picofarads_a_metre = 28;
  EXPECT_EQ(findings(plan), "");
  plan.cable.ohms = 170;
  EXPECT_EQ(findings(plan), "surge impedance of the cable is 170 ohm, type A has 135 to 165");
  plan = good();
  plan.cable.picofarads_a_metre = 31;
  plan.cable.ohms_a_kilometre = 111;
  plan.cable.diameter = 0.6;
  plan.cable.section = 0.3;
  EXPECT_EQ(
      findings(plan),
      "capacitance of the cable is 31 pF/m, type A has less than 30|loop resistance of the cable is 111 "
      "ohm/km, type A has less than 110|core diameter of the cable is 0.6 mm, type A has more than "
      "0.64|core cross section of the cable is 0.3 mm2, type A has more than 0.34");
  plan = good(3);
  plan.stations[1].terminated = true;
  EXPECT_EQ(findings(plan), "inv1 is terminated, but not at an end of the line");
  plan = good();
  plan.stations[1].terminated = false;
  plan.master_terminated = false;
  EXPECT_EQ(findings(plan),
            "the master is the first on the line and not terminated|inv1 is the last on the line and not "
            "terminated");
  const std::pair<uint32_t, double> kMetres[] = {{9'600, 1200},   {19'200, 1200}, {93'750, 1200},
                                                 {187'500, 1000}, {500'000, 400}, {1'500'000, 200}};
  for (const auto& [baud, metres] : kMetres) {
    plan = good();
    plan.baud = baud;
    plan.cable.metres = metres;
    EXPECT_EQ(findings(plan), "");
    plan.cable.metres = metres + 1;
    EXPECT_NE(findings(plan), "");
  }
  plan = good();
  plan.baud = 3'000'000;
  EXPECT_EQ(findings(plan), "3000000 baud is no rate of these units");
}

TEST(LinePlan, WhichOptionFitsWhere) {
  PROVES("DP-ID-11");
  LinePlan plan = good();
  PlannedStation& station = plan.stations[0];
  station.interface = Interface::Ffp31A;
  station.series = InverterSeries::B;
  EXPECT_EQ(findings(plan), "");
  station.service_code_4 = 13;
  EXPECT_EQ(findings(plan), "inv0: FFP 31A wants a service code of component 4 of at least 14");
  station.series = InverterSeries::C;
  EXPECT_EQ(findings(plan), "inv0: FFP 31A is for MOVITRAC 31B");
  station.interface = Interface::Ffp31C;
  for (uint8_t size = 0; size < 6; ++size) {
    station.size = size;
    EXPECT_EQ(findings(plan), size >= 1 && size <= 4 ? "" : "inv0: FFP 31C is for sizes 1 to 4") << int{size};
  }
  station.size = 0;
  station.interface = Interface::Size0;
  station.ident = 0x3111;
  EXPECT_EQ(findings(plan), "");
  station.size = 1;
  EXPECT_EQ(findings(plan), "inv0: the built-in interface is that of MOVITRAC 31C size 0");
}

// A card of MOVIDRIVE and a gateway have idents and lengths of their own.
TEST(LinePlan, CardsOfOtherUnits) {
  LinePlan plan = good();
  PlannedStation& station = plan.stations[0];
  station.interface = Interface::Card;
  station.card = &option_type(OptionKind::Dfp11);
  EXPECT_EQ(findings(plan), "inv0: the master expects ident 3100h, the unit has 6000h");
  station.ident = 0x6000;
  EXPECT_EQ(findings(plan), "");
  station.octets = 20;
  EXPECT_EQ(findings(plan), "inv0: 20 octets are no configuration of this unit") << "ten words";
  station.card = &option_type(OptionKind::Dfp21);
  station.ident = 0x6003;
  EXPECT_EQ(findings(plan), "");
  station.card = &option_type(OptionKind::Gateway);
  station.ident = 0x6002;
  EXPECT_EQ(findings(plan), "") << "channel and two drives: 8 + 12";
  station.octets = 0;
  EXPECT_EQ(findings(plan), "inv0: 0 octets are no configuration of this unit");
  station.of_fms = true;
  EXPECT_EQ(findings(plan), "") << "FMS wants none";
  station.octets = 21;
  EXPECT_EQ(findings(plan), "inv0: 21 octets are no configuration of this unit");
}

TEST(LinePlan, AddressesIdentsAndWatchdog) {
  LinePlan plan = good(3);
  plan.stations[1].address = 10;
  plan.stations[2].address = 126;
  EXPECT_EQ(findings(plan), "inv1: address 10 is given twice|inv2: address 126 is not in 0..125");
  plan = good();
  plan.stations[0].address = plan.masters[0];
  EXPECT_EQ(findings(plan), "inv0: address 1 is given twice");
  plan = good();
  plan.stations[0].ident = 0x3111;
  plan.stations[1].octets = 8;
  EXPECT_EQ(
      findings(plan),
      "inv0: the master expects ident 3111h, the unit has 3100h|inv1: 8 octets are no configuration of this "
      "unit");
  plan = good();
  plan.baud = 9'600;
  plan.stations[0].watchdog = 100 * kMillisecond;
  plan.stations[1].watchdog = 10 * kMillisecond;
  // 2 x (33 + 2 x 165 + 67) + 216 + 199 bits at 9.6 kbaud.
  EXPECT_EQ(cycle_bits(plan), 2U * 430 + 216 + 199);
  EXPECT_EQ(
      findings(plan),
      "inv0: the watchdog of 100 ms is not longer than a cycle of 132.81 ms|inv1: the watchdog of 10 ms is "
      "not longer than a cycle of 132.81 ms");
  EXPECT_NE(findings(good(32)).find("33 stations; a segment has at most 32"), std::string::npos);
}

// Every limit itself is good, on both sides; a little beyond it is not.
TEST(LinePlan, LimitsAreStillGood) {
  const auto with = [](double Cable::*value, double to) {
    LinePlan plan = good();
    plan.cable.*value = to;
    return findings(plan).empty();
  };
  for (const auto& [value, limit, beyond] : {std::tuple(&Cable::ohms, 135.0, 134.9),
                                             {&Cable::ohms, 165.0, 165.1},
                                             {&Cable::picofarads_a_metre, 30.0, 30.1},
                                             {&Cable::picofarads_a_metre, 0.0, -0.1},
                                             {&Cable::ohms_a_kilometre, 110.0, 110.1},
                                             {&Cable::diameter, 0.64, 0.63},
                                             {&Cable::section, 0.34, 0.33}}) {
    EXPECT_TRUE(with(value, limit)) << limit;
    EXPECT_FALSE(with(value, beyond)) << beyond;
  }
  EXPECT_TRUE(with(&Cable::diameter, 100));
  EXPECT_EQ(findings({}), "") << "a line without stations wants no terminators";
  LinePlan plan = good();
  plan.stations[1].address = 125;
  EXPECT_EQ(findings(plan), "");
  plan = good(31);
  plan.cable.metres = 400;
  EXPECT_EQ(findings(plan), "") << "31 and the master";
  PlannedStation& station = plan.stations[0];
  station.interface = Interface::Size0;
  station.ident = 0x3111;
  station.size = 0;
  station.series = InverterSeries::B;
  EXPECT_EQ(findings(plan), "inv0: the built-in interface is that of MOVITRAC 31C size 0");
  station.interface = Interface::Ffp31C;
  station.ident = 0x3100;
  EXPECT_EQ(findings(plan), "inv0: FFP 31C is for MOVITRAC 31C");
}

// SYN, token and TID2, for each station SYN, two frames, Tsdr and TID1, and one poll of the GAP that nobody answers.
TEST(LinePlan, CycleInBits) {
  LinePlan plan;
  plan.gap_poll = false;
  plan.idle_2 = 160;
  EXPECT_EQ(cycle_bits(plan), 33U + 33 + 160);
  plan.stations.resize(2);
  plan.stations[0].octets = 2;
  plan.stations[1].octets = 14;
  plan.tsdr = 31;
  plan.idle_1 = 38;
  const Bits first = 33 + 2 * (99 + 22) + 31 + 38, second = 33 + 2 * (99 + 154) + 31 + 38;
  EXPECT_EQ(cycle_bits(plan), 226U + first + second);
  plan.gap_poll = true;
  EXPECT_EQ(cycle_bits(plan), 226U + first + second + 33 + 66 + 200) << "500 kbaud";
  plan.baud = 1'500'000;
  EXPECT_EQ(cycle_bits(plan), 226U + first + second + 33 + 66 + 300);
  plan.baud = 1;
  EXPECT_EQ(cycle_bits(plan), 226U + first + second) << "a rate without a slot time";
  // A watchdog as long as the cycle is too short.
  plan = good(1);
  plan.gap_poll = false;
  plan.baud = 500'000;
  const Time cycle = static_cast<Time>(cycle_bits(plan)) * 2'000;
  plan.stations[0].watchdog = cycle + 1;
  EXPECT_EQ(findings(plan), "");
  plan.stations[0].watchdog = cycle;
  EXPECT_NE(findings(plan), "");
}

}  // namespace
}  // namespace ipos::tests
