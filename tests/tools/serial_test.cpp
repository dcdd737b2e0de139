// Programs that use MOVLNK over RS-485, run as a user runs them.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/harness/proves.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kBuses = R"([[bus]]
name = "sbus"
kind = "can"
[[bus]]
name = "x13"
kind = "rs485"
[[bus]]
name = "xt"
kind = "rs485"
)";

std::string station(const std::string& name, const std::string& unit, const std::string& keys,
                    const std::string& parameters) {
  return "[[station]]\nname = \"" + name + "\"\nunit = \"" + unit + "\"\n" + keys + "[station.parameters]\n" +
         parameters;
}

const std::string kSlaves = station("on_x13", "md60a", "rs485 = \"x13\"\n", "P810 = 1\nP130 = 1300\n") +
                            station("on_xt", "md60a", "rs485 = \"xt\"\n", "P810 = 1\nP130 = 1100\n") +
                            station("on_sbus", "md60a", "sbus = \"sbus\"\n", "P813 = 1\nP130 = 1500\n");
const std::string kAllBuses =
    "program = \"A.IPC\"\nsbus = \"sbus\"\nrs485 = \"x13\"\nrs485_xt = \"xt\"\nuss21a = true\n";

struct Outcome {
  CommandResult result;
  std::map<std::string, int64_t> variables;  // of the first station with a program
  std::string can;
  std::string serial;
};

Outcome run(const std::string& plant, const std::string& program, const std::string& duration = "3s") {
  const TemporaryFolder folder;
  folder.write("A.IPC", program);
  folder.write("plant.toml", plant);
  Outcome outcome;
  outcome.result = run_ipos({"run", "plant.toml", "--for", duration, "--format", "json", "--why", "--log",
                             "can.log", "--serial-log", "serial.log"},
                            folder.path());
  EXPECT_EQ(outcome.result.exit_code, 0) << outcome.result.err;
  if (outcome.result.exit_code != 0) return outcome;
  const auto report = nlohmann::json::parse(outcome.result.out);
  for (const auto& unit : report["stations"])
    for (const auto& row : unit["variables"])
      outcome.variables.emplace(row["name"].get<std::string>(), row["value"].get<int64_t>());
  outcome.can = read_text(folder.path() / "can.log");
  outcome.serial = read_text(folder.path() / "serial.log");
  return outcome;
}

size_t count(const std::string& text, const std::string& word) {
  size_t found = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

// Reads P130 of unit 1 over each bus type; read[n] and result[n] for type n.
const std::string kEachType = R"(#include <const.h>
#include <io.h>
long result[7];
long value[7];
long n, done;
MOVLNK Ml;
MLDATA Mld;
main()
{
    Ml.Address = 1;
    Ml.Format = ML_CFT_PAR;
    Ml.Service = ML_S_RD;
    Ml.Index = 8470;
    Ml.DPointer = numof(Mld);
    for (n = 0; n < 7; n++)
    {
        Ml.BusType = n;
        Mld.ReadPar = 77;
        _MoviLink( Ml );
        result[n] = Ml.Result;
        value[n] = Mld.ReadPar;
    }
    done = 1;
    while (1) {}
}
)";

TEST(MoviLinkOverRs485, BusTypesLeadToTheirLines) {
  PROVES("MOVLNK-03", "MOVLNK-10");
  const Outcome out = run(kBuses + station("master", "md60a", kAllBuses, "") + kSlaves, kEachType);
  ASSERT_EQ(out.variables.at("done"), 1);
  const std::map<int, int64_t> expected = {{1, 1100}, {2, 1300}, {5, 1500}};
  for (int type = 0; type < 7; ++type) {
    const std::string at = "[" + std::to_string(type) + "]";
    const auto good = expected.find(type);
    EXPECT_EQ(out.variables.at("result" + at) == 0, good != expected.end()) << type;
    EXPECT_EQ(out.variables.at("value" + at), good != expected.end() ? good->second : 77) << type;
  }
  EXPECT_EQ(count(out.serial, " x13 02 01 86"), 1U) << out.serial;
  EXPECT_EQ(count(out.serial, " xt 02 01 86"), 1U);
  EXPECT_EQ(count(out.serial, "\n"), 4U) << "two requests and two answers";
  EXPECT_EQ(count(out.can, "\n"), 2U);
}

