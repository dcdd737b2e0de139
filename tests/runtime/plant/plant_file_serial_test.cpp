// What cannot be wired on RS-485 and RS-232 is an error of the plant file (1053 1610 p. 5-15, MDX60B/61B p. 8-19); what
// will hardly work is found with the parameters of the units (1053 1610 p. 72, 80).
#include "tests/runtime/plant/plant_file_texts.hpp"

#include "runtime/plant_file/serial_plan.hpp"

namespace ipos::runtime {
namespace {

using tests::expect_mistakes;
using tests::read_plant;

const std::string kSerialLines =
    "[[bus]]\nname = 'r'\nkind = 'rs485'\n[[bus]]\nname = 'x'\nkind = 'rs485'\n[[bus]]\nname = 's'\nkind = "
    "'rs232'\n";

std::string serial_unit(const std::string& name, const std::string& type, const std::string& keys) {
  return "[[station]]\nname = '" + name + "'\nunit = '" + type + "'\n" + keys;
}

TEST(SerialPlan, InterfacesOfTheUnits) {
  const struct {
    const char* type;
    bool x13, xt, uss21a, s13;  // uss21a: only with it; s13: has the switch
  } rows[] = {{"md60a", true, true, true, false},
              {"compact", false, true, true, false},
              {"mc07", true, false, false, false},
              {"mdxb", true, true, false, true},
              {"mc31", false, false, false, false}};
  for (const auto& row : rows) {
    const std::string u = "unit " + std::string(row.type) + " ";
    const auto check = [&](bool right, const std::string& marked, const std::string& message) {
      const std::string text = kSerialLines + serial_unit("u", row.type, tests::without_marks(marked).text);
      if (right)
        read_plant(text);
      else
        expect_mistakes(kSerialLines, {{serial_unit("u", row.type, marked), message}});
    };
    check(row.x13, "rs485 = ^'r'\n", u + "has no RS-485 terminals");
    if (!row.xt) check(false, "rs485_xt = ^'r'\n", u + "has no XT or TERMINAL socket");
    if (row.xt) check(!row.uss21a, "rs485_xt = ^'r'\n", "RS-485 at the TERMINAL socket needs uss21a = true");
    if (row.uss21a) check(true, "rs485_xt = 'r'\nuss21a = true\n", "");
    check(row.uss21a, "uss21a = ^true\n", u + "takes no USS21A");
    check(true, "uss21a = false\n", "");
    check(row.xt, "keypad = ^true\n", u + "has no socket for a keypad");
    check(true, "keypad = false\n", "");
    check(row.s13, "s13 = ^true\n", u + "has no DIP switch S13");
    check(row.s13, "s13 = ^false\n", u + "has no DIP switch S13");
  }
  expect_mistakes(
      kSerialLines,
      {{serial_unit("u", "compact", "rs485 = ^'r'\n"), "terminals; it has rs485_xt"},
       {serial_unit("u", "mdxb", "rs485 = 'r'\nrs485_xt = ^'r'\n"),
        "both interfaces of the unit are on the same line"},
       {serial_unit("u", "mdxb", "rs485_xt = 'r'\nkeypad = ^true\n"), "the keypad takes the socket"},
       {serial_unit("u", "md60a", "uss21a = true\nkeypad = ^true\n"), "the keypad takes the socket"}});
  const auto errors = read_plant_file(kSerialLines + serial_unit("u", "mc31", "rs485 = 'r'\n")).errors;
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].text, "unit mc31 has no RS-485 terminals");
  read_plant(kSerialLines + serial_unit("u", "mdxb", "rs485 = 'r'\nkeypad = true\n"));
  read_plant(kSerialLines + serial_unit("u", "mdxb", "rs485 = 'r'\nrs485_xt = 'x'\n"));
}

