// What acts on stations from outside: stimuli at their time, wires, switches at the axis. And the names of
// inputs and outputs in programs.
#include <gtest/gtest.h>

#include "runtime/signals/variables.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::make_plant;
using tests::make_station;
using tests::ms;
using tests::told;
using tests::value;

// The milliseconds, below `end`, in whose tick `name` has another value than before.
std::vector<std::pair<int64_t, int32_t>> changes(Plant& plant, const std::string& name, int64_t end,
                                                 const std::string& station = "u") {
  std::vector<std::pair<int64_t, int32_t>> out;
  int32_t last = 0;
  for (int64_t at = 0; at < end; ++at) {
    plant.run_until(ms(at));
    if (at == 0) plant.run_until(1);
    if (const int32_t now = value(plant, name, station); now != last) out.emplace_back(at, last = now);
  }
  return out;
}

using Changes = std::vector<std::pair<int64_t, int32_t>>;
const char* const kIdle = "#include <constb.h>\nlong x; main() { while (1) ; }\n";

TEST(Stimuli, SetForceReleasePulseOfAnInput) {
  const auto plant = make_station(kIdle, R"(
[station.inputs]
DI01 = 1
[[stimulus]]
station = "u"
at = "10ms"
input = "DI03"
set = 1
[[stimulus]]
station = "u"
at = "20ms"
input = "DI03"
force = false
[[stimulus]]
station = "u"
at = "25ms"          # acts when the force ends
input = "DI03"
set = 1
[[stimulus]]
station = "u"
at = "30ms"
input = "DI03"
release = true
[[stimulus]]
station = "u"
at = "40ms"
input = "DI03"
pulse = 0
for = "5ms"
[[stimulus]]
station = "u"
at = "49500us"       # the next tick is at 50 ms
input = "DI03"
set = 0
)");
  EXPECT_EQ(changes(*plant, "H483", 60),
            (Changes{{0, 2}, {10, 10}, {20, 2}, {30, 10}, {40, 2}, {45, 10}, {50, 2}}));
}

TEST(Stimuli, Repeat) {
  const auto plant = make_station(kIdle, R"(
[[stimulus]]
station = "u"
at = "5ms"
input = "DI00"
pulse = 1
for = "2ms"
every = "10ms"
times = 3
)");
  EXPECT_EQ(changes(*plant, "H483", 60), (Changes{{5, 1}, {7, 0}, {15, 1}, {17, 0}, {25, 1}, {27, 0}}));
}

TEST(Stimuli, OfVariablesAndParameters) {
  const auto plant = make_station(R"(#include <constb.h>
long x, y; main() { while (1) y = x; }
)",
                                  R"(
[[stimulus]]
station = "u"
at = "10ms"
variable = "x"
set = 5
[[stimulus]]
station = "u"
at = "20ms"
variable = "x"
pulse = 0xFFFFFFFF
for = "10ms"
[[stimulus]]
station = "u"
at = "40ms"
variable = "y"
force = 77
for = "5ms"
[[stimulus]]
station = "u"
at = "15ms"
parameter = "P160"
set = 600000
[[stimulus]]
station = "u"
at = "16ms"
parameter = "P160"
set = 600001
[[expect]]
station = "u"
at = "20ms"
parameter = "P160"
equals = 600000
)");
  EXPECT_EQ(changes(*plant, "x", 35), (Changes{{10, 5}, {20, -1}, {30, 5}}));
  ASSERT_EQ(plant->results().size(), 1U);
  EXPECT_TRUE(plant->results()[0].met);
  EXPECT_TRUE(told(*plant, "stimulus refused: ")) << "600.001 rpm is no step of P160";
  const Changes y = changes(*plant, "y", 60);
  EXPECT_EQ(y.back().second, 5) << "the program writes it all the time, held or not";
}

// As in [station.parameters]: numbers are the coding, texts what people read.
TEST(Stimuli, OfParametersWithUnits) {
  const auto plant = make_plant(R"(
[[station]]
name = "u"
unit = "mdxb"
[[stimulus]]
station = "u"
at = "5ms"
parameter = "P130"
set = "2.5 s"
[[expect]]
station = "u"
at = "10ms"
parameter = "P130"
equals = "2500 ms"
[[expect]]
station = "u"
at = "2ms"
parameter = "P884"
equals = "500 kBaud"
)");
  ASSERT_NE(plant, nullptr);
  plant->run_until(ms(11));
  ASSERT_EQ(plant->results().size(), 2U);
  for (const auto& result : plant->results()) EXPECT_TRUE(result.met) << result.actual;
  const auto wrong = runtime::read_plant_file(
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\n"
      "parameter = \"P130\"\nset = \"2.5 rpm\"\n");
  ASSERT_EQ(wrong.errors.size(), 1U);
  EXPECT_EQ(wrong.errors[0].place.line, 8U);
  EXPECT_NE(wrong.errors[0].text.find("P130 Ramp t11 UP CW = \"2.5 rpm\""), std::string::npos)
      << wrong.errors[0].text;
}

