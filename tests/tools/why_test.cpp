// `ipos run --why` tells the person at the machine why a drive does not run, and what it does about it.
#include <gtest/gtest.h>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

std::string told(const std::string& parameters, const std::string& inputs,
                 const std::string& unit = "md60a") {
  const TemporaryFolder folder;
  const std::string plant =
      folder.write("p.toml", "[[station]]\nname = \"u1\"\nunit = \"" + unit + "\"\n[station.parameters]\n" +
                                 parameters + "[station.inputs]\n" + inputs);
  return run_ipos({"run", plant, "--for", "500ms", "--why"}).err;
}
const std::string kEnabled = "DI00 = 1\nDI01 = 1\nDI03 = 1\n";

TEST(Why, NamesWhatBlocksTheDrive) {
  EXPECT_NE(told("", "DI01 = 1\nDI03 = 1\n").find("u1: note: not enabled: controller inhibit: DI00"),
            std::string::npos);
  EXPECT_NE(told("", "DI00 = 1\nDI03 = 1\n").find("not enabled: no input with function CW/STOP"),
            std::string::npos);
  EXPECT_NE(told("P100 = 10\n", kEnabled).find("not enabled: waiting for process data (display t)"),
            std::string::npos);
  EXPECT_EQ(told("P301 = 0\n", kEnabled).find("not enabled"), std::string::npos);
}

TEST(Why, NamesTheFaultFirst) {
  const std::string text = told("P604 = 11\n", kEnabled);
  const size_t fault = text.find("u1: fault: F26 external fault: an input with function /EXT. ERROR is 0");
  const size_t reset = text.find("u1: note: not enabled: a fault is pending: reset it by");
  EXPECT_NE(fault, std::string::npos) << text;
  EXPECT_NE(reset, std::string::npos) << text;
  EXPECT_LT(fault, reset);
  const std::string silence = told("P100 = 10\nP815 = 100\n", "DI01 = 1\nDI03 = 1\n", "mc07");
  EXPECT_NE(silence.find("u1: fault: F47 SBus timeout: no process data over the SBus within P815"),
            std::string::npos)
      << silence;
}

TEST(Why, SaysOnceThatTheMotorIsIdeal) {
  const std::string text = told("", kEnabled);
  const size_t at = text.find("u1: note: the motor is ideal");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_EQ(text.find("the motor is ideal", at + 20), std::string::npos) << text;
  const TemporaryFolder folder;
  const std::string plant = folder.write(
      "p.toml", "[[station]]\nname = \"u1\"\nunit = \"md60a\"\n[station.motor]\ntype = \"DT90L4\"\n");
  EXPECT_EQ(run_ipos({"run", plant, "--for", "10ms", "--why"}).err.find("the motor is ideal"), std::string::npos);
}

// A partner that answers in the first 100 ms after power-on: once, and not where the plant says how long a unit takes.
TEST(Why, SaysOnceThatARealPartnerTakesLonger) {
  const TemporaryFolder folder;
  folder.write("A.IPC", R"(#include <constb.h>
MOVLNK m; MLDATA d;
main() {
  m.BusType = 5; m.Address = 2; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.Index = 8321; m.DPointer = numof(d);
  _MoviLink(m); _MoviLink(m);
  while (1) { }
}
)");
  const auto told = [&](const std::string& keys) {
    const std::string plant = folder.write(
        "p.toml", "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n[[station]]\nname = \"a\"\nunit = \"mdxb\"\nsbus = "
                  "\"sbus\"\nprogram = \"A.IPC\"\n" + keys +
                      "[station.parameters]\nP881 = 1\n[[station]]\nname = \"b\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n"
                      "[station.parameters]\nP881 = 2\n");
    const std::string err = run_ipos({"run", plant, "--for", "300ms", "--why"}).err;
    size_t times = 0;
    for (size_t at = 0; (at = err.find("a real unit takes longer", at)) != std::string::npos; ++at) ++times;
    return times;
  };
  EXPECT_EQ(told(""), 1U);
  EXPECT_EQ(told("start_up = \"500ms\"\n"), 0U);
  // A program that waits for its partner.
  folder.write("A.IPC", R"(#include <constb.h>
MOVLNK m; MLDATA d;
main() {
  _Wait(150);
  m.BusType = 5; m.Address = 2; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.Index = 8321; m.DPointer = numof(d);
  _MoviLink(m);
  while (1) { }
}
)");
  EXPECT_EQ(told(""), 0U);
}