// The damaged table of MDX60B/61B section 3.3.1: XT 1, X13 2, fieldbus 3, SBus 1 5, SBus 2 8.
TEST(MoviLinkOverRs485, BusTypesOfMovidriveB) {
  PROVES("MDB-PAR-02");
  std::string program = "#pragma globals 365 399\n" + kEachType;
  program.replace(program.find("result[7]"), 9, "result[9]");
  program.replace(program.find("value[7]"), 8, "value[9]");
  program.replace(program.find("n < 7"), 5, "n < 9");
  const std::string buses =
      "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[bus]]\nname = \"sbus2\"\nkind = \"can\"\n"
      "[[bus]]\nname = \"x13\"\nkind = \"rs485\"\n"
      "[[bus]]\nname = \"xt\"\nkind = \"rs485\"\nbaud = 57600\n";
  const Outcome out = run(
      buses +
          station(
              "master", "mdxb",
              "program = \"A.IPC\"\nsbus = \"sbus\"\nsbus2 = \"sbus2\"\nrs485 = \"x13\"\nrs485_xt = \"xt\"\n",
              "") +
          station("on_x13", "md60a", "rs485 = \"x13\"\n", "P810 = 1\nP130 = 1300\n") +
          station("on_xt", "mdxb", "rs485_xt = \"xt\"\n", "P810 = 1\nP130 = 1100\n") +
          station("on_sbus", "md60a", "sbus = \"sbus\"\n", "P813 = 1\nP130 = 1500\n") +
          station("on_sbus2", "md60a", "sbus = \"sbus2\"\n", "P813 = 1\nP130 = 1800\n"),
      program);
  ASSERT_EQ(out.variables.at("done"), 1);
  const std::map<int, int64_t> expected = {{1, 1100}, {2, 1300}, {5, 1500}, {8, 1800}};
  for (int type = 0; type < 9; ++type) {
    const std::string at = "[" + std::to_string(type) + "]";
    const auto good = expected.find(type);
    EXPECT_EQ(out.variables.at("result" + at) == 0, good != expected.end()) << type;
    EXPECT_EQ(out.variables.at("value" + at), good != expected.end() ? good->second : 77) << type;
  }
}

TEST(MoviLinkOverRs485, Movitrac07) {
  PROVES("M07-SCOM-02");
  std::string program = kEachType;
  program.replace(program.find("8470"), 4, "8517");  // P302, the maximum speed of all of them
  const Outcome out =
      run(kBuses + station("master", "mc07", "program = \"A.IPC\"\nsbus = \"sbus\"\nrs485 = \"x13\"\n", "") +
              station("on_x13", "mc07", "rs485 = \"x13\"\n", "P810 = 1\nP302 = 1300000\n") +
              station("on_sbus", "mc07", "sbus = \"sbus\"\n", "P813 = 1\nP302 = 1500000\n") +
              // Node 1 of CANopen (chapter 5.1: bus type 6).
              station("node", "mdxb", "sbus = \"sbus\"\n", "P880 = 1\nP886 = 1\nP302 = 1700000\n"),
          program);
  ASSERT_EQ(out.variables.at("done"), 1);
  for (const int type : {0, 1, 3, 4})
    EXPECT_NE(out.variables.at("result[" + std::to_string(type) + "]"), 0) << type;
  EXPECT_EQ(out.variables.at("value[2]"), 1'300'000);
  EXPECT_EQ(out.variables.at("value[5]"), 1'500'000);
  EXPECT_EQ(out.variables.at("result[6]"), 0);
  EXPECT_EQ(out.variables.at("value[6]"), 1'700'000);
  EXPECT_EQ(count(out.serial, "\n"), 2U);
  // SBus, SDO and the boot-up of the node.
  EXPECT_EQ(count(out.can, "\n"), 5U);
  EXPECT_EQ(count(out.can, " 601#4045210000000000"), 1U) << out.can;
}

TEST(MoviLinkOverRs485, OwnUnit) {
  PROVES("RS485-12");
  const std::string program = R"(#include <const.h>
#include <io.h>
MOVLNK Ml;
MLDATA Mld;
main()
{
    Ml.BusType = ML_BT_S1;
    Ml.Address = 253;
    Ml.Format = ML_FT_PAR;
    Ml.Service = ML_S_RD;
    Ml.Index = 8470;
    Ml.DPointer = numof(Mld);
    _MoviLink( Ml );
}
)";
  for (const char* keys : {"program = \"A.IPC\"\nrs485 = \"x13\"\n", "program = \"A.IPC\"\n"}) {
    const Outcome out = run(kBuses + station("master", "md60a", keys, "P130 = 2300\n") + kSlaves, program);
    EXPECT_EQ(out.variables.at("Ml.Result"), 0);
    EXPECT_EQ(out.variables.at("Mld.ReadPar"), 2300);
    EXPECT_EQ(out.serial, "");
    EXPECT_EQ(out.can, "");
  }
}

TEST(MoviLinkOverRs485, SameIndexOnEveryInterface) {
  PROVES("MLK-06");
  const std::string program = R"(#include <const.h>
#include <io.h>
long value[6];
long failed;
MOVLNK Ml;
MLDATA Mld;
Read()
{
    Mld.ReadPar = -1;
    _MoviLink( Ml );
    if (Ml.Result) failed++;
}
main()
{
    Ml.Format = ML_CFT_PAR;
    Ml.Service = ML_S_RD;
    Ml.DPointer = numof(Mld);
    Ml.Index = 8318;
    Ml.Address = 253;  Ml.BusType = 2;  Read();  value[0] = Mld.ReadPar;
    Ml.Address = 1;    Ml.BusType = 2;  Read();  value[1] = Mld.ReadPar;
    Ml.Address = 1;    Ml.BusType = 5;  Read();  value[2] = Mld.ReadPar;
    Ml.Index = 8470;
    Ml.Address = 253;  Ml.BusType = 2;  Read();  value[3] = Mld.ReadPar;
    Ml.Address = 1;    Ml.BusType = 2;  Read();  value[4] = Mld.ReadPar;
    Ml.Address = 1;    Ml.BusType = 5;  Read();  value[5] = Mld.ReadPar;
}
)";
  const std::string slaves =
      station("both", "md60a", "sbus = \"sbus\"\nrs485 = \"x13\"\n", "P810 = 1\nP813 = 1\nP130 = 4300\n");
  const Outcome out = run(kBuses + station("master", "md60a", kAllBuses, "P130 = 4300\n") + slaves, program);
  EXPECT_EQ(out.variables.at("failed"), 0);
  for (int n = 0; n < 6; ++n)
    EXPECT_EQ(out.variables.at("value[" + std::to_string(n) + "]"), n < 3 ? 0 : 4300) << n;
}