TEST(Stimuli, OfAnalogInputs) {
  const auto plant = make_station(R"(#include <constb.h>
long a[2]; main() { while (1) _GetSys(a, GS_ANINP); }
)",
                                  R"(
[station.analog]
AI1 = "1 V"
[[stimulus]]
station = "u"
at = "10ms"
analog = "AI1"
set = "-2.5 V"
[[stimulus]]
station = "u"
at = "20ms"
analog = "AI2"
pulse = "10 V"
for = "5ms"
)");
  EXPECT_EQ(changes(*plant, "a", 30), (Changes{{0, 1000}, {10, -2500}})) << "read in every even millisecond";
  EXPECT_EQ(value(*plant, "H421"), 0);
}

// A release names the terminal, not whether a voltage or a current hangs there.
TEST(Stimuli, ReleaseOfAnalogInputs) {
  const auto plant = make_station(R"(#include <constb.h>
long a[2]; main() { while (1) _GetSys(a, GS_ANINP); }
)",
                                  R"(
[station.analog]
AI2 = "1 V"
[[stimulus]]
station = "u"
at = "10ms"
analog = "AI2"
force = "5 V"
[[stimulus]]
station = "u"
at = "15ms"
analog = "AI1"       # not that one
release = true
[[stimulus]]
station = "u"
at = "20ms"
analog = "AI2"
release = true
)");
  const std::string second = "H" + std::to_string(*signals::find_variable(*plant->stations()[0], "a") + 1);
  EXPECT_EQ(changes(*plant, second, 30), (Changes{{0, 1000}, {10, 5000}, {20, 1000}}));
}

// unit1 sets DO01 and clears it, unit2 sees DI03 in the next millisecond, whichever stands first in the file.
TEST(Wires, BringTheOutputInTheNextMillisecond) {
  const char* const sender = R"(#include <iob.h>
#include <constb.h>
main() { _Wait(10); SET_DO01; _Wait(10); CLEAR_DO01; while (1) ; }
)";
  const char* const receiver = R"(#include <iob.h>
#include <constb.h>
long seen, inverted;
main() { while (1) { seen = DI03; inverted = DI10; } }
)";
  const std::string a =
      "[[station]]\nname = \"unit.1\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n[station.parameters]\nP620 = "
      "21\n";
  const std::string b = "[[station]]\nname = \"unit2\"\nunit = \"mdxb\"\nprogram = \"B.IPC\"\n";
  const std::string wires =
      "[[wire]]\nfrom = \"unit.1.DO01\"\nto = \"unit2.DI03\"\n[[wire]]\nfrom = \"unit.1.DO01\"\nto = "
      "\"unit2.DI10\"\ninvert = true\n";
  for (const std::string& text : {a + b + wires, b + a + wires}) {
    const auto plant = make_plant(text, {{"A.IPC", sender}, {"B.IPC", receiver}}, vm::Rates{{50, 50, 50}});
    // SET_DO01 in the tick at 10 ms is on the terminal in that at 11, over the wire in that at 12; CLEAR_DO01
    // in that at 20.
    EXPECT_EQ(changes(*plant, "H483", 40, "unit2"), (Changes{{0, 1 << 8}, {12, 1 << 3}, {22, 1 << 8}}));
    EXPECT_EQ(value(*plant, "inverted", "unit2"), 1);
  }
}

// An axis in rotation: the switch is closed between the positions.
TEST(Switches, FollowThePosition) {
  const char* const common = R"(
[station.parameters]
P130 = 0
P160 = 300000
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
DI04 = 1
)";
  for (const bool high : {true, false}) {
    const auto plant =
        make_station(kIdle, std::string(common) +
                                "[[switch]]\nstation = \"u\"\ninput = \"DI10\"\nfrom = 4096\nto = 8191\n" +
                                (high ? "" : "active = \"low\"\n") +
                                "[[switch]]\nstation = \"u\"\ninput = \"DI11\"\nfrom = 8192\n");
    int32_t before = 0;
    for (int64_t at = 1; at < 2000; ++at) {
      plant->run_until(ms(at));
      const int32_t levels = value(*plant, "H483");
      const bool within = before >= 4096 && before <= 8191;
      ASSERT_EQ((levels >> 8 & 1) != 0, within == high) << at;
      ASSERT_EQ((levels >> 9 & 1) != 0, before >= 8192) << at;
      before = plant->stations()[0]->drive().state().axis().position;
    }
    EXPECT_GT(before, 3 * 4096) << "the axis has turned";
  }
}

