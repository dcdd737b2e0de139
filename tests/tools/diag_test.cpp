// ipos diag and ipos scope at stations of plants.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/harness/contains.hpp"
#include "tests/harness/proves.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

// One drive on every bus: SBus 1 with MOVILINK, SBus 2 with CANopen, both RS-485 sockets; AI1 lets it run up.
std::string plant_text() {
  return "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[bus]]\nname = \"can\"\nkind = \"can\"\n"
         "[[bus]]\nname = \"line1\"\nkind = \"rs485\"\n"
         "[[station]]\nname = \"saw\"\nunit = \"mdxb\"\nsbus = \"sbus\"\nsbus2 = \"can\"\nrs485 = \"line1\"\n"
         "[station.parameters]\nP881 = 1\nP890 = 1\nP896 = 7\nP100 = 10\nP101 = 3\nP130 = \"2 s\"\nP301 = 0\n"
         "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n"
         "[[station]]\nname = \"caller\"\nunit = \"mdxb\"\nsbus = \"sbus\"\nprogram = \"CALL.IPC\"\n"
         "[station.parameters]\nP881 = 2\n"
         "[[control]]\nname = \"plc\"\nkind = \"canopen\"\nsbus = \"can\"\n[[control.target]]\naddress = 7\n"
         "po = [6, 5000, 0]\n";
}

constexpr const char* kCall =
    "#include <constb.h>\nMOVLNK Ml; MLDATA Mld;\nmain()\n{\n Ml.BusType = 5; Ml.Address = 1; Ml.Format = 6; "
    "Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = numof(Mld);\n while (1) { _MoviLink(Ml); _Wait(50); "
    "}\n}\n";

class Diag : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.write("CALL.IPC", kCall);
    folder_.write("plant.toml", plant_text());
  }
  CommandResult ipos(std::vector<std::string> arguments) { return run_ipos(arguments, folder_.path()); }
  TemporaryFolder folder_;
};

