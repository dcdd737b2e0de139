// ipos param as a user meets it, and the memory file between two runs.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

const std::string kUnit1 = "[[station]]\nname = \"unit1\"\nunit = \"md60a\"\n";
const std::string kMemory = "nvram = \"unit1.nv\"\n";

// Of a message that quotes its line below.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n') + 1); }

class Param : public ::testing::Test {
 protected:
  Param() { plant(kUnit1 + kMemory); }
  void plant(const std::string& text) { folder_.write("plant.toml", text); }
  CommandResult param(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "param");
    return run_ipos(arguments, folder_.path());
  }
  std::string get(const std::string& name) { return param({"get", "plant.toml", name}).out; }
  std::string file(const std::string& name) { return read_text(folder_.path() / name); }
  TemporaryFolder folder_;
};

TEST_F(Param, GetShowsUnitsAndNames) {
  const CommandResult result =
      param({"get", "plant.toml", "P130", "8470", "P816", "870", "H20", "P076", "16000"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "P130 Ramp t11 UP CW = 2.000 s\nP130 Ramp t11 UP CW = 2.000 s\nP816 SBus baud rate = 500 kBaud\n"
            "P870 Setpoint description PO1 = CTRL. WORD 1\nH20 = 0\nP076 Firmware basic unit = 822 609 7.16\n"
            "program word 0 = 0\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "unit1.nv")) << "reading makes no file";
}

TEST_F(Param, SetIsKept) {
  const CommandResult result =
      param({"set", "plant.toml", "P130=2.5s", "P816=250 kBaud", "H20=7", "20000=-3"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "P130 Ramp t11 UP CW = 2.500 s (was 2.000 s)\nP816 SBus baud rate = 250 kBaud (was 500 kBaud)\n"
            "H20 = 7 (was 0)\ncurve point 0 = -3 (was 0)\n");
  EXPECT_EQ(get("P130"), "P130 Ramp t11 UP CW = 2.500 s\n");
  EXPECT_EQ(get("H20"), "H20 = 7\n");
  EXPECT_EQ(get("20000"), "curve point 0 = -3\n");
  EXPECT_EQ(param({"set", "plant.toml", "P130=3 s", "--volatile"}).exit_code, 0);
  EXPECT_EQ(get("P130"), "P130 Ramp t11 UP CW = 2.500 s\n");
}

TEST_F(Param, TheRunUsesTheMemory) {
  folder_.write(
      "A.IPC",
      "#include <const.h>\ninitial long kept;\nlong seen;\nmain()\n{\n  seen = kept;\n  kept = kept + 5;\n"
      "  _Memorize(MEM_STDATA);\n}\n");
  plant(kUnit1 + kMemory + "program = \"A.IPC\"\n");
  const auto run = [&] {
    const CommandResult result =
        run_ipos({"run", "plant.toml", "--for", "20ms", "--format", "json"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(result.out);
    for (const auto& variable : report["stations"][0]["variables"])
      if (variable["name"] == "seen") return variable["value"].get<int>();
    return -1;
  };
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(run(), 5);
  EXPECT_EQ(get("H0"), "H0 = 10\n");
  param({"set", "plant.toml", "H0=100"});
  EXPECT_EQ(run(), 100);
}

TEST_F(Param, SetRefusesWhatTheUnitRefuses) {
  CommandResult result = param({"set", "plant.toml", "P130=1.005 s", "P813=64", "P003=1", "P131=2.5 s"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(
      result.err,
      "refused: P130 Ramp t11 UP CW := 1.005 s: incorrect parameter value (1.000 s..10.000 s in steps of "
      "0.100 s)\n"
      "refused: P813 SBus address := 64: parameter value too large (0..63)\n"
      "refused: P003 Actual position := 1 Inc: read access only\n");
  EXPECT_EQ(result.out, "P131 Ramp t11 DOWN CW = 2.500 s (was 2.000 s)\n") << "the others go on";
  // R parameters need controller inhibit: DI00 is low.
  plant(kUnit1 + kMemory + "[station.inputs]\nDI00 = 1\n");
  result = param({"set", "plant.toml", "P100=SBus"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "refused: P100 Setpoint source := SBus: controller inhibit required\n");
}

TEST_F(Param, WhatCannotBeReadIsWrittenNowhere) {
  const CommandResult result = param({"set", "plant.toml", "P131=2.5 s", "P130=fast", "P816=fast", "H20=x"});
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(
      contains(result.err, "P130 Ramp t11 UP CW = \"fast\": expected a number with up to 3 decimals in s"));
  EXPECT_TRUE(contains(result.err, "expected 0 = 125, 1 = 250, 2 = 500 or 3 = 1000"));
  EXPECT_TRUE(contains(result.err, "H20 = \"x\": expected a whole number"));
  EXPECT_EQ(get("P131"), "P131 Ramp t11 DOWN CW = 2.000 s\n");
}

TEST_F(Param, WithoutMemoryNothingIsKeptAndItSaysSo) {
  plant(kUnit1);
  CommandResult result = param({"set", "plant.toml", "P130=2.5s"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "nothing is kept: plant.toml:1:1: station 'unit1' has no memory file; give it one with nvram = "
            "\"unit1.nv\"\n");
  EXPECT_EQ(param({"set", "plant.toml", "P130=2.5s", "--volatile"}).exit_code, 0);
}

TEST_F(Param, WhatThePlantFileSetsIsChangedThere) {
  plant(kUnit1 + kMemory + "[station.parameters]\nP130 = \"1.5 s\"\n8471 = 1500\n");
  EXPECT_EQ(get("P130") + get("P131"), "P130 Ramp t11 UP CW = 1.500 s\nP131 Ramp t11 DOWN CW = 1.500 s\n");
  const CommandResult result = param({"set", "plant.toml", "P130=2.5s", "P132=2.5s"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "plant.toml:6:1: the plant file sets P130 at every start; change it there\n");
  EXPECT_EQ(get("P130"), "P130 Ramp t11 UP CW = 1.500 s\n");
  EXPECT_EQ(get("P132"), "P132 Ramp t11 up CCW = 2.500 s\n");
}

TEST_F(Param, TextsInThePlantFileAreLocated) {
  const auto error = [&](const std::string& line) {
    plant(kUnit1 + "[station.parameters]\n" + line + "\n");
    const CommandResult result = param({"get", "plant.toml", "P130"});
    EXPECT_EQ(result.exit_code, 65);
    return first_line(result.err);
  };
  EXPECT_EQ(error("P130 = \"fast\""),
            "plant.toml:5:8: error: P130 Ramp t11 UP CW = \"fast\": expected a number with up to 3 decimals "
            "in s\n");
  EXPECT_TRUE(contains(error("P816 = \"9600 baud\""), "plant.toml:5:8: error: P816 SBus baud rate"));
  EXPECT_EQ(
      error("P130 = \"5000 s\""),
      "plant.toml:5:1: error: station 'unit1': P130 Ramp t11 UP CW := 5000.000 s: parameter value too large "
      "(0.000 s..2000.000 s)\n");
  EXPECT_EQ(error("P999 = \"1 s\""),
            "plant.toml:5:1: error: station 'unit1': unit md60a has no parameter P999\n");
  EXPECT_TRUE(contains(error("P130 = 2.5"), "plant.toml:5:8: error: P130 must be a text as it is shown, \"2.5\", or"));
}

// Cards, firmware and analog inputs are those of the plant file, as in a run.
TEST_F(Param, ShowsWhatThePlantFileSaysOfTheUnit) {
  const std::string bus = "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n";
  const std::string card = "profibus = \"dp\"\nprofibus_address = ";
  plant(bus + "[[station]]\nname = \"m\"\nunit = \"mc31\"\noption = \"ffp31\"\n" + card + "8\n");
  EXPECT_EQ(get("P073"), "P073 Fieldbus address = 8\n");
  plant(bus + kUnit1 + "option = \"dfp\"\nfirmware = 11\n" + card + "12\n[station.analog]\nAI1 = \"5 V\"\n");
  EXPECT_TRUE(contains(get("P093"), "= 12\n")) << get("P093");
  EXPECT_TRUE(contains(get("P020"), "= 5.000 V\n")) << get("P020");
  EXPECT_TRUE(contains(get("P076"), "= 822 609 7.11\n")) << get("P076");
}

TEST_F(Param, ListGroupsAndChanges) {
  param({"set", "plant.toml", "P130=2.5s"});
  EXPECT_EQ(param({"list", "plant.toml", "--changed"}).out,
            "P130  8470  Ramp t11 UP CW  2.500 s  (factory setting 2.000 s)\n");
  EXPECT_EQ(param({"list", "plant.toml", "--group", "P80"}).out,
            "P802  8594  Factory setting       NO\nP803  8595  Parameter lock        OFF\n"
            "P804  8596  Reset statistic data  NO\n");
  EXPECT_EQ(param({"list", "--unit", "mc07", "--group", "P81", "--long"}).out,
            "number  index  access  name                  value      default    minimum    maximum\n"
            "P810    8597   N/RW    RS485 address         0          0          0          99\n"
            "P811    8598   N/RW    RS-485 group address  100        100        100        199\n"
            "P812    8599   N/RW    RS485 timeout delay   0.000 s    0.000 s    0.000 s    650.000 s\n"
            "P813    8600   N/RW    SBus address          0          0          0          63\n"
            "P814    8601   N/RW    SBus group address    0          0          0          63\n"
            "P815    8602   N/RW    SBus timeout delay    0.000 s    0.000 s    0.000 s    650.000 s\n"
            "P816    8603   N/RW    SBus baud rate        500 kBaud  500 kBaud  125 kBaud  1000 kBaud\n");
}

TEST_F(Param, ListAsJson) {
  const auto json = nlohmann::json::parse(
      param({"list", "--unit", "md60a", "--group", "P816", "--long", "--format", "json"}).out);
  EXPECT_EQ(json["unit"], "md60a");
  EXPECT_EQ(json["parameters"], (nlohmann::json::array({{{"number", "P816"},
                                                         {"index", 8603},
                                                         {"name", "SBus baud rate"},
                                                         {"value", 2},
                                                         {"text", "500 kBaud"},
                                                         {"default", 2},
                                                         {"minimum", 0},
                                                         {"maximum", 3},
                                                         {"access", "N/RW"}}})));
  // Every parameter with an index is listed, also on units without limits to read.
  for (const auto& [unit, rows] : {std::pair{"md60a", 393}, {"mc07", 124}}) {
    const CommandResult all = param({"list", "--unit", unit, "--long", "--format", "json"});
    EXPECT_EQ(all.exit_code, 0) << all.err;
    EXPECT_EQ(nlohmann::json::parse(all.out)["parameters"].size(), static_cast<size_t>(rows)) << unit;
  }
}

TEST_F(Param, SaveLoadAndDiff) {
  param({"set", "plant.toml", "P130=2.5s", "P816=250 kBaud", "P852=km/h"});
  CommandResult result = param({"save", "plant.toml", "a.settings"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "232 parameters of unit1 of plant.toml in a.settings\n");
  EXPECT_TRUE(
      contains(file("a.settings"),
               "  { number = \"P130\", index = 8470, name = \"Ramp t11 UP CW\", value = \"2.500 s\", raw = "
               "2500 },\n"));
  ASSERT_EQ(param({"save", "--unit", "md60a", "b.settings"}).exit_code, 0);
  result = param({"diff", "b.settings", "a.settings"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out,
            "number  index  name            b.settings  a.settings\n"
            "P130    8470   Ramp t11 UP CW  2.000 s     2.500 s\n"
            "P816    8603   SBus baud rate  500 kBaud   250 kBaud\n"
            "P852    8772   User dimension  1/mi        km/h\n");
  EXPECT_EQ(param({"diff", "a.settings", "plant.toml:unit1"}).exit_code, 0);
  EXPECT_EQ(param({"diff", "plant.toml", "plant.toml"}).out, "");

  result = param({"load", "plant.toml", "b.settings"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "unit1 of plant.toml: 232 parameters: 3 written, 229 unchanged, 0 refused\n");
  EXPECT_EQ(param({"diff", "b.settings", "plant.toml"}).exit_code, 0);
  // The file of a loaded unit is the same to the byte.
  param({"load", "plant.toml", "a.settings"});
  param({"save", "plant.toml", "c.settings"});
  EXPECT_EQ(file("a.settings"), file("c.settings"));
  EXPECT_EQ(param({"save", "plant.toml", "-"}).out, file("a.settings"));
  const auto json =
      nlohmann::json::parse(param({"diff", "b.settings", "a.settings", "--format", "json"}).out);
  EXPECT_EQ(json["differences"][0], (nlohmann::json{{"number", "P130"},
                                                    {"index", 8470},
                                                    {"name", "Ramp t11 UP CW"},
                                                    {"a", "2.000 s"},
                                                    {"b", "2.500 s"}}));
}

// A lock that is on comes off first and is on again at the end; refused rows do not keep the others.
TEST_F(Param, LoadUnderLockAndWithoutInhibit) {
  param({"set", "plant.toml", "P803=ON"});
  EXPECT_EQ(param({"set", "plant.toml", "P130=2.5s"}).exit_code, 1);
  const std::string head = "ipos-parameters = 1\nunit = \"md60a\"\nparameters = [\n";
  folder_.write(
      "a.settings",
      head + "{ number = \"P803\", value = \"ON\" },\n{ number = \"P130\", value = \"2.5 s\" },\n]\n");
  CommandResult result = param({"load", "plant.toml", "a.settings"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(get("P130") + get("P803"), "P130 Ramp t11 UP CW = 2.500 s\nP803 Parameter lock = ON\n");
  folder_.write("a.settings", head + "{ number = \"P130\", value = \"2 s\" }\n]\n");
  EXPECT_EQ(param({"load", "plant.toml", "a.settings"}).exit_code, 0);
  EXPECT_EQ(get("P130") + get("P803"), "P130 Ramp t11 UP CW = 2.000 s\nP803 Parameter lock = ON\n");
  plant(kUnit1 + kMemory + "[station.inputs]\nDI00 = 1\n");
  folder_.write("a.settings", head +
                                  "{ number = \"P100\", value = \"SBus\" },\n{ index = 8470, raw = 3000 },\n"
                                  "{ index = 8600, raw = 99 }\n]\n");
  result = param({"load", "plant.toml", "a.settings"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "a.settings:4:1: refused: P100 Setpoint source := SBus: controller inhibit required\n"
            "a.settings:6:1: refused: P813 SBus address := 99: parameter value too large (0..63)\n");
  EXPECT_EQ(get("P130") + get("P803"), "P130 Ramp t11 UP CW = 3.000 s\nP803 Parameter lock = ON\n");
}

TEST_F(Param, ErrorsOfASettingsFileAreLocated) {
  const auto error = [&](const std::string& text) {
    folder_.write("a.settings", text);
    const CommandResult result = param({"load", "plant.toml", "a.settings"});
    EXPECT_EQ(result.exit_code, 65) << text;
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  const std::string head = "ipos-parameters = 1\nunit = \"md60a\"\nparameters = [\n";
  EXPECT_EQ(error("unit = \"md60a\"\n"),
            "a.settings:1:1: error: no parameter set: it begins with ipos-parameters = 1\n");
  EXPECT_TRUE(
      contains(error("ipos-parameters = 1\nunit = \"md90\"\n"), "a.settings:2:8: error: unit must name"));
  EXPECT_TRUE(contains(error("ipos-parameters = 1\nunit = \n"), "a.settings:2:"));
  EXPECT_TRUE(contains(error("ipos-parameters = 1\nunit = \"md60a\"\ncolour = 1\nparameters = []\n"),
                       "a.settings:3:1: error: unknown key 'colour'"));
  EXPECT_TRUE(contains(error(head + "7 ]\n"), "a.settings:4:1: error: write { number"));
  EXPECT_TRUE(contains(error(head + "{ number = \"P130\", raw = 1, unit = \"s\" } ]\n"),
                       "a.settings:4:29: error: unknown"));
  EXPECT_TRUE(contains(error(head + "{ number = 130, raw = 1 } ]\n"),
                       "a.settings:4:12: error: number must be a text"));
  EXPECT_TRUE(contains(error(head + "{ number = \"P1300\", raw = 1 } ]\n"),
                       "a.settings:4:12: error: unit md60a has no"));
  EXPECT_TRUE(
      contains(error(head + "{ index = 9999, raw = 1 } ]\n"), "a.settings:4:11: error: unit md60a has no"));
  EXPECT_TRUE(contains(error(head + "{ raw = 1 } ]\n"), "a.settings:4:1: error: a parameter needs a number"));
  EXPECT_TRUE(contains(error(head + "{ number = \"P130\" } ]\n"),
                       "a.settings:4:1: error: a parameter needs a value"));
  EXPECT_EQ(error(head + "{ number = \"P131\", index = 8470, raw = 2000 } ]\n"),
            "a.settings:4:12: error: index 8470 is P130, not P131\n");
  EXPECT_EQ(
      error(head + "{ number = \"P130\", value = \"2.5 s\", raw = 2000 } ]\n"),
      "a.settings:4:43: error: raw = 2000 is 2.000 s, and value says 2.5 s: change both or leave one out\n");
  EXPECT_TRUE(contains(error(head + "{ number = \"P130\", value = \"2.5 kg\" },\n{ index = 8470, raw = 1}, "
                                    "{index = 8470, raw = 2} ]\n"),
                       "a.settings:4:28: error: \"2.5 kg\""));
  EXPECT_TRUE(contains(error(head + "{ index = 8470, raw = 1},\n{index = 8470, raw = 2} ]\n"),
                       "a.settings:5:1: error: index 8470 stands in line 4 already"));
  EXPECT_TRUE(contains(error(head + "{ index = 8470, raw = 99999999999} ]\n"),
                       "a.settings:4:23: error: raw has at most 32"));
  EXPECT_TRUE(contains(error(head + "\xC2\xB9 ]\n"), "a.settings:4:1: error: this character"));
  EXPECT_TRUE(contains(error("ipos-parameters = 1\nunit = \"mc07\"\nparameters = []\n"), "is of unit mc07"));
}

TEST_F(Param, UsageAndInput) {
  EXPECT_EQ(param({}).exit_code, 64);
  EXPECT_EQ(param({"get", "P130"}).exit_code, 64);
  EXPECT_EQ(param({"get", "plant.toml"}).exit_code, 64);
  EXPECT_EQ(param({"set", "plant.toml", "P130"}).exit_code, 64);
  EXPECT_EQ(param({"list", "plant.toml", "--unit", "md60a"}).exit_code, 64);
  EXPECT_EQ(param({"list", "plant.toml", "P130"}).exit_code, 64);
  EXPECT_EQ(param({"save", "plant.toml"}).exit_code, 64);
  EXPECT_EQ(param({"diff", "plant.toml"}).exit_code, 64);
  EXPECT_EQ(param({"get", "plant.toml", "--station", "unit2", "P130"}).exit_code, 64);
  EXPECT_EQ(param({"get", "nowhere.toml", "P130"}).exit_code, 66);
  EXPECT_EQ(param({"load", "plant.toml", "nowhere.settings"}).exit_code, 66);
  EXPECT_EQ(param({"save", "plant.toml", "/nowhere/a.settings"}).exit_code, 74);
  EXPECT_EQ(param({"get", "plant.toml", "P1300"}).exit_code, 65);
  EXPECT_EQ(param({"get", "plant.toml", "H512"}).exit_code, 65);
  EXPECT_EQ(param({"get", "plant.toml", "9500"}).exit_code, 1) << "the unit's answer";
  plant(kUnit1 + "[[station]]\nname = \"unit2\"\nunit = \"mc07\"\n");
  const CommandResult result = param({"get", "plant.toml", "P130"});
  EXPECT_EQ(result.exit_code, 64);
  EXPECT_TRUE(contains(result.err, "choose one of unit1, unit2")) << result.err;
  EXPECT_EQ(param({"get", "plant.toml", "--station", "unit2", "P130"}).exit_code, 0);
  for (const std::string verb : {"list", "get", "set", "save", "load", "diff"})
    EXPECT_TRUE(contains(param({verb, "--help"}).out, "Example:\n  ipos param " + verb)) << verb;
}

TEST_F(Param, MemoryFilesThatCannotBeUsed) {
  plant(kUnit1 + "nvram = \"/nowhere/unit1.nv\"\n");
  CommandResult result = run_ipos({"run", "plant.toml", "--for", "1ms"}, folder_.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_EQ(first_line(result.err), "ipos: warning: plant.toml:4:9: the memory of 'unit1' is outside of the folder of the "
                                    "plant: /nowhere/unit1.nv\n");
  EXPECT_TRUE(contains(result.err, "\nplant.toml:4:9: error: station 'unit1': /nowhere/unit1.nv cannot be used: No such file or "
                                   "directory\n"))
      << result.err;
  plant(kUnit1 + kMemory + "[[station]]\nname = \"unit2\"\nunit = \"mc07\"\n" + kMemory);
  result = run_ipos({"run", "plant.toml", "--for", "1ms"}, folder_.path());
  EXPECT_EQ(first_line(result.err), "plant.toml:8:9: error: two stations keep their memory in 'unit1.nv'\n");

  plant(kUnit1 + kMemory);
  param({"set", "plant.toml", "P130=2.5s"});
  plant("[[station]]\nname = \"unit1\"\nunit = \"mc07\"\n" + kMemory);
  const std::string before = file("unit1.nv");
  result = run_ipos({"run", "plant.toml", "--for", "1ms"}, folder_.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_EQ(first_line(result.err),
            "plant.toml:4:9: error: station 'unit1': unit1.nv: the memory of unit type 1\n");
  EXPECT_EQ(param({"get", "plant.toml", "P803"}).exit_code, 65);
  EXPECT_EQ(file("unit1.nv"), before);

  plant(kUnit1 + kMemory);
  const int held = open((folder_.path() / "unit1.nv").c_str(), O_RDWR);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  EXPECT_EQ(param({"get", "plant.toml", "P130"}).exit_code, 0) << "looking does not disturb a run";
  EXPECT_EQ(param({"set", "plant.toml", "P130=2.6s"}).exit_code, 74);
  close(held);

  // A file of somebody else, text or zeros, is never overwritten.
  for (const std::string& notes : {std::string("this is no memory file, but somebody's notes"),
                                   std::string("IP"), std::string(20, '\0'), std::string(300'000, '\0')}) {
    folder_.write("unit1.nv", notes);
    result = run_ipos({"run", "plant.toml", "--for", "1ms"}, folder_.path());
    if (notes == "IP") {  // the power was cut while it was made
      EXPECT_EQ(result.exit_code, 0) << result.err;
      continue;
    }
    EXPECT_EQ(result.exit_code, 65) << notes.size();
    EXPECT_EQ(first_line(result.err),
              "plant.toml:4:9: error: station 'unit1': unit1.nv: this is no memory of a unit, and is left as "
              "it is\n");
    EXPECT_EQ(param({"set", "plant.toml", "P130=2.5s"}).exit_code, 65);
    EXPECT_EQ(file("unit1.nv"), notes);
  }
}

TEST_F(Param, VerbsThatLookLeaveTheMemoryAlone) {
  folder_.write("A.IPC", "#include <const.h>\nmain()\n{\n    _Memorize(MEM_STALL);\n}\n");
  folder_.write("can.log", "(1.000000) can0 400#5566778800000000\n");
  plant("[[bus]]\nname = \"sbus\"\nkind = \"can\"\n" + kUnit1 + "program = \"A.IPC\"\nsbus = \"sbus\"\n" +
        kMemory);
  const std::vector<std::vector<std::string>> looks = {
      {"bus", "plan", "plant.toml"},
      {"bus", "dbc", "plant.toml"},
      {"bus", "dissector", "plant.toml"},
      {"bus", "decode", "can.log", "--names", "plant.toml"},
      {"bus", "monitor", "can.log", "--plant", "plant.toml"},
      {"bus", "replay", "can.log", "plant.toml"},
      {"watch", "plant.toml", "unit1", "P000", "--count", "1"},
      {"debug", "plant.toml", "--for", "1ms"},
      {"param", "list", "plant.toml"},
      {"param", "get", "plant.toml", "P130"},
      {"param", "save", "plant.toml", "unit1.settings"},
      {"param", "diff", "plant.toml", "plant.toml"}};
  const auto look = [&](const std::string& when) {
    for (const auto& arguments : looks) {
      const CommandResult result = run_ipos(arguments, folder_.path());
      EXPECT_EQ(result.exit_code, 0) << when << ": " << arguments[0] << " " << arguments[1] << result.err;
    }
  };
  look("none");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "unit1.nv"));
  param({"set", "plant.toml", "P130=2.5s"});
  const std::string before = file("unit1.nv");
  const int held = open((folder_.path() / "unit1.nv").c_str(), O_RDWR);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  look("beside a run");
  close(held);
  EXPECT_EQ(file("unit1.nv"), before);
}

}  // namespace
}  // namespace ipos::tests
