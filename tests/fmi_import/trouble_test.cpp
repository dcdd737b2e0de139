// What FMUs do wrong is told at their line of the plant, and ipos goes on; they run only where the user has allowed it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/fmi_import/folder.hpp"
#include "tests/harness/contains.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

// As models/trouble.c has them.
enum Trouble { kFine, kCrash, kHang, kError, kExit, kSpeak, kAbort, kDiscard, kNoNumber, kCrashEarly, kDeep, kExitAtOnce, kLog, kFlood,
               kReadFile };

// Folders of FMUs that run have such names.
size_t left_behind() {
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator(fs::temp_directory_path()))
    if (entry.path().filename().string().starts_with("ipos-fmu-")) ++count;
  return count;
}

class FmuTrouble : public testing::Test {
 protected:
  FmuTrouble() {
    fs::create_directory(folder_.path() / "tmp");
    setenv("TMPDIR", (folder_.path() / "tmp").c_str(), 1);
  }
  ~FmuTrouble() override { unsetenv("TMPDIR"); }
  CommandResult run(int what, const std::string& more = "") {
    folder_.write_trouble(what, more);
    return folder_.run({"run", "p.toml", "--for", "300ms", "--allow-fmu", "--why"});
  }
  FmuFolder folder_;
};

TEST_F(FmuTrouble, WhatGoesWrongIsAnErrorAtTheLineOfTheMachine) {
  const std::pair<int, std::string> rows[] = {
      {kCrash, "at 0.100 s: the FMU crashed: a bad address (signal 11)"},
      {kError, "at 0.100 s: the FMU gives up: fmi2DoStep gives Error"},
      {kExit, "at 0.100 s: the FMU called exit()"},
      {kAbort, "at 0.100 s: the FMU crashed: abort() (signal 6)"},
      {kDiscard, "at 0.100 s: the FMU gives up: fmi2DoStep gives Discard"},
      {kNoNumber, "at 0.100 s: it gives no number for angle"},
      {kCrashEarly, "at 0.000 s: the FMU crashed: a bad address (signal 11)"},
      {kDeep, "at 0.100 s: the FMU crashed: a bad address (signal 11)"},
      {kExitAtOnce, "at 0.100 s: the process of the FMU has ended"},
  };
  for (const auto& [what, text] : rows) {
    folder_.write_trouble(what, "");
    // Only a value that is wired can be no number.
    if (what == kNoNumber)
      folder_.write("p.toml", read_text(folder_.path() / "p.toml") + "angle = \"u.H301\"\n");
    const CommandResult result = folder_.run({"run", "p.toml", "--for", "300ms", "--allow-fmu", "--format", "json"});
    EXPECT_EQ(result.exit_code, 1) << what << result.err;
    EXPECT_TRUE(contains(result.err, "p.toml:4:1: error: machine 'wheel' " + text)) << what << result.err;
    // What was before stands in the report; at its time it ended.
    EXPECT_TRUE(contains(result.out, what == kCrashEarly ? "\"time_us\":1000," : "\"time_us\":100000,")) << result.out;
  }
  EXPECT_EQ(left_behind(), 0U);
}

TEST_F(FmuTrouble, AHangEndsWithItsLimit) {
  const CommandResult result = run(kHang, "limit = \"200ms\"");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.err, "p.toml:4:1: error: machine 'wheel' at 0.100 s: the FMU has not answered for 200 ms")) << result.err;
  EXPECT_EQ(left_behind(), 0U);
}

TEST_F(FmuTrouble, WhatItSaysStandsInTheJournalAndNotInTheOutput) {
  const CommandResult said = run(kSpeak);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_FALSE(contains(said.out, "something"));
  EXPECT_TRUE(contains(said.err, "wheel: note: says ?[31msomething (at 100.000 ms)")) << said.err;
  const CommandResult logged = run(kLog);
  EXPECT_TRUE(contains(logged.err, "wheel: warning: the wheel squeaks (at 100.000 ms)")) << logged.err;
  const CommandResult given_up = run(kError);
  EXPECT_TRUE(contains(given_up.err, "wheel: warning: the wheel has come off at 100 ms")) << given_up.err;
}