TEST(SerialPlan, RatesOfXt) {
  const auto baud = [](const char* type, const char* keys) {
    return xt_baud(read_plant(serial_unit("u", type, keys)).stations.at(0));
  };
  EXPECT_EQ(baud("mdxb", ""), 57'600U);
  EXPECT_EQ(baud("mdxb", "s13 = false\n"), 57'600U);
  EXPECT_EQ(baud("mdxb", "s13 = true\n"), 9'600U);
  EXPECT_EQ(baud("md60a", "uss21a = true\n"), 9'600U);
}

std::string many_units(int count, const std::string& type, const std::string& keys,
                       const std::string& name = "u") {
  std::string text;
  for (int n = 0; n < count; ++n) text += serial_unit(name + std::to_string(n), type, keys);
  return text;
}

// 32 stations, of these 31 slaves; who sends setpoints or runs a program is the master.
TEST(SerialPlan, StationsOfALine) {
  const std::string line = "[[bus]]\nname = 'r'\nkind = 'rs485'\n", x13 = "rs485 = 'r'\n";
  const std::string usses = "rs485_xt = 'r'\nuss21a = true\n";
  const std::string master = x13 + "program = 'P'\n";
  const auto count = [](int stations, int loads) {
    return "'r' has " + std::to_string(stations) + " stations that count as " + std::to_string(loads) +
           "; a line takes 32";
  };
  for (const std::string& good :
       {many_units(31, "mc07", x13), many_units(31, "mc07", x13) + serial_unit("m", "mc07", master),
        many_units(31, "mc07", x13) + serial_unit("m", "mc07", x13 + "[station.parameters]\nP750 = 1\n"),
        many_units(31, "mc07", x13) + serial_unit("m", "mc07", x13 + "[station.parameters]\n8592 = 9\n"),
        many_units(16, "md60a", usses), many_units(15, "md60a", usses) + many_units(2, "mc07", x13, "v"),
        many_units(31, "md60a", x13 + "uss21a = true\n")})
    EXPECT_TRUE(check_serial_plan(read_plant(line + good)).empty());
  expect_mistakes(
      "", {
              {"^" + line + many_units(32, "mc07", x13), count(32, 32)},
              {"^" + line + many_units(32, "mc07", x13) + serial_unit("m", "mc07", master), count(33, 33)},
              {"^" + line + many_units(31, "mc07", x13) +
                   serial_unit("m", "mc07", x13 + "[station.parameters]\nP750 = 2\n"),
               count(32, 32)},
              {"^" + line + many_units(31, "mc07", x13) +
                   serial_unit("m", "mc07", x13 + "[station.parameters]\nP751 = 1\n"),
               count(32, 32)},
              {"^" + line + many_units(17, "md60a", usses), count(17, 34)},
              {"^" + line + many_units(15, "md60a", usses) + many_units(3, "mc07", x13, "v"), count(18, 33)},
          });
}

TEST(SerialPlan, SomeLinesConnectTwo) {
  const std::string xt = "rs485_xt = 'l'\n", x13 = "rs485 = 'l'\n", program = "program = 'P'\n";
  for (const std::string kind : {"rs232", "rs485"}) {
    const std::string line = "[[bus]]\nname = 'l'\nkind = '" + kind + "'\n";
    const auto text = [](int stations) {
      return "'l' connects one master and one slave, not " + std::to_string(stations) + " stations";
    };
    read_plant(line + serial_unit("a", "mdxb", xt));
    read_plant(line + serial_unit("a", "mdxb", xt + program) + serial_unit("b", "mc07", x13));
    expect_mistakes(
        "", {{"^" + line + serial_unit("a", "mdxb", xt) + serial_unit("b", "mc07", x13), text(2)},
             {"^" + line + serial_unit("a", "mdxb", xt + program) + many_units(2, "mc07", x13), text(3)}});
  }
  const std::string line = "[[bus]]\nname = 'l'\nkind = 'rs232'\n";
  read_plant(line + serial_unit("a", "mc07", x13 + program) + serial_unit("b", "mc07", x13));
  expect_mistakes("", {{"^" + line + many_units(2, "mc07", x13), "not 2 stations"},
                       {"^" + line + serial_unit("a", "mc07", x13 + program) + many_units(2, "mc07", x13),
                        "not 3 stations"}});
  read_plant("[[bus]]\nname = 'l'\nkind = 'rs485'\n" + many_units(3, "mc07", x13));
}

TEST(SerialPlan, LengthsAndCables) {
  const std::string xt = serial_unit("a", "mdxb", "rs485_xt = 'l'\n"),
                    x13 = serial_unit("a", "mdxb", "rs485 = 'l'\n");
  const struct {
    std::string kind, keys, station;
    int metres;
    const char* of;
  } rows[] = {{"rs485", "", x13, 200, "RS-485 line"},
              {"rs485", "shielded = true\n", x13, 200, "RS-485 line"},
              {"rs232", "", x13, 5, "RS-232 line"},
              {"rs485", "", xt, 3, "line at XT of MOVIDRIVE B"},
              {"rs232", "", xt, 3, "line at XT of MOVIDRIVE B"},
              {"rs485", "shielded = true\n", xt, 5, "shielded line at XT of MOVIDRIVE B"}};
  for (const auto& row : rows) {
    const std::string line = "[[bus]]\nname = 'l'\nkind = '" + row.kind + "'\n" + row.keys;
    const std::string m = std::to_string(row.metres);
    const PlantFile plant = read_plant(line + "length = " + m + "\n" + row.station);
    EXPECT_EQ(serial_length_limit(plant, plant.buses.at(0)), static_cast<uint32_t>(row.metres) * 1'000);
    EXPECT_TRUE(serial_cable_findings(plant, plant.buses.at(0)).empty());
    const PlantFile longer = read_plant(line + "length = " + m + ".001\n" + row.station);
    const auto found = serial_cable_findings(longer, longer.buses.at(0));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].rule, SerialCableFinding::Rule::TooLong);
    EXPECT_EQ(found[0].text, m + ".001 m of cable, a " + row.of + " may have " + m + " m");
  }
  const std::string line = "[[bus]]\nname = 'l'\nkind = 'rs485'\n";
  for (const char* good : {"impedance = 100\n", "impedance = 150\n", "impedance = 0\n", "capacitance = 40\n"})
    read_plant(line + good + x13);
  expect_mistakes(
      "",
      {{"^" + line + "impedance = 99\n" + x13, "cable of 99 ohm; a RS-485 line needs 100 to 150 ohm"},
       {"^" + line + "impedance = 151\n" + x13, "cable of 151 ohm"},
       {"^" + line + "capacitance = 41\n" + x13, "cable of 41 pF/m; a RS-485 line may have 40 pF/m"},
       {"^" + line + "terminated = true\nimpedance = 151\n" + x13, "cable of 151 ohm"}});
  for (const std::string kind : {"rs485", "rs232"}) {
    const PlantFile more = read_plant("[[bus]]\nname = 'l'\nkind = '" + kind + "'\nterminated = true\n" + x13);
    const auto found = serial_cable_findings(more, more.buses.at(0));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].rule, SerialCableFinding::Rule::Terminated);
    EXPECT_EQ(found[0].text, "the units have terminating resistors; connect no others");
  }
  read_plant("[[bus]]\nname = 'l'\nkind = 'rs232'\nimpedance = 1000\ncapacitance = 1000\n" + x13);
  read_plant("[[bus]]\nname = 'l'\nkind = 'can'\nimpedance = 1000\nterminated = true\nlength = 1000\n" +
             serial_unit("a", "mdxb", ""));
}

// P750: RS-485 and with it other ways (1053 1610 p. 80).
TEST(SerialPlan, SendersOfSetpoints) {
  for (int32_t value = -1; value <= 12; ++value)
    EXPECT_EQ(sends_setpoints(value),
              value == 1 || value == 3 || value == 4 || value == 6 || value == 7 || value == 9)
        << value;
}

class SerialFindingsOf {
 public:
  explicit SerialFindingsOf(const std::string& text) : plant_(read_plant(kSerialLines + text)) {}
  SerialFindingsOf& set(size_t station, const std::string& number, int32_t value) {
    values_[{station, number}] = value;
    return *this;
  }
  // Without the explanations: who, and the begin of each.
  std::vector<std::string> told() const {
    const auto parameter = [&](size_t station, std::string_view number) {
      const auto found = values_.find({station, std::string(number)});
      if (found != values_.end()) return found->second;
      return number == "810" ? static_cast<int32_t>(station) : number == "811" ? 101 : 0;
    };
    std::vector<std::string> out;
    for (const PlanFinding& finding : serial_findings(plant_, parameter))
      out.push_back(finding.station + "|" + finding.text + (finding.against_rule ? "" : "|no rule"));
    return out;
  }

 private:
  PlantFile plant_;
  std::map<std::pair<size_t, std::string>, int32_t> values_;
};

using SerialTold = std::vector<std::string>;
const std::string kTwoSerialUnits =
    serial_unit("a", "mdxb", "rs485 = 'r'\n") + serial_unit("b", "mdxb", "rs485 = 'r'\n");

TEST(SerialFindings, OfOneUnit) {
  const std::string kMonitor =
      "a|the keypad sends requests all the time, so P812 does not monitor the other RS-485 interface|no rule";
  const std::string keypad = serial_unit("a", "mdxb", "keypad = true\nrs485 = 'r'\n");
  EXPECT_EQ(SerialFindingsOf(keypad).set(0, "812", 1).told(), SerialTold{kMonitor});
  EXPECT_EQ(SerialFindingsOf(keypad).told(), SerialTold{});
  EXPECT_EQ(SerialFindingsOf(serial_unit("a", "mdxb", "keypad = true\n")).set(0, "812", 1).told(),
            SerialTold{});
  EXPECT_EQ(SerialFindingsOf(serial_unit("a", "mdxb", "rs485 = 'r'\n")).set(0, "812", 1).told(),
            SerialTold{});
  const std::string slave = "a|a slave of a master/slave connection (P100) must have P750 = 0";
  const std::string x13 = serial_unit("a", "mdxb", "rs485 = 'r'\n");
  for (const int32_t source : {8, 9}) {
    EXPECT_EQ(SerialFindingsOf(x13).set(0, "100", source).set(0, "750", 2).told(), SerialTold{slave});
    EXPECT_EQ(SerialFindingsOf(x13).set(0, "100", source).told(), SerialTold{});
  }
  for (const int32_t source : {0, 7, 10})
    EXPECT_EQ(SerialFindingsOf(x13).set(0, "100", source).set(0, "750", 2).told(), SerialTold{});
  const std::string needs = "a|master/slave operation over RS-485 needs X13 (key rs485)";
  const std::string group = "a|master/slave operation needs a group address P811 above 100";
  const std::string xt = serial_unit("a", "mdxb", "rs485_xt = 'r'\n");
  EXPECT_EQ(SerialFindingsOf(xt).set(0, "750", 1).told(), SerialTold{needs});
  EXPECT_EQ(SerialFindingsOf(xt).set(0, "100", 9).told(), SerialTold{needs});
  EXPECT_EQ(SerialFindingsOf(xt).set(0, "750", 2).told(), SerialTold{});
  EXPECT_EQ(SerialFindingsOf(xt).set(0, "100", 8).told(), SerialTold{});
  EXPECT_EQ(SerialFindingsOf(x13).set(0, "750", 1).set(0, "811", 100).told(), SerialTold{group});
  EXPECT_EQ(SerialFindingsOf(x13).set(0, "100", 9).set(0, "811", 100).told(), SerialTold{group});
  EXPECT_EQ(SerialFindingsOf(x13).set(0, "811", 100).told(), SerialTold{});
}

TEST(SerialFindings, OfTwoUnitsOnALine) {
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).told(), SerialTold{});
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(1, "810", 0).told(),
            SerialTold{"|r: a and b both have address P810 = 0; their answers collide"});
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(0, "750", 1).set(1, "750", 3).told(),
            SerialTold{"|r: a and b are both masters (P750)"});
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(0, "750", 1).set(1, "750", 2).told(), SerialTold{});
  const SerialTold groups = {"|r: a and b have different group addresses P811, so the slave does not follow"};
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(0, "750", 1).set(1, "100", 9).set(1, "811", 102).told(),
            groups);
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(1, "750", 1).set(0, "100", 9).set(1, "811", 102).told(),
            groups);
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(0, "750", 1).set(1, "100", 9).told(), SerialTold{});
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(0, "750", 1).set(1, "811", 102).told(), SerialTold{})
      << "no slave";
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits).set(0, "100", 9).set(1, "100", 9).set(1, "811", 102).told(),
            SerialTold{})
      << "no master";
  // Each pair of a line; those of other lines have nothing to do with each other.
  const std::string more =
      serial_unit("c", "mdxb", "rs485 = 'r'\n") + serial_unit("d", "mdxb", "rs485 = 'x'\n");
  EXPECT_EQ(
      SerialFindingsOf(kTwoSerialUnits + more).set(1, "810", 5).set(2, "810", 5).set(3, "810", 5).told(),
      SerialTold{"|r: b and c both have address P810 = 5; their answers collide"});
  EXPECT_EQ(SerialFindingsOf(kTwoSerialUnits + more).set(2, "810", 0).told(),
            SerialTold{"|r: a and c both have address P810 = 0; their answers collide"});
}

}  // namespace
}  // namespace ipos::runtime
