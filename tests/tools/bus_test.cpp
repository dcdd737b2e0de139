// `ipos bus` as a user meets it: exit codes, located messages, and that its parts fit together.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string example(const std::string& name) { return project("examples/" + name).string(); }

TEST(Bus, UsageAndHelp) {
  EXPECT_EQ(run_ipos({"bus"}).exit_code, 64);
  EXPECT_EQ(run_ipos({"bus", "frob"}).exit_code, 64);
  EXPECT_EQ(run_ipos({"bus", "load", "x.log"}).exit_code, 64);  // needs --baud
  EXPECT_EQ(run_ipos({"bus", "plan", "x.toml", "--trial", "soon"}).exit_code, 64);
  EXPECT_EQ(run_ipos({"bus", "replay", "a", "b", "--id", "xyz"}).exit_code, 64);
  for (const std::string verb : {"plan", "decode", "monitor", "load", "replay", "dbc"}) {
    const CommandResult help = run_ipos({"bus", verb, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_TRUE(contains(help.out, "Example")) << verb;
  }
  EXPECT_EQ(run_ipos({"bus", "decode", "/nowhere/a.log"}).exit_code, 66);
  EXPECT_EQ(run_ipos({"bus", "plan", "/nowhere/a.toml"}).exit_code, 66);
  EXPECT_EQ(run_ipos({"bus", "dbc", example("scom/scom.toml"), "-o", "/nowhere/a.dbc"}).exit_code, 74);
}

TEST(Bus, PlanOfTheExamplesHasNoErrors) {
  for (const char* name :
       {"scom/scom.toml", "scom-intel/scom-intel.toml", "movilink/movilink.toml", "sbus-line/line.toml"}) {
    const CommandResult result = run_ipos({"bus", "plan", example(name), "--format", "json"});
    EXPECT_EQ(result.exit_code, 0) << name << result.out;
    const auto plan = nlohmann::json::parse(result.out);
    EXPECT_EQ(plan["lines"].size(), 1U);
    for (const auto& finding : plan["findings"]) EXPECT_EQ(finding["weight"], "hint") << finding;
  }
  EXPECT_EQ(run_ipos({"bus", "plan", example("scom/SCOM1.IPC")}).exit_code, 0);  // a single program
}

TEST(Bus, PlanWithAnErrorIsExitCode1) {
  const TemporaryFolder folder;
  folder.write("p.toml",
               "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nlength = 81\n[[station]]\nname = \"a\"\nunit = "
               "\"md60a\"\nsbus = "
               "\"sbus\"\n");
  const CommandResult result = run_ipos({"bus", "plan", "p.toml"}, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "sbus: error: 81 m of cable, at 500 kbaud at most 80 m [B06]\n");
}

TEST(Bus, RunDecodeLoadAndReplayFitTogether) {
  const TemporaryFolder folder;
  const std::string plant = example("sbus-line/line.toml");
  ASSERT_EQ(run_ipos({"run", plant, "--for", "1s", "--log", "a.log"}, folder.path()).exit_code, 0);
  const CommandResult decoded = run_ipos({"bus", "decode", "a.log", "--names", plant}, folder.path());
  EXPECT_EQ(decoded.exit_code, 0);
  EXPECT_EQ(decoded.err, "");
  EXPECT_TRUE(contains(decoded.out, " sbus 0 sync telegram\n"));
  EXPECT_TRUE(contains(
      decoded.out, " sbus 269 PO-sync CTRL. WORD 1 0006h (enable), SPEED 1000.0 rpm, 0000h -> inverter1\n"));
  EXPECT_TRUE(contains(decoded.out, " sbus 1024 lLength = 12346 (0000303Ah) <- inverter1\n"));
  // The load agrees with what the line itself counted in the run.
  const auto report =
      nlohmann::json::parse(run_ipos({"run", plant, "--for", "1s", "--format", "json"}, folder.path()).out);
  const auto load = nlohmann::json::parse(
      run_ipos({"bus", "load", "a.log", "--baud", "500000", "--format", "json"}, folder.path()).out);
  EXPECT_EQ(load["all"]["frames"], report["buses"][0]["frames"]);
  EXPECT_NEAR(load["all"]["exact_percent"].get<double>(), report["buses"][0]["load_percent"].get<double>(),
              0.1);
  // The object of inverter 1 from the log, to inverter 2 alone.
  folder.write("two.toml",
               "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"inverter2\"\nunit = "
               "\"md60a\"\nprogram = "
               "\"LINE2.IPC\"\nsbus = \"sbus\"\n");
  folder.write("LINE2.IPC", read_text(project("examples/sbus-line/LINE2.IPC")));
  const CommandResult replay =
      run_ipos({"bus", "replay", "a.log", "two.toml", "--id", "400", "--at", "50ms", "--watch=lLength"},
               folder.path());
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_TRUE(contains(replay.out, "lLength  12346")) << replay.out;
  EXPECT_TRUE(contains(replay.out, "50 of 50 frames replayed on sbus\n")) << replay.out;
}

TEST(Bus, BadLogLinesAreLocatedAndTheOthersDecoded) {
  const TemporaryFolder folder;
  folder.write("a.log",
               "(0000000001.000000) can0 20B#3100207E00000000\nnonsense\n(0000000002.000000) can0 7D0#1\n");
  const CommandResult result = run_ipos({"bus", "decode", "a.log"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(contains(result.out, "523 read 8318 Speed -> address 1")) << result.out;
  EXPECT_TRUE(contains(result.err, "a.log:2:1: error: '(' expected\n"));
  EXPECT_TRUE(contains(result.err, "a.log:3:31: error: second hexadecimal digit of a data byte expected\n"))
      << result.err;
  EXPECT_EQ(run_ipos({"bus", "load", "a.log", "--baud", "500000"}, folder.path()).exit_code, 65);
  EXPECT_EQ(run_ipos({"bus", "replay", "a.log", example("scom/scom.toml")}, folder.path()).exit_code, 65);
}

TEST(Bus, UnknownIdentifiersAreNamedOnceWithTheirPlace) {
  const TemporaryFolder folder;
  folder.write("a.log", "(0000000001.000000) can0 7D0#01\n(0000000002.000000) can0 7D0#02\n");
  const CommandResult result = run_ipos({"bus", "decode", "a.log"}, folder.path());
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "a.log:1:26: note: nothing is known about identifier 2000\n");
}

TEST(Bus, DbcOfAProgram) {
  const CommandResult result = run_ipos({"bus", "dbc", example("scom/SCOM1.IPC")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.out,
                       "BO_ 1024 Object_1024: 8 SCOM1\n SG_ lTrDataLow : 39|32@0- (1,0) "
                       "[-2147483648|2147483647] \"\" Vector__XXX\n SG_ lTrDataHigh : 7|32@0- "))
      << result.out;
}

}  // namespace
}  // namespace ipos::tests
