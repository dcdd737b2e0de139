// What a plan says of an SBus, word for word: who calls whom, what keeps a unit from following, the cable and its
// planted faults.
#include <gtest/gtest.h>

#include "runtime/bus_plan/plan.hpp"
#include "tests/runtime/bus_plan/plant_rig.hpp"

namespace ipos::tests {
namespace {

using FoundTexts = std::vector<std::string>;

FoundTexts found_of(FindingKind kind, const std::string& toml,
                    const std::map<std::string, std::string>& sources = {}) {
  PlantRig rig(toml, sources);
  const BusPlan plan = make_plan(rig.get(), {});
  FoundTexts all;
  for (const Finding& finding : plan.findings)
    if (finding.kind == kind) {
      all.push_back(finding.text);
      EXPECT_EQ(finding.line, "sbus");
    }
  return all;
}

// One call of each address, with process data (format 3 words) or a parameter.
std::string one_call(int address, const char* format = "ML_FT_PAR3") {
  return "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() { m.BusType = ML_BT_SBUS; m.Format = " +
         std::string(format) + "; m.Service = ML_S_RD; m.Index = 8318; m.DPointer = numof(d); m.Address = " +
         std::to_string(address) + "; _MoviLink(m); while (1) ; }\n";
}
std::string plc_with(const std::string& target, const std::string& name = "plc") {
  return "[[control]]\nname = '" + name + "'\nsbus = 'sbus'\n[[control.target]]\n" + target +
         "every = '10ms'\n";
}
const std::string kFollowing = "P100 = 10\nP101 = 3\n";
const std::string kTwoUnits = station_text("a", "P813 = 1\nP814 = 4\n" + kFollowing) +
                              station_text("b", "P813 = 3\nP814 = 5\n" + kFollowing);

TEST(PlanTexts, WhoIsCalledAndNotThere) {
  const auto nobody = [](const std::string& more, const std::string& keys = "") {
    return found_of(FindingKind::NobodyThere, bus_text(500'000, keys) + kTwoUnits + more);
  };
  EXPECT_EQ(nobody(plc_with("address = 3\n")), FoundTexts{});
  EXPECT_EQ(nobody(plc_with("group = 5\n")), FoundTexts{});
  EXPECT_EQ(nobody(plc_with("address = 4\n")),
            FoundTexts{"plc calls address 4, which no station has; there are 1 (a), 3 (b)"});
  EXPECT_EQ(nobody(plc_with("group = 3\n")),
            FoundTexts{"plc calls group 3, which no station has; there are 4 (a), 5 (b)"});
  EXPECT_EQ(nobody(plc_with("address = 4\n"), "port = 'can0'\n"), FoundTexts{});
  EXPECT_EQ(nobody(plc_with("group = 3\n"), "port = 'can0'\n"), FoundTexts{});
  EXPECT_EQ(found_of(FindingKind::NobodyThere,
                     bus_text() + "[[station]]\nname = 'a'\nunit = 'md60a'\n" + plc_with("address = 4\n")),
            FoundTexts{"plc calls address 4, which no station has; there are none"});
  const std::string canopen =
      "[[control]]\nname = 'plc'\nkind = 'canopen'\nsbus = 'sbus'\n[[control.target]]\naddress = 9\n";
  EXPECT_EQ(nobody(canopen), FoundTexts{"plc calls node 9, which no station is"});
  EXPECT_EQ(nobody(canopen, "port = 'can0'\n"), FoundTexts{});
}

TEST(PlanTexts, MovlnkWantsTheLineForItself) {
  const auto masters = [](bool a, bool b, const std::string& more) {
    return found_of(FindingKind::SeveralMasters,
                    bus_text() + station_text("a", "P813 = 1\n", "md60a", a ? "A.IPC" : "") +
                        station_text("b", "P813 = 2\n", "md60a", b ? "B.IPC" : "") +
                        station_text("c", "P813 = 3\n") + more,
                    {{"A.IPC", one_call(3)}, {"B.IPC", one_call(3)}});
  };
  EXPECT_EQ(masters(true, false, ""), FoundTexts{});
  EXPECT_EQ(masters(false, false, plc_with("address = 3\n") + plc_with("address = 2\n", "other")),
            FoundTexts{});
  EXPECT_EQ(masters(true, false, plc_with("address = 3\n")),
            FoundTexts{"a uses MOVLNK, but a, plc are masters on this line"});
  EXPECT_EQ(masters(true, true, ""), FoundTexts{"a, b use MOVLNK, but a, b are masters on this line"});
  EXPECT_EQ(masters(true, false, "[[control]]\nname = 'plc'\nsbus = 'sbus'\n"), FoundTexts{})
      << "it calls nobody";
}

TEST(PlanTexts, WhatKeepsAUnitFromFollowing) {
  const auto hints = [](const std::string& parameters, const std::string& unit = "mdxb") {
    return found_of(FindingKind::ProcessData,
                    bus_text() +
                        station_text("a", (unit == "mdxb" ? "P881 = 3\n" : "P813 = 3\n") + parameters, unit) +
                        plc_with("address = 3\n"));
  };
  const std::string begin = "a does not follow process data: ";
  EXPECT_EQ(hints(kFollowing), FoundTexts{});
  const FoundTexts none = hints("");
  ASSERT_EQ(none.size(), 2U);
  EXPECT_TRUE(none[0].starts_with(begin + "P100 Setpoint source is ") && none[0].ends_with(", not SBus"))
      << none[0];
  EXPECT_TRUE(none[1].starts_with(begin + "P101 Control signal source is TERMINALS, not SBus")) << none[1];
  const FoundTexts off = hints(kFollowing + "P876 = 0\n");
  ASSERT_EQ(off.size(), 1U);
  EXPECT_TRUE(off[0].starts_with(begin + "P876 ") && off[0].ends_with(" is OFF, not ON")) << off[0];
  // P870..P872: CONTROL WORD 1, SPEED by default; 0 is no function.
  EXPECT_EQ(
      hints(kFollowing + "P870 = 0\n"),
      FoundTexts{"no PO word of a is a control word (P870..P872): it is enabled as if the bus had sent it"});
  EXPECT_EQ(hints(kFollowing + "P871 = 0\nP872 = 0\n"),
            FoundTexts{"no PO word of a is a speed (P870..P872): its setpoint counts as 0"});
  // Torque control wants a current (2), in whichever word.
  const std::string torque = kFollowing + "P700 = 12\n";
  const FoundTexts no_current{"no PO word of a is a current (P870..P872): its torque counts as 0"};
  EXPECT_EQ(hints(torque, "md60a"), no_current);
  EXPECT_EQ(hints(torque + "P871 = 2\n", "md60a"), FoundTexts{});
  EXPECT_EQ(hints(torque + "P872 = 2\n", "md60a"), FoundTexts{});
  EXPECT_EQ(hints(torque + "P870 = 2\nP871 = 9\n", "md60a"), FoundTexts{});
  EXPECT_EQ(hints("P100 = 10\nP870 = 0\n").size(), 1U) << "terminals control it";
  EXPECT_EQ(hints("P101 = 3\nP871 = 0\nP872 = 0\n").size(), 1U) << "the setpoint is another one";
  EXPECT_EQ(found_of(FindingKind::ProcessData,
                     bus_text() + station_text("a", "P813 = 3\n") + plc_with("group = 0\n")),
            FoundTexts{})
      << "a group is not asked";
  const std::string twice = plc_with("address = 3\n") + plc_with("address = 3\n", "other");
  EXPECT_EQ(found_of(FindingKind::ProcessData, bus_text() + station_text("a", "P813 = 3\nP101 = 3\n") + twice)
                .size(),
            1U)
      << "once a station";
}

// 1053 1610 p. 13: the longest line at each baud rate.
TEST(PlanTexts, CableAtEachBaudRate) {
  const std::pair<uint32_t, uint32_t> rows[] = {
      {125'000, 320}, {250'000, 160}, {500'000, 80}, {1'000'000, 40}};
  for (const auto& [baud, metres] : rows) {
    PlantRig rig(bus_text(baud, "length = 7.5\n") + station_text("u", ""));
    const BusPlan plan = make_plan(rig.get(), {});
    EXPECT_EQ(plan.lines[0].length_limit, metres) << baud;
    EXPECT_EQ(plan.lines[0].length, 8U) << "begun metres count";
  }
}

TEST(PlanTexts, OfTheCable) {
  const auto with_baud = [](const std::string& unit, const std::string& parameters,
                            const std::string& keys = "") {
    return found_of(FindingKind::BaudRate,
                    bus_text(500'000) + "[[bus]]\nname = 'other'\nkind = 'can'\nbaud = 500000\n" +
                        (keys.empty() ? station_text("u", parameters, unit)
                                      : "[[station]]\nname = 'u'\nunit = '" + unit + "'\n" + keys +
                                            "[station.parameters]\n" + parameters));
  };
  const std::string rest = ", the line has 500 kbaud: it neither hears nor answers";
  EXPECT_EQ(with_baud("md60a", "P816 = 1\n"), FoundTexts{"u is set to 250 kbaud (P816)" + rest});
  EXPECT_EQ(with_baud("mdxb", "P884 = 3\n"), FoundTexts{"u is set to 1000 kbaud (P884)" + rest});
  EXPECT_EQ(with_baud("mdxb", "P894 = 0\n", "sbus2 = 'sbus'\n"),
            FoundTexts{"u is set to 125 kbaud (P894)" + rest});
  EXPECT_EQ(with_baud("mdxb", "P884 = 2\n"), FoundTexts{});
  EXPECT_EQ(found_of(FindingKind::CableData, bus_text(500'000, "impedance = 60\n") + station_text("u", "")),
            FoundTexts{"cable of 60 ohm, 120 ohm are needed"});
  EXPECT_EQ(
      found_of(FindingKind::LineTooLong, bus_text(500'000, "length = 80.001\n") + station_text("u", "")),
      FoundTexts{"81 m of cable, at 500 kbaud at most 80 m"})
      << "begun metres count";
  const auto ends = [](const std::string& a, const std::string& b, const std::string& c) {
    return found_of(FindingKind::Termination, bus_text() + station_text("a", "P813 = 1\n", "md60a", "", a) +
                                                  station_text("b", "P813 = 2\n", "md60a", "", b) +
                                                  station_text("c", "P813 = 3\n", "md60a", "", c));
  };
  const std::string on = "terminator = true\n", off = "terminator = false\n";
  EXPECT_EQ(ends(off, on, ""), (FoundTexts{"a is at an end of the line, but its S12 is off",
                                           "b is not at an end of the line, but its S12 is on",
                                           "c is at an end of the line, but its S12 is off"}));
  EXPECT_EQ(ends(on, on + "branch = true\n", on),
            FoundTexts{"b: S12 is on, so the cable that goes on over SC21/SC22 is dead"});
  EXPECT_EQ(found_of(FindingKind::Termination, bus_text() + station_text("a", "", "md60a", "", off)),
            FoundTexts{})
      << "one station has no line";
}

// SBus 1 is terminated by S12, SBus 2 by switch R of DFC11B (MDX60B/61B chapter 3.3.1): a unit on both has both.
TEST(PlanTexts, EachLineHasItsOwnTerminator) {
  const auto ends = [](const std::string& x) {
    const auto station = [](const std::string& name, const std::string& keys) {
      return "[[station]]\nname = '" + name + "'\nunit = 'mdxb'\n" + keys;
    };
    std::vector<std::string> found;
    PlantRig rig(
        "[[bus]]\nname = 's1'\nkind = 'can'\n[[bus]]\nname = 's2'\nkind = 'can'\n" +
        station("a", "sbus = 's1'\nterminator = true\n[station.parameters]\nP881 = 1\n") +
        station("b", "sbus2 = 's2'\nterminator2 = true\n[station.parameters]\nP891 = 3\n") +
        station("x", "sbus = 's1'\nsbus2 = 's2'\n" + x + "[station.parameters]\nP881 = 2\nP891 = 2\n") +
        // On one line alone the plain key is enough.
        station("c", "sbus2 = 's2'\nterminator = true\n[station.parameters]\nP891 = 4\n"));
    for (const Finding& finding : make_plan(rig.get(), {}).findings) {
      if (finding.kind != FindingKind::Termination) continue;
      found.push_back(finding.line + ": " + finding.text);
      // The journal of a run says the same.
      EXPECT_EQ(rig.says(found.back()), 1U) << found.back();
    }
    return found;
  };
  EXPECT_EQ(ends("terminator = true\n"), std::vector<std::string>{});
  EXPECT_EQ(ends("terminator = true\nterminator2 = false\n"), std::vector<std::string>{});
  EXPECT_EQ(ends("terminator2 = true\n"),
            (std::vector<std::string>{"s1: x is at an end of the line, but its S12 is off",
                                      "s2: x is not at an end of the line, but its switch R is on"}));
}

// What the plan finds of a cable, a plant tells when it starts.
TEST(PlanTexts, ARunTellsWhatIsWrongWithTheCable) {
  const std::string off = "terminator = false\n";
  PlantRig rig("[[bus]]\nname = 'sbus'\nkind = 'can'\nlength = 300\nimpedance = 60\ncapacitance = 41\n" +
               station_text("a", "P813 = 1\n", "md60a", "", off) +
               station_text("b", "P813 = 2\nP816 = 1\n", "md60a", "", off));
  rig.run_until(kMillisecond);
  for (const char* text :
       {"300 m of cable, at 500 kbaud at most 80 m", "cable of 60 ohm, 120 ohm are needed",
        "cable of 41 pF/m, at most 40 pF/m", "a is at an end of the line, but its S12 is off",
        "b is at an end of the line, but its S12 is off",
        "b takes no part: its baud rate is not that of the line (250 kbaud, line 500 kbaud)"})
    EXPECT_EQ(rig.says(std::string("sbus: ") + text), 1U) << text;
  PlantRig good(bus_text() + station_text("a", "P813 = 1\n") + station_text("b", "P813 = 2\n"));
  EXPECT_EQ(good.journal(), "");
}

TEST(PlanTexts, OfPlantedFaults) {
  const auto faults = [](FindingKind kind, const std::string& fault, const std::string& more) {
    return found_of(kind, bus_text() + kTwoUnits + fault_text(fault, more));
  };
  const std::string a = "station = \"a\"\n";
  EXPECT_EQ(faults(FindingKind::CableFault, "cut", "behind = \"a\"\n"),
            FoundTexts{"the line is cut behind a"});
  EXPECT_EQ(faults(FindingKind::CableFault, "cut", a), FoundTexts{"a is cut"});
  EXPECT_EQ(faults(FindingKind::CableFault, "short", ""),
            FoundTexts{"the line has high and low short-circuited: no dominant level"});
  EXPECT_EQ(faults(FindingKind::CableFault, "stuck", ""), FoundTexts{"the line is held dominant"});
  EXPECT_EQ(faults(FindingKind::CableFault, "terminator", ""),
            FoundTexts{"the line has a bit disturbed by reflections: a terminating resistor is missing"});
  EXPECT_EQ(faults(FindingKind::SwappedWires, "swap", a), FoundTexts{"a has high and low interchanged"});
  EXPECT_EQ(faults(FindingKind::CableFault, "swap", a), FoundTexts{});
  for (const char* of_frames : {"drop", "corrupt", "duplicate"})
    EXPECT_EQ(faults(FindingKind::CableFault, of_frames, ""), FoundTexts{}) << of_frames;
  const std::string other =
      "[[bus]]\nname = 'other'\nkind = 'can'\n[[fault]]\nbus = 'other'\nkind = 'stuck'\n";
  EXPECT_EQ(found_of(FindingKind::CableFault, bus_text() + kTwoUnits).size(), 0U);
  PlantRig rig(bus_text() + kTwoUnits + other);
  const BusPlan plan = make_plan(rig.get(), {});
  ASSERT_EQ(plan.findings.size(), 1U);
  EXPECT_EQ(plan.findings[0].line, "other");
}

TEST(PlanTexts, UnitsOfTwoKindsAtOneMegabaud) {
  const auto mixed = [](const std::string& second, const std::string& unit) {
    return found_of(FindingKind::MixedMch42a,
                    bus_text(1'000'000) +
                        station_text("m", "P813 = 1\nP816 = 3\n", "compact", "", "device = 'MCH42A'\n") +
                        station_text("o", second, unit));
  };
  const std::string text = "m is an MCH42A, o another MOVIDRIVE: at 1000 kbaud they must not share a line";
  EXPECT_EQ(mixed("P813 = 2\nP816 = 3\n", "md60a"), FoundTexts{text});
  EXPECT_EQ(mixed("P813 = 2\nP816 = 3\n", "compact"), FoundTexts{text});
  EXPECT_EQ(mixed("P881 = 2\nP884 = 3\n", "mdxb"), FoundTexts{text});
  EXPECT_EQ(mixed("P813 = 2\nP816 = 3\n", "mc07"), FoundTexts{}) << "no MOVIDRIVE";
}

}  // namespace
}  // namespace ipos::tests