TEST_F(Diag, FivePages) {
  PROVES("MDB-TOC-29");
  const CommandResult all = ipos({"diag", "plant.toml", "saw", "--at", "2s"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  for (const char* page : {"saw: parameters\n", "saw: pd\n", "saw: rs485\n", "saw: can\n", "saw: fieldbus\n"})
    EXPECT_TRUE(contains(all.out, page)) << page;
  // Live: the last parameter telegram, the words of the master, the state of the node.
  EXPECT_TRUE(contains(all.out, "read 8318 Speed = 1000.000 rpm <- saw")) << all.out;
  EXPECT_TRUE(contains(all.out, "  PO2                              1388 hex\n")) << all.out;
  EXPECT_TRUE(contains(all.out, "  PI2                              1388 hex\n")) << all.out;
  EXPECT_TRUE(contains(all.out, "  PO data enabled                  yes\n")) << all.out;
  EXPECT_TRUE(contains(all.out, "SBus 1 on sbus\n")) << all.out;
  EXPECT_TRUE(contains(all.out, "SBus 2 on can\n")) << all.out;
  EXPECT_TRUE(contains(all.out, "  node                             operational\n")) << all.out;
  EXPECT_TRUE(contains(all.out, "  X13                              line1\n")) << all.out;
  EXPECT_TRUE(contains(all.out, "P819 ")) << all.out;
  const CommandResult early = ipos({"diag", "plant.toml", "saw", "--at", "0ms", "--page", "pd"});
  EXPECT_TRUE(contains(early.out, "  PO2                              0000 hex\n")) << early.out;
  EXPECT_FALSE(contains(early.out, "saw: can"));
  EXPECT_EQ(ipos({"diag", "plant.toml"}).exit_code, 64) << "which of two";
  EXPECT_EQ(ipos({"diag", "plant.toml", "saw", "--page", "dp"}).exit_code, 64);
}

// A card of PROFIBUS and a gateway, with what the master sees of them.
TEST_F(Diag, FieldbusAndGateway) {
  folder_.write(
      "dp.toml",
      "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\n[[bus]]\nname = \"sbus\"\nkind = \"can\"\n"
      "[[station]]\nname = \"saw\"\nunit = \"mdxb\"\noption = \"dfp\"\nprofibus = \"dp\"\n"
      "profibus_address = 9\n[station.parameters]\nP100 = 3\nP101 = 2\n"
      "[[station]]\nname = \"fan\"\nunit = \"mc07\"\nsbus = \"sbus\"\n[station.parameters]\nP813 = 5\n"
      "[[station]]\nname = \"gw\"\nunit = \"gateway\"\nprofibus = \"dp\"\nprofibus_address = 10\n"
      "sbus = \"sbus\"\ndrives = [5, 6]\n"
      "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 9\ncfg = \"F3 F2\"\n"
      "watchdog = \"200ms\"\npo = [6, 5000]\n[[control.slave]]\naddress = 10\ncfg = \"F3 F2 F2\"\n"
      "channel = \"71 05 21 98 00 00 00 00\"\n");
  const CommandResult card = ipos({"diag", "dp.toml", "saw", "--at", "2s", "--page", "fieldbus"});
  EXPECT_EQ(card.exit_code, 0) << card.err;
  for (const char* part :
       {"P819 ", "0.200 s", "MOVIDRIVE B DFP21B/DP on dp", "  address                          9\n",
        "  ident number                     6003 hex\n", "exchanges data", "Param + 3 PD",
        "  master                           1\n", "  BUS FAULT                        off\n",
        "00 0C 00 01 60 03"})
    EXPECT_TRUE(contains(card.out, part)) << part << "\n" << card.out;
  // Octet 2 without WD_On, as the master has set no watchdog; 02 and the second of its drives.
  const CommandResult gateway = ipos({"diag", "dp.toml", "gw", "--at", "2s"});
  EXPECT_EQ(gateway.exit_code, 0) << gateway.err;
  for (const char* part : {"gw: gateway from dp to sbus\n", "08 04 00 01 60 02 02 02", "SBus address 5\n",
                           "answers\n", "SBus address 6\n", "does not answer\n", "lost 1 times",
                           "last parameter service           drive 5, index 8600: 5\n"})
    EXPECT_TRUE(contains(gateway.out, part)) << part << "\n" << gateway.out;
  const CommandResult refused = ipos({"param", "get", "dp.toml", "P813", "--station", "gw"});
  EXPECT_EQ(refused.exit_code, 64);
  EXPECT_TRUE(contains(refused.err, "is a gateway: it has no program, drive or parameters")) << refused.err;
  const CommandResult plan = ipos({"bus", "plan", "dp.toml"});
  EXPECT_TRUE(contains(plan.out, "gw")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "(PO) of address 5")) << plan.out;
}

// The run-up: 1.5 rpm a millisecond from 0 to 1000 rpm.
TEST_F(Diag, ScopeAsCsv) {
  PROVES("MDB-TOC-28");
  const CommandResult scope = ipos({"scope", "plant.toml", "saw", "--channels", "P000,P005", "--trigger",
                                    "P000>300 rpm", "--before", "50", "--samples", "200", "--every", "2ms"});
  EXPECT_EQ(scope.exit_code, 0) << scope.err;
  std::istringstream text(scope.out);
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "time_ms,P000 Speed,P005 Active current");
  int rows = 0;
  for (int time = -100; std::getline(text, line); time += 2, ++rows) {
    ASSERT_TRUE(line.starts_with(std::to_string(time) + ",")) << line;
    const double speed = std::stod(line.substr(line.find(',') + 1));
    EXPECT_EQ(speed >= 300.0, time >= 0) << line;
  }
  EXPECT_EQ(rows, 200);
  const CommandResult never =
      ipos({"scope", "plant.toml", "saw", "--trigger", "P000>3000", "--limit", "500ms"});
  EXPECT_EQ(never.exit_code, 1);
  EXPECT_TRUE(contains(never.err, "the scope is not done after 500ms: WAITING")) << never.err;
  EXPECT_EQ(ipos({"scope", "plant.toml", "saw", "--channels", "P130"}).exit_code, 64) << "a setting";
  EXPECT_EQ(ipos({"scope", "plant.toml", "saw", "--trigger", "P004>1"}).exit_code, 64)
      << "not the first channel";
  folder_.write("old.toml", "[[station]]\nname = \"a\"\nunit = \"md60a\"\n");
  EXPECT_TRUE(contains(ipos({"scope", "old.toml"}).err, "unit md60a has no scope"));
}

}  // namespace
}  // namespace ipos::tests
