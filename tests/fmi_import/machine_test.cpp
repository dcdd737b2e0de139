// What a machine gives: compared with closed forms, between the versions of FMI, with --no-skip, and on the way back.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/fmi_import/folder.hpp"
#include "tests/harness/contains.hpp"
#include "tests/realbus/script.hpp"

namespace ipos::tests {
namespace {

// A station without a program; a constant torque of 100 Nm stands in its H310 from the beginning.
std::string pulled(const std::string& fmu, const std::string& more = "") {
  return fmt::format(R"([[station]]
name = "u"
unit = "md60a"
[[stimulus]]
station = "u"
at = "0ms"
variable = "H310"
set = 100
[[machine]]
name = "spring"
fmu = "{}"
{}
[machine.inputs]
torque = "u.H310"
[machine.outputs]
speed = "u.H300"
"load.speed" = "u.H301"
)",
                     fmu, more);
}

// J1 w1' = T - c phi, J2 w2' = c phi, phi' = w1 - w2, at rest at 0: the mean acceleration, and an oscillation.
double closed_form(double t, bool load) {
  constexpr double kTorque = 100, kJ1 = 0.01, kJ2 = 0.02, kStiffness = 100, kBoth = kJ1 + kJ2;
  const double w = std::sqrt(kStiffness * kBoth / (kJ1 * kJ2));
  const double swing = std::sin(w * t) / w;
  return kTorque / kBoth * (load ? t - swing : t + kJ2 / kJ1 * swing);
}

TEST(FmuMachine, TwoMassesFollowTheirClosedFormInBothVersions) {
  const FmuFolder folder;
  for (const char* fmu : {"spring2.fmu", "spring3.fmu"}) {
    folder.write("p.toml", pulled(fmu));
    const auto rows = traced(folder, "p.toml", "u.H300,u.H301", "300ms");
    ASSERT_GE(rows.size(), 300U);
    for (const auto& row : rows) {
      ASSERT_EQ(row.size(), 3U);
      const double t = row[0] / 1000;
      EXPECT_NEAR(row[1], closed_form(t, false), 0.501) << fmu << " " << t;  // H variables are whole numbers
      EXPECT_NEAR(row[2], closed_form(t, true), 0.501) << fmu << " " << t;
    }
  }
}

// Whatever the step, the torque is constant, so the curve at its ends is the same.
TEST(FmuMachine, StepsOfSeveralMillisecondsComeAtTheirTime) {
  const FmuFolder folder;
  folder.write("p.toml", pulled("spring2.fmu", "every = \"7ms\""));
  const auto rows = traced(folder, "p.toml", "u.H300,u.H301", "200ms");
  for (const auto& row : rows) {
    const double at = std::floor(row[0] / 7 + 1e-6) * 0.007;
    EXPECT_NEAR(row[1], closed_form(at, false), 0.501) << row[0];
  }
}

std::string hash_of(const FmuFolder& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{"run", "p.toml", "--for", "500ms", "--allow-fmu", "--trace-hash"};
  words.insert(words.end(), more.begin(), more.end());
  const CommandResult result = folder.run(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const size_t at = result.err.find("trace hash ");
  return at == std::string::npos ? "" : result.err.substr(at, 27);
}

TEST(FmuMachine, TheHashIsTheSameEachTimeAndWithoutSkipping) {
  const FmuFolder folder;
  folder.write("p.toml", pulled("spring3.fmu"));
  const std::string first = hash_of(folder);
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(hash_of(folder), first);
  EXPECT_EQ(hash_of(folder, {"--no-skip"}), first);
  // What the machine gives is in it: nothing else of the plant moves.
  folder.write("p.toml", pulled("spring3.fmu", "[machine.parameters]\nstiffness = 101"));
  EXPECT_NE(hash_of(folder), first);
}

TEST(FmuMachine, ParametersAreSetBeforeItBegins) {
  const FmuFolder folder;
  folder.write("p.toml", pulled("spring2.fmu", "[machine.parameters]\nJ1 = 0.02\nJ2 = 0.04\nstiffness = 200"));
  const auto rows = traced(folder, "p.toml", "u.H300", "100ms");
  for (const auto& row : rows) EXPECT_NEAR(row[1], closed_form(row[0] / 1000, false) / 2, 0.501);
}

double rad_per_s(double rpm) { return rpm * 2 * 3.14159265358979 / 60; }

TEST(FmuMachine, ADriveAndTwoMassesAreStableAndKeepTheirEnergy) {
  constexpr double kRated = 1500 / (1400 * 2 * 3.14159265358979 / 60), kBoth = 0.01 + 0.02;
  const FmuFolder folder;
  for (const char* fmu : {"spring2.fmu", "spring3.fmu"}) {
    folder.write("p.toml", fmt::format(kDriven, fmu));
    const auto rows = traced(folder, "p.toml", "u.torque,u.shaft_speed,u.H300,u.setpoint", "5s");
    ASSERT_GE(rows.size(), 5000U);
    double work = 0;
    for (size_t n = 1; n < rows.size(); ++n) {
      const double speed = (rad_per_s(rows[n - 1][2]) + rad_per_s(rows[n][2])) / 2;
      work += rows[n - 1][1] / 100 * kRated * speed * 0.001;
      const double stored = rows[n][3];
      if (stored < 100) continue;
      EXPECT_NEAR(work, stored, 0.01 * stored + 1) << fmu << " " << rows[n][0];
    }
    // At the end it turns as it was told, both masses alike.
    const auto& last = rows.back();
    EXPECT_GT(last[4], 1000) << "it was not enabled";
    EXPECT_NEAR(last[2], last[4], 0.5);
    const double speed = rad_per_s(last[4]);
    EXPECT_NEAR(last[3], kBoth * speed * speed / 2, 0.01 * kBoth * speed * speed / 2);
  }
}

TEST(FmuMachine, ADrivenShaftIsTheSameWithoutSkipping) {
  const FmuFolder folder;
  folder.write("p.toml", fmt::format(kDriven, "spring3.fmu"));
  const std::string first = hash_of(folder);
  EXPECT_EQ(hash_of(folder, {"--no-skip"}), first);
  EXPECT_EQ(hash_of(folder, {"--trace-hash=1ms"}), hash_of(folder, {"--trace-hash=1ms", "--no-skip"}));
}

// The wheel adds up the speed that it was given in rpm to degrees; ipos has that speed in rad/s.
TEST(FmuMachine, UnitsAreConverted) {
  const FmuFolder folder;
  std::string plant = fmt::format(kDriven, "spring2.fmu");
  plant += R"([[machine]]
name = "wheel"
fmu = "trouble.fmu"
[machine.inputs]
speed = "u.shaft_speed"
[machine.outputs]
angle = "u.H302"
on = "u.DI05"
)";
  folder.write("p.toml", plant);
  const auto rows = traced(folder, "p.toml", "u.shaft_speed,u.H302,u.DI05,u.shaft_angle", "1s");
  double turned = 0;
  for (size_t n = 0; n + 1 < rows.size(); ++n) {
    turned += rows[n][1] * 6 * 0.001;  // what was at the end of the step's last millisecond
    EXPECT_NEAR(rows[n + 1][2], turned, 0.51 + 1e-3 * turned);
    if (std::abs(turned - 90) < 1) continue;
    EXPECT_EQ(rows[n + 1][3], turned >= 90 ? 1 : 0) << turned;
  }
  EXPECT_GT(turned, 360);
}

TEST(FmuMachine, WhatDoesNotFitIsAnErrorAtItsPlace) {
  const FmuFolder folder;
  const std::string head = "[[station]]\nname = \"u\"\nunit = \"md60a\"\n[[machine]]\nname = \"w\"\nfmu = \"trouble.fmu\"\n";
  const std::pair<std::string, std::string> rows[] = {
      {"[machine.outputs]\nangle = \"u.AI1\"\n", "p.toml:8:9: error: machine 'w': angle is in deg, and u.AI1 in V"},
      {"[machine.outputs]\nnone = \"u.AI1\"\n",
       "p.toml:8:8: error: machine 'w': the FMU has no variable 'none'; it has the outputs count, angle, on, plain, far"},
      {"[machine.outputs]\nspeed = \"u.AI1\"\n", "p.toml:8:9: error: machine 'w': 'speed' is no output of the FMU but input; it has the outputs count"},
      {"[machine.inputs]\nangle = \"u.AI1\"\n", "p.toml:8:9: error: machine 'w': 'angle' is no input of the FMU but output; it has the inputs speed, given"},
      {"[machine.outputs]\ntext = \"u.H300\"\n", "p.toml:8:8: error: machine 'w': 'text' is no number"},
      {"[machine.outputs]\nfar = \"u.AI1\"\n", "p.toml:8:7: error: machine 'w': the unit of 'far' has no base unit, so nothing can be converted into it"},
      {"[machine.outputs]\nangle = \"u.position\"\n", "p.toml:8:9: error: machine 'w': u.position can only be read"},
      {"[machine.outputs]\nangle = \"x.H300\"\n", "p.toml:8:9: error: machine 'w': "},
      {"[machine.outputs]\nangle = \"u.H*\"\n", "p.toml:8:9: error: machine 'w': 'u.H*' is a pattern; write one signal"},
      {"[machine.outputs]\nangle = \"u.H300\"\ncount = \"u.H300\"\n", "p.toml:9:9: error: u.H300 is given by machine 'w' already"},
      {"[machine.outputs]\nangle = 5\n", "p.toml:8:9: error: write \"angle\" = \"STATION.SIGNAL\""},
      {"[machine.outputs]\non = \"u.DI03\"\n[[wire]]\nfrom = \"u.DO01\"\nto = \"u.DI03\"\n", "p.toml:8:6: error: DI03 of u has a wire or switch already"},
      {"[machine.outputs]\non = \"u.DI03\"\n[[stimulus]]\nstation = \"u\"\nat = \"1s\"\ninput = \"DI03\"\nset = true\n",
       "p.toml:9:1: error: DI03 of u hangs on a machine: force it, do not set it"},
      {"[machine.parameters]\nwhat = 1.5\n", "p.toml:8:8: error: machine 'w': what takes whole numbers"},
      {"[machine.parameters]\nwhat = \"1\"\n", "p.toml:8:8: error: what must be a number, true or false"},
      {"[machine.parameters]\nspeed = 1\n", "p.toml:8:9: error: machine 'w': 'speed' is no parameter of the FMU but input; it has the parameters what"},
      {"every = \"1.5ms\"\n", "p.toml:7:9: error: every is whole milliseconds, 1 ms to 1 s"},
      {"every = 5\n", "p.toml:7:9: error: "},
      {"limit = \"0ms\"\n", "p.toml:7:9: error: limit is whole milliseconds, 1 ms to 3600 s"},
      {"speed = 5\n", "p.toml:7:1: error: unknown key 'speed' in [[machine]]; known are name, fmu, every, limit, inputs, outputs, parameters"},
      {"[[machine]]\nname = \"w\"\nfmu = \"trouble.fmu\"\n", "p.toml:7:1: error: there are two of machine 'w'"},
      {"[[machine]]\nname = \"u\"\nfmu = \"trouble.fmu\"\n", "p.toml:8:8: error: 'u' is the name of a station"},
      {"[[machine]]\nname = \"v\"\n", "p.toml:7:1: error: a [[machine]] needs fmu = \"...\""},
      {"[[machine]]\nname = \"v\"\nfmu = \"none.fmu\"\n", "p.toml:9:7: error: machine 'v': none.fmu: "},
      {"[[machine]]\nname = \"v\"\nfmu = \"p.toml\"\n", "p.toml:9:7: error: machine 'v': p.toml: is no zip archive"},
  };
  for (const auto& [text, error] : rows) {
    folder.write("p.toml", head + text);
    const CommandResult result = folder.run({"run", "p.toml", "--for", "1ms", "--allow-fmu"});
    EXPECT_EQ(result.exit_code, 65) << text << result.err;
    EXPECT_TRUE(contains(result.err, error)) << error << "\n" << result.err;
  }
}

std::string debugged(const FmuFolder& folder, const std::string& script, const std::string& options = "") {
  folder.write("script", script);
  const ScriptResult result = run_script(
      {"/bin/sh", "-c", fmt::format("cd '{}' && exec 2>&1; '{}' debug --allow-fmu {} p.toml < script", folder.path().string(), ipos_program(), options)});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  return result.output;
}

// The same session with copies of the process, which share the process of the FMU, and running again from 0 s.
TEST(FmuMachine, TimeGoesBackAndOnAsIfNobodyHad) {
  const FmuFolder folder;
  folder.write("MAIN.IPC", "main()\n{\n  while (1) _Wait(5);\n}\n");
  const std::string script =
      "until 2s\np H300\nwatch H301 if H301 < 3000\nrc\np now\np H300\np H301\nd\nuntil 1.5s\np H300\np H301\n"
      "until 3s\np H300\np H301\nquit\n";
  for (const char* fmu : {"spring2.fmu", "spring3.fmu"}) {
    std::string plant = pulled(fmu);
    plant.insert(plant.find("[[stimulus]]"), "program = \"MAIN.IPC\"\n");
    folder.write("p.toml", plant);
    const std::string back = debugged(folder, script);
    EXPECT_TRUE(contains(back, fmt::format("H300 = {:.0f}", closed_form(3, false)))) << back;
    EXPECT_TRUE(contains(back, fmt::format("H301 = {:.0f}", closed_form(1.5, true)))) << back;
    EXPECT_EQ(debugged(folder, script, "--no-snapshots"), back);
    EXPECT_FALSE(contains(back, "running again")) << back;
  }
}

TEST(FmuMachine, AnFmuWithoutAStateRunsAgainAndSaysSo) {
  const FmuFolder folder;
  folder.write_trouble(0);
  folder.write("MAIN.IPC", "main()\n{\n  while (1) _Wait(5);\n}\n");
  std::string plant = read_text(folder.path() / "p.toml");
  plant.insert(plant.find("[[machine]]"), "program = \"MAIN.IPC\"\n");
  folder.write("p.toml", plant);
  const std::string back =
      debugged(folder, "until 2s\np H300\nwatch H300 if H300 == 700\nrc\np now\np H300\nd\nuntil 3s\np H300\nquit\n");
  EXPECT_TRUE(contains(back, "H300 = 2000\n")) << back;
  EXPECT_TRUE(contains(back, "now = 700\n") || contains(back, "now = 699\n")) << back;
  EXPECT_TRUE(contains(back, "H300 = 3000\n")) << back;
}

}  // namespace
}  // namespace ipos::tests