struct Wrong {
  const char* text;
  uint32_t line;
  const char* message;
};

TEST(PlantFile, RefusesWrongSurroundings) {
  const std::string station = "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n";
  const Wrong rows[] = {
      {"[[stimulus]]\nstation = \"v\"\nat = \"1ms\"\ninput = \"DI00\"\nset = 1\n", 5, "no station 'v'"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\nset = 1\n", 4,
       "one of variable, parameter, input, analog"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nvariable = \"x\"\nset = 1\n", 7,
       "either"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI08\"\nset = 1\n", 7, "'DI08' is no input"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nset = 2\n", 8, "0 or 1"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\n", 4, "set, force, pulse or release"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nset = 1\nforce = 1\n", 9,
       "either set or force"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\npulse = 1\n", 4, "a pulse needs for"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nset = 1\nfor = \"1ms\"\n", 9,
       "length"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\npulse = 1\nfor = \"10us\"\n", 9,
       "millisecond"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nset = 1\nevery = \"0ms\"\n", 9,
       "millisecond"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nset = 1\ntimes = 2\n", 9, "every"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nrelease = false\n", 8,
       "release = true"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\nanalog = \"AI3\"\nset = \"1 V\"\n", 7,
       "'AI3' is no analog"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\nanalog = \"AI1\"\nset = \"11 V\"\n", 8, "-10..10"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"soon\"\ninput = \"DI00\"\nset = 1\n", 6, "no time"},
      {"[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = \"DI00\"\nset = 1\nwidth = 1\n", 9,
       "unknown key"},
      {"[[wire]]\nfrom = \"u.DO01\"\n", 4, "needs to"},
      {"[[wire]]\nfrom = \"u.DI01\"\nto = \"u.DI02\"\n", 5, "no output of a station"},
      {"[[wire]]\nfrom = \"DO01\"\nto = \"u.DI02\"\n", 5, "no output of a station"},
      {"[[wire]]\nfrom = \"w.DO01\"\nto = \"u.DI02\"\n", 5, "no station 'w'"},
      {"[[wire]]\nfrom = \"u.DO01\"\nto = \"u.DI02\"\n[[wire]]\nfrom = \"u.DO02\"\nto = \"u.DI02\"\n", 7,
       "already"},
      {"[[wire]]\nfrom = \"u.DO01\"\nto = \"u.DI02\"\n[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\ninput = "
       "\"DI02\"\nset = 1\n",
       7, "force it"},
      {"[[switch]]\nstation = \"u\"\ninput = \"DI02\"\n", 4, "needs from, to or both"},
      {"[[switch]]\nstation = \"u\"\ninput = \"DI02\"\nfrom = 5\nto = 4\n", 8, "to is below from"},
      {"[[switch]]\nstation = \"u\"\ninput = \"DI02\"\nfrom = 5\nactive = \"up\"\n", 8,
       "\"high\" or \"low\""},
      {"[[expect]]\nstation = \"u\"\nat = \"1ms\"\noutput = \"DO09\"\nequals = 1\n", 7,
       "'DO09' is no output"},
      {"stimulus = 5\n", 0, "write [[stimulus]]"},
  };
  for (const Wrong& row : rows) {
    const bool first = row.line == 0;
    const PlantFileResult result = read_plant_file(first ? row.text + station : station + row.text);
    ASSERT_FALSE(result.errors.empty()) << row.text;
    EXPECT_NE(result.errors[0].text.find(row.message), std::string::npos)
        << row.text << "says: " << result.errors[0].text;
    EXPECT_TRUE(first || result.errors[0].place.line == row.line)
        << row.text << result.errors[0].place.line << ": " << result.errors[0].text;
  }
}

TEST(PlantFile, MissingVariablesAndParametersAreErrors) {
  const PlantFileResult file = read_plant_file(
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\nparameter = "
      "\"P999\"\nset = 1\n[[expect]]\nstation = \"u\"\nat = \"1ms\"\nvariable = \"x\"\nequals = 1\n");
  ASSERT_TRUE(file.errors.empty());
  std::vector<PlantError> errors;
  const Plant plant(file.plant, {std::nullopt}, std::nullopt, errors);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].text, "station 'u' has no parameter 'P999'");
  EXPECT_EQ(errors[0].place.line, 4U);
  EXPECT_EQ(errors[1].text, "station 'u' has no variable 'x'");
}

