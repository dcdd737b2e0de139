// Objects that nobody of a plant receives or sends, and objects of two forms: told by `ipos run` at the place of the command, and
// by `ipos bus plan`. Where the code or the line leaves it open, nothing is told.
#include <gtest/gtest.h>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kBus = "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n";

std::string station(const std::string& name, const std::string& program, int address) {
  return "[[station]]\nname = \"" + name + "\"\nunit = \"mdxb\"\nprogram = \"" + program + "\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = " +
         std::to_string(address) + "\n";
}

// The command stands in line 6.
std::string sender(const std::string& object, int format = 8) {
  return "#include <const.h>\nSCTRCYCL Tr; long lData, lMore;\nmain()\n{\n  Tr.ObjectNo = " + object +
         "; Tr.CycleTime = 10; Tr.Format = " + std::to_string(format) +
         "; Tr.DPointer = numof(lData);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n  while (1) lData = lMore++;\n}\n";
}
std::string receiver(const std::string& object, int format = 8) {
  return "#include <const.h>\nSCREC Re; long lData, lMore;\nmain()\n{\n  Re.ObjectNo = " + object + "; Re.Format = " +
         std::to_string(format) +
         "; Re.DPointer = numof(lData);\n  _SBusCommDef(SCD_REC, Re);\n  _SBusCommOn();\n  while (1) H0 = lData + lMore;\n}\n";
}

// What `ipos run` says to standard error of two stations.
std::string told(const std::string& a, const std::string& b, const std::string& more = "", const std::string& bus = kBus) {
  const TemporaryFolder folder;
  folder.write("p.toml", bus + station("leader", "A.IPC", 1) + station("follower", "B.IPC", 2) + more);
  folder.write("A.IPC", a);
  folder.write("B.IPC", b);
  return run_ipos({"run", "p.toml", "--for", "20ms"}, folder.path()).err;
}

TEST(PlantObjects, ThatNobodyReceivesOrSends) {
  EXPECT_EQ(told(sender("1100"), receiver("1101")),
            "A.IPC:6:3: warning: nobody on sbus receives object 44Ch (1100), which leader sends here; follower expects 44Dh (1101) [B28]\n"
            "B.IPC:6:3: warning: nobody on sbus sends object 44Dh (1101), which follower expects here; leader sends 44Ch (1100) [B29]\n");
  EXPECT_EQ(told(sender("1100"), receiver("1100")), "");
  EXPECT_EQ(told(sender("1100"), "main() { while (1) H0++; }\n"),
            "A.IPC:6:3: warning: nobody on sbus receives object 44Ch (1100), which leader sends here [B28]\n");
}

TEST(PlantObjects, OfTwoFormats) {
  const std::string text = told(sender("1100", 8), receiver("1100", 4));
  EXPECT_TRUE(text.starts_with("B.IPC:6:3: warning: object 44Ch (1100) is received by follower with 4 bytes MOTOROLA, but leader sends it "
                               "with 8 bytes MOTOROLA: no telegram is taken [B12]\n"))
      << text;
}

TEST(PlantObjects, ThatMayHaveAPartner) {
  // The number is not known before the program runs.
  EXPECT_EQ(told(sender("1100"), receiver("1090 + H5")), "");
  // A master control may take it.
  EXPECT_EQ(told(sender("1100"), "main() { while (1) H0++; }\n",
                 "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\ncycle = \"10ms\"\n[[control.target]]\naddress = 1\nevery = \"10ms\"\n")
                .find("[B"),
            std::string::npos);
  // 8 * 3 + 3 is the PO of address 3 (1053 1610 p. 38), which somebody may get later.
  EXPECT_EQ(told("main() { while (1) H0++; }\n", sender("27")).find("[B"), std::string::npos);
}

TEST(PlantObjects, AreHintsOfThePlan) {
  const TemporaryFolder folder;
  folder.write("p.toml", kBus + station("leader", "A.IPC", 1) + station("follower", "B.IPC", 2));
  folder.write("A.IPC", sender("1100"));
  folder.write("B.IPC", receiver("1101"));
  const CommandResult result = run_ipos({"bus", "plan", "p.toml"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("sbus: hint: nobody on sbus receives object 44Ch (1100), which leader sends here; follower expects 44Dh (1101) "
                            "(A.IPC:6:3) [B28]\n"),
            std::string::npos)
      << result.err;
}

// Once, however many tests have the plant; and at the begin of a session of the debugger.
TEST(PlantObjects, AreToldByTestsAndTheDebugger) {
  const TemporaryFolder folder;
  folder.write("p.toml", kBus + station("leader", "A.IPC", 1) + station("follower", "B.IPC", 2));
  folder.write("A.IPC", sender("1100"));
  folder.write("B.IPC", receiver("1101"));
  folder.write("a.test.toml", "plant = \"p.toml\"\n[[expect]]\nat = \"10ms\"\nstation = \"leader\"\nvariable = \"H5\"\nequals = 0\n");
  folder.write("b.test.toml", "plant = \"p.toml\"\n[[expect]]\nat = \"10ms\"\nstation = \"leader\"\nvariable = \"H6\"\nequals = 0\n");
  const std::string a = "A.IPC:6:3: warning: nobody on sbus receives object 44Ch (1100), which leader sends here; follower expects 44Dh (1101) [B28]\n";
  const std::string b = "B.IPC:6:3: warning: nobody on sbus sends object 44Dh (1101), which follower expects here; leader sends 44Ch (1100) [B29]\n";
  const auto count = [](const std::string& text, const std::string& part) {
    size_t n = 0;
    for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++n;
    return n;
  };
  const CommandResult tests = run_ipos({"test", "."}, folder.path());
  EXPECT_EQ(tests.exit_code, 0) << tests.out << tests.err;
  for (const std::string& text : {a, b}) EXPECT_EQ(count(tests.err, text.substr(text.find("warning"))), 1U) << tests.err;
  const CommandResult session = run_ipos({"debug", "p.toml"}, folder.path());
  EXPECT_EQ(session.err, a + b);
  EXPECT_EQ(run_ipos({"debug", "a.test.toml"}, folder.path()).err, a + b);
}

TEST(PlantObjects, OfTheExamplesHaveTheirPartners) {
  for (const char* plant : {"scom/scom.toml", "scom-intel/scom-intel.toml", "sbus-line/line.toml", "campaign/campaign.toml",
                            "canopen/canopen.toml", "movitrac-b/movitrac-b.toml", "isync/isync.toml"}) {
    const CommandResult result = run_ipos({"run", project(std::string("examples/") + plant).string(), "--for", "1ms"});
    EXPECT_EQ(result.err.find("[B"), std::string::npos) << plant << "\n" << result.err;
  }
}

}  // namespace
}  // namespace ipos::tests