// A step, a stimulus and the station itself take the mains away.
TEST(Why, SaysThatTheMainsAreMissing) {
  const TemporaryFolder folder;
  const std::string station = "[[station]]\nname = \"u1\"\nunit = \"md60a\"\n";
  const std::string inputs = "[station.inputs]\n" + kEnabled;
  const auto why = [&](const std::string& text) {
    return run_ipos({"run", folder.write("p.toml", text), "--for", "4s", "--why"}).err;
  };
  constexpr const char* kTold = "not enabled: no mains: the DC link (P008) is too low";
  EXPECT_EQ(why(station + inputs).find(kTold), std::string::npos);
  EXPECT_NE(why(station + "mains = \"off\"\n" + inputs).find(kTold), std::string::npos);
  EXPECT_NE(why(station + inputs + "[[stimulus]]\nstation = \"u1\"\nat = \"1s\"\nmains = \"off\"\n").find(kTold), std::string::npos);
  folder.write("m.test.toml", station + inputs +
                                  "[[step]]\nat = \"1s\"\nmains = \"off\"\n[[expect]]\nstate = \"ready\"\nequals = 0\nwithin = \"3s\"\n"
                                  "[[expect]]\nsignal = \"mains\"\nequals = 0\n[[step]]\nafter = \"1s\"\nmains = \"on\"\n"
                                  "[[expect]]\nstate = \"ready\"\nequals = 1\nwithin = \"40ms\"\n");
  const CommandResult tested = run_ipos({"test", "m.test.toml"}, folder.path());
  EXPECT_EQ(tested.exit_code, 0) << tested.out;
}

// By a program in its own unit; over buses: tests/runtime/bus_plan/plan_test.cpp and rs485/slave_test.cpp.
TEST(Why, NamesARefusedWriteOfTheProgram) {
  const TemporaryFolder folder;
  const std::string program = folder.write("A.IPC", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() {
  m.BusType = 5; m.Address = 253; m.Format = ML_FT_PAR; m.Service = ML_S_WR; m.Index = 8600;
  m.DPointer = numof(d); d.WritePar = 64;
  _MoviLink(m);
}
)");
  const std::string err = run_ipos({"run", program, "--for", "50ms", "--why"}).err;
  EXPECT_NE(err.find("refused P813 SBus address := 64: parameter value too large (0..63)"), std::string::npos)
      << err;
}

TEST(Why, NamesWhatChangesTheSetpoint) {
  EXPECT_NE(told("", kEnabled).find("raised to the minimum speed (P301 or P311)"), std::string::npos);
  EXPECT_NE(told("P100 = 10\nP815 = 0\nP871 = 0\n", kEnabled).find("no PO word has the assignment SPEED"),
            std::string::npos);
}

// The table of --watch has an analog output whose parameters are not those of the factory: 5 V of H478 = 5000 (10000 a 10 V).
TEST(Watch, HasTheAnalogOutputsThatThePlantSets) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long lCount; main() { H478 = 5000; while (1) { lCount++; } }\n");
  const auto table = [&](const std::string& parameters) {
    const std::string plant = folder.write(
        "p.toml", "[[station]]\nname = \"u1\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n[station.parameters]\n" + parameters);
    return run_ipos({"run", plant, "--for", "100ms", "--watch"}).out;
  };
  EXPECT_EQ(table("").find("AO1"), std::string::npos);
  const std::string set = table("P640 = \"IPOS OUTPUT\"\n");
  EXPECT_NE(set.find("AO1"), std::string::npos) << set;
  EXPECT_NE(set.find("5.000 V"), std::string::npos) << set;
  EXPECT_EQ(set.find("AO2"), std::string::npos) << set;
}

}  // namespace
}  // namespace ipos::tests