// More than a pipe holds does not stop it.
TEST_F(FmuTrouble, MuchOutputIsTakenAndToldInPart) {
  const CommandResult result = run(kFlood);
  EXPECT_EQ(result.exit_code, 0) << result.err.substr(0, 1000);
  EXPECT_TRUE(contains(result.err, "wheel: note: line 1 of many"));
  EXPECT_TRUE(contains(result.err, "wheel: warning: says more, which is not told"));
  EXPECT_LT(result.err.size(), 50'000U);
}

TEST_F(FmuTrouble, ResourcesAreThereAndGoneAfterwards) {
  folder_.write_trouble(kReadFile);
  folder_.write("p.toml", read_text(folder_.path() / "p.toml") + "plain = \"u.H301\"\n");
  const CommandResult result = folder_.run({"run", "p.toml", "--for", "50ms", "--allow-fmu", "--watch=H301"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "43")) << result.out;  // 42.5 rounded
  EXPECT_EQ(left_behind(), 0U);
}

TEST_F(FmuTrouble, WithoutPermissionNoVerbRunsIt) {
  folder_.write_trouble(kFine);
  folder_.write("t.test.toml", "plant = \"p.toml\"\n[[expect]]\nat = \"200ms\"\nstation = \"u\"\nvariable = \"H300\"\nequals = 200\n");
  for (const auto& verb : std::vector<std::vector<std::string>>{{"run", "p.toml", "--for", "1ms"}, {"debug", "p.toml"}, {"serve", "p.toml", "--port", "0"}}) {
    const CommandResult result = folder_.run(verb);
    EXPECT_EQ(result.exit_code, 65) << verb.front();
    EXPECT_TRUE(contains(result.err, "p.toml:6:7: error: machine 'wheel': trouble.fmu: an FMU is a program, which would run as you; "
                                     "allow it with --allow-fmu"))
        << result.err;
  }
  const CommandResult test = folder_.run({"test", "t.test.toml"});
  EXPECT_NE(test.exit_code, 0);
  EXPECT_TRUE(contains(test.out + test.err, "allow it with --allow-fmu")) << test.out << test.err;
  EXPECT_EQ(folder_.run({"test", "t.test.toml", "--allow-fmu"}).exit_code, 0);
}

TEST_F(FmuTrouble, AUserAllowsAFolderOrAFileForGood) {
  folder_.write_trouble(kFine);
  const fs::path settings = folder_.path() / "settings";
  fs::create_directories(settings / "ipos");
  setenv("XDG_CONFIG_HOME", settings.c_str(), 1);
  const auto exit_code = [&](const std::string& line) {
    std::ofstream(settings / "ipos" / "allow-fmu") << "# mine\n" << line << "\n";
    return folder_.run({"run", "p.toml", "--for", "1ms"}).exit_code;
  };
  const std::string here = fs::canonical(folder_.path()).string();
  EXPECT_EQ(exit_code(here), 0);
  EXPECT_EQ(exit_code(here + "/trouble.fmu"), 0);
  EXPECT_EQ(exit_code(here + "/"), 0);
  EXPECT_EQ(exit_code(here + "/spring2.fmu"), 65);
  EXPECT_EQ(exit_code(here.substr(0, here.size() - 1)), 65);  // a beginning of the name is no folder
  EXPECT_EQ(exit_code("trouble.fmu"), 65);                    // relative to what?
  // A list that others may write allows nothing.
  EXPECT_EQ(exit_code(here), 0);
  fs::permissions(settings / "ipos" / "allow-fmu", fs::perms::others_write, fs::perm_options::add);
  EXPECT_EQ(folder_.run({"run", "p.toml", "--for", "1ms"}).exit_code, 65);
  unsetenv("XDG_CONFIG_HOME");
}

TEST_F(FmuTrouble, ATestThatAnFmuEndsFailsAtItsLine) {
  folder_.write_trouble(kCrash);
  folder_.write("t.test.toml", "plant = \"p.toml\"\n[[expect]]\nat = \"200ms\"\nstation = \"u\"\nvariable = \"H300\"\nequals = 200\n");
  const CommandResult result = folder_.run({"test", "t.test.toml", "--allow-fmu"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out + result.err, "p.toml:4:1")) << result.out << result.err;
  EXPECT_TRUE(contains(result.out + result.err, "the FMU crashed: a bad address")) << result.out << result.err;
}

// A case of a campaign has its own FMU; one that it ends has failed, at its line.
TEST_F(FmuTrouble, CasesOfACampaignHaveTheirMachines) {
  folder_.write_trouble(kFine);
  folder_.write("c.campaign.toml",
                fmt::format("plant = \"p.toml\"\nfor = \"200ms\"\n[[vary]]\nkey = \"machine.wheel.parameters.what\"\nvalues = [{}, {}]\n"
                            "[[measure]]\nname = \"steps\"\nsignal = \"u.H300\"\ntake = \"final\"\n",
                            int{kFine}, int{kCrash}));
  EXPECT_EQ(folder_.run({"campaign", "run", "c.campaign.toml", "--out", "a"}).exit_code, 65);
  EXPECT_EQ(folder_.run({"campaign", "run", "c.campaign.toml", "--out", "b", "--allow-fmu"}).exit_code, 1);
  const CommandResult merged = folder_.run({"campaign", "merge", "b", "--csv", "-"});
  EXPECT_TRUE(contains(merged.out, "0,200")) << merged.out << merged.err;
  EXPECT_TRUE(contains(merged.out, "1,99") || contains(merged.out, "1,100")) << merged.out;
  EXPECT_EQ(left_behind(), 0U);
}

}  // namespace
}  // namespace ipos::tests
