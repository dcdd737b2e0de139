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

}  // namespace
}  // namespace ipos::tests