TEST(PlantFile, AStimulusOfASignalIsRefusedAtItsTable) {
  const std::string head = "[[station]]\nname = \"u\"\nunit = \"mdxb\"\n";
  const std::string stimulus = "[[stimulus]]\nstation = \"u\"\nat = \"1ms\"\n";
  for (const auto& [rows, message] : std::vector<std::pair<std::string, std::string>>{
           {"signal = \"speed\"\nset = 1\n", "speed of u can only be read"},
           {"signal = \"shaft_speed\"\nset = 1\n", "shaft_speed of u can only be read"},
           {"signal = \"P130\"\nset = 1\n", "P130 has a key of its own: write parameter = \"P130\""},
           {"signal = \"DI00\"\nset = 1\n", "DI00 has a key of its own: write input = \"DI00\""},
           {"signal = \"AI1\"\nset = \"5 V\"\n", "AI1 has a key of its own: write analog = \"AI1\""},
           {"signal = \"H10\"\nset = 1\n", "H10 has a key of its own: write variable = \"H10\""},
           {"signal = \"load_torque\"\nset = \"5 bar\"\n", "'5 bar' is no number"},
           {"signal = \"load_torque\"\nset = 1e9\n", "10000000000000 is out of range for a value of the drive: -2147483648..2147483647"},
           {"signal = \"nothing\"\nset = 1\n", "station 'u' has no signal 'nothing'"},
       }) {
    const PlantFileResult file = read_plant_file(head + stimulus + rows);
    ASSERT_TRUE(file.errors.empty()) << rows;
    std::vector<PlantError> errors;
    const Plant plant(file.plant, {std::nullopt}, std::nullopt, errors);
    ASSERT_EQ(errors.size(), 1U) << rows;
    EXPECT_TRUE(errors[0].text.starts_with(message)) << errors[0].text;
    EXPECT_EQ(errors[0].place.line, 4U);
  }
}

// Every name of io.h and iob.h stands for the terminal of that name.
TEST(TerminalNames, LeadToTheirTerminals) {
  for (const auto& [header, unit] : {std::pair("iob.h", "mdxb"), std::pair("io.h", "md60a")}) {
    std::vector<std::string> inputs = {"DI00", "DI01", "DI02", "DI03", "DI04", "DI05"};
    if (std::string(unit) == "mdxb") inputs.insert(inputs.end(), {"DI06", "DI07"});
    for (int n = 0; n < 8; ++n) inputs.push_back("DI1" + std::to_string(n));
    for (const std::string& name : inputs) {
      const auto plant =
          make_station("#include <" + std::string(header) + ">\nlong x, y;\nmain() { x = " + name +
                           "; y = BIT_" + name + "; }\n",
                       "[station.inputs]\n" + name + " = 1\n", unit);
      plant->run_until(ms(20));
      EXPECT_EQ(value(*plant, "x"), 1) << name;
      EXPECT_EQ(value(*plant, "y"), parse_input(name)) << name;
    }
    const std::pair<const char*, const char*> outputs[] = {
        {"DO01", "P620"}, {"DO02", "P621"}, {"DO10", "P630"}, {"DO11", "P631"}, {"DO12", "P632"},
        {"DO13", "P633"}, {"DO14", "P634"}, {"DO15", "P635"}, {"DO16", "P636"}, {"DO17", "P637"}};
    for (const auto& [name, parameter] : outputs) {
      const auto plant =
          make_station("#include <" + std::string(header) + ">\nlong x;\nmain() { SET_" + name +
                           "; x = " + name + "; _Wait(10); CLEAR_" + name + "; }\n",
                       "[station.parameters]\n" + std::string(parameter) + " = 21\n" +
                           "[[expect]]\nstation = \"u\"\nat = \"5ms\"\noutput = \"" + name +
                           "\"\nequals = 1\n[[expect]]\nstation = \"u\"\nat = \"30ms\"\noutput = \"" + name +
                           "\"\nequals = 0\n",
                       unit);
      plant->run_until(ms(31));
      EXPECT_EQ(value(*plant, "x"), 1) << name;
      for (const ExpectationResult& result : plant->results()) EXPECT_TRUE(result.met) << name;
      EXPECT_EQ(plant->results().size(), 2U);
    }
  }
}

}  // namespace
}  // namespace ipos::runtime