TEST(MoviLinkOverRs485, ResultsOfFailuresAndTheOtherTaskGoesOn) {
  PROVES("MOVLNK-09");
  const std::string program = R"(#include <const.h>
#include <io.h>
long good, index_error, absent, ms, other, other_before, other_during;
MOVLNK Ml;
MLDATA Mld;
Task2()
{
    while (1) { other++; }
}
main()
{
    _SetTask2( T2_START, Task2 );
    Ml.BusType = ML_BT_S1;
    Ml.Format = ML_CFT_PAR;
    Ml.Service = ML_S_RD;
    Ml.DPointer = numof(Mld);
    Ml.Address = 1;
    Ml.Index = 8318;
    _MoviLink( Ml );
    good = Ml.Result;
    Ml.Index = 9500;
    _MoviLink( Ml );
    index_error = Ml.Result;
    Ml.Index = 8318;
    Ml.Address = 2;
    other_before = other;
    _MoviLink( Ml );
    absent = Ml.Result;
    other_during = other - other_before;
    ms = 1;
    while (1) {}
}
)";
  const Outcome out = run(kBuses + station("master", "md60a", kAllBuses, "") + kSlaves, program);
  EXPECT_EQ(out.variables.at("good"), 0);
  EXPECT_EQ(out.variables.at("index_error"), 0x08000010);
  EXPECT_EQ(out.variables.at("absent"), 0x06020000);
  EXPECT_EQ(out.variables.at("ms"), 1) << "the task goes on";
  EXPECT_GT(out.variables.at("other_during"), 50) << "for 133 ms with two commands each";
  EXPECT_NE(out.result.err.find("MOVLNK to address 2: response delay time elapsed"), std::string::npos)
      << out.result.err;
  // Two requests to 2, 50 ms apart; after 133 ms it is over.
  EXPECT_EQ(count(out.serial, " x13 02 02 86"), 2U);
}

TEST(MoviLinkOverRs485, TwoUnitsThatCallAreToldByName) {
  PROVES("RS485-23", "MDB-RS485-08");
  const std::string program = R"(#include <const.h>
#include <io.h>
MOVLNK Ml;
MLDATA Mld;
main()
{
    Ml.BusType = ML_BT_S1;
    Ml.Address = 1;
    Ml.Format = ML_CFT_PAR;
    Ml.Service = ML_S_RD;
    Ml.Index = 8318;
    Ml.DPointer = numof(Mld);
    while (1) { _MoviLink( Ml ); }
}
)";
  const std::string bus = "[[bus]]\nname = \"line1\"\nkind = \"rs485\"\n";
  const std::string keys = "program = \"A.IPC\"\nrs485 = \"line1\"\n";
  const std::string slave = station("slave", "mdxb", "rs485 = \"line1\"\n", "P810 = 1\n");
  const Outcome two =
      run(bus + station("a", "mdxb", keys, "P810 = 5\n") + station("b", "mdxb", keys, "P810 = 6\n") + slave,
          program);
  EXPECT_NE(two.result.err.find("a and b are both masters"), std::string::npos) << two.result.err;
  const Outcome one = run(bus + station("a", "mdxb", keys, "P810 = 5\n") + slave, program);
  EXPECT_EQ(one.result.err.find("masters"), std::string::npos) << one.result.err;
  const Outcome planned =
      run(bus + station("a", "mdxb", "rs485 = \"line1\"\n", "P810 = 5\nP811 = 101\nP750 = 1\n") +
              station("b", "mdxb", "rs485 = \"line1\"\n", "P810 = 6\nP811 = 101\nP750 = 7\n"),
          program);
  EXPECT_NE(planned.result.err.find("a and b are both masters (P750)"), std::string::npos)
      << planned.result.err;
}

TEST(SerialLogFile, CannotBeWritten) {
  const TemporaryFolder folder;
  folder.write("plant.toml", kBuses + kSlaves);
  const CommandResult result =
      run_ipos({"run", "plant.toml", "--for", "1ms", "--serial-log", "no/such/folder.log"}, folder.path());
  EXPECT_EQ(result.exit_code, 74);
  EXPECT_NE(result.err.find("No such file or directory"), std::string::npos);
}

}  // namespace
}  // namespace ipos::tests
