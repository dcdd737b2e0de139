// Which tests of a folder are run, and what a run says beside its report: --filter, --last-failed, --watch, --durations,
// annotations for GitHub, plants in folders.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <regex>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

const std::string kPlant = "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"A.IPC\"\n";

std::string test_of(int value) {
  return kPlant +
         "[[expect]]\nnote = \"50 %, at once\"\nvariable = \"a\"\nequals = " + std::to_string(value) +
         "\nat = \"100ms\"\n";
}

class Choice : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_.path() / "tests");
    folder_.write("tests/A.IPC", "long a;\nmain() { a = 5; while (1) ; }\n");
    folder_.write("tests/table_left.test.toml", test_of(5));
    folder_.write("tests/table_right.test.toml", test_of(5));
    folder_.write("tests/hoist.test.toml", test_of(5));
    setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);
  }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }
  CommandResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"test", "tests"});
    return run_ipos(arguments, folder_.path());
  }
  TemporaryFolder folder_;
};

TEST_F(Choice, FilterIsAPartOfTheNameOrAPattern) {
  const std::string both =
      "tests/table_left  tests/table_left.test.toml:1\ntests/table_right  tests/table_right.test.toml:1\n";
  EXPECT_EQ(run({"--list", "--filter", "table"}).out, both);
  EXPECT_EQ(run({"--list", "--filter", "*table*"}).out, both);
  EXPECT_EQ(run({"--list", "--filter", "table_l,hoi"}).out,
            "tests/hoist  tests/hoist.test.toml:1\ntests/table_left  tests/table_left.test.toml:1\n");
  EXPECT_EQ(run({"--list", "--filter", "table*"}).exit_code, 1);  // a pattern means the whole name
}

TEST_F(Choice, LastFailedRunsThoseUntilTheyPass) {
  folder_.write("tests/hoist.test.toml", test_of(6));
  EXPECT_EQ(run({}).exit_code, 1);
  EXPECT_EQ(run({"--last-failed", "--list"}).out, "tests/hoist  tests/hoist.test.toml:1\n");
  EXPECT_EQ(run({"--filter", "table"}).exit_code, 0);  // says nothing about the others
  EXPECT_EQ(run({"--last-failed", "--list"}).out, "tests/hoist  tests/hoist.test.toml:1\n");
  folder_.write("tests/hoist.test.toml", test_of(5));
  EXPECT_NE(run({"--last-failed"}).out.find("1 test, 1 passed"), std::string::npos);
  const CommandResult none = run({"--last-failed"});
  EXPECT_NE(none.out.find("3 tests, 3 passed"), std::string::npos) << none.out;
  EXPECT_NE(none.err.find("none of these tests failed last time"), std::string::npos) << none.err;
}

TEST_F(Choice, LastFailedIsOfTheFolder) {
  folder_.write("tests/hoist.test.toml", test_of(6));
  EXPECT_EQ(run({}).exit_code, 1);
  const CommandResult elsewhere = run_ipos({"test", ".", "--last-failed"}, folder_.path() / "tests");
  EXPECT_NE(elsewhere.err.find("none of these tests failed last time"), std::string::npos) << elsewhere.err;
}

TEST_F(Choice, DurationsAreTheLongest) {
  const std::string out = run({"--durations", "2"}).out;
  EXPECT_TRUE(std::regex_search(out, std::regex("longest on the clock:\n +\\d+\\.\\d{3} s  tests/\\w+\n "
                                                "+\\d+\\.\\d{3} s  tests/\\w+\n3 tests, 3 passed\n$")))
      << out;
}

// https://docs.github.com/actions/reference/workflow-commands-for-github-actions: properties escape % : , and ends of
// lines, the message % and ends of lines.
TEST_F(Choice, AnnotationsForGithub) {
  folder_.write("tests/hoist.test.toml", test_of(6));
  const std::string line =
      "::error file=tests/hoist.test.toml,line=5,col=1,title=tests/hoist::a of u is 5 at 100 ms, expected "
      "6%0A(50 %25, at "
      "once)\n";
  EXPECT_NE(run({"--format", "github"}).out.find("\n" + line), std::string::npos)
      << run({"--format", "github"}).out;
  EXPECT_EQ(run({}).out.find("::error"), std::string::npos);
  setenv("GITHUB_ACTIONS", "true", 1);
  EXPECT_NE(run({}).out.find("\n" + line), std::string::npos);
  EXPECT_EQ(run({"--format", "text"}).out.find("::error"), std::string::npos);
  // The paths are those of the repository, wherever the job stands in it.
  setenv("GITHUB_WORKSPACE", folder_.path().parent_path().c_str(), 1);
  EXPECT_NE(run({}).out.find("::error file=" + folder_.path().filename().string() + "/tests/hoist"),
            std::string::npos);
  unsetenv("GITHUB_WORKSPACE");
  unsetenv("GITHUB_ACTIONS");
}

TEST_F(Choice, FoldersAreSearchedForPlantsThatExpect) {
  const std::string expecting = "[[expect]]\nstation = \"u\"\nvariable = \"a\"\nequals = 5\nat = \"1s\"\n";
  folder_.write("tests/plant.toml", kPlant + expecting);
  folder_.write("tests/quiet.toml", kPlant);
  folder_.write("tests/Cargo.toml", "[package]\nname = \"x\"\n");
  EXPECT_NE(run({"--list"}).out.find("tests/plant  tests/plant.toml:1\n"), std::string::npos);
  EXPECT_EQ(run({"--list"}).out.find("quiet"), std::string::npos);
  // One whose expectations a test looks at is no test of its own; others are.
  folder_.write("tests/of.test.toml", "plant = \"plant.toml\"\nplant_expects = true\n");
  EXPECT_EQ(run({"--list"}).out.find("plant.toml"), std::string::npos);
  folder_.write("tests/of.test.toml",
                "plant = \"plant.toml\"\n[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"1s\"\n");
  EXPECT_NE(run({"--list"}).out.find("tests/plant  tests/plant.toml:1\n"), std::string::npos);
  folder_.write("tests/plant.toml", kPlant + "speed = \n" + expecting);
  EXPECT_NE(run({}).out.find("ERROR   tests/plant\n"), std::string::npos);
}

// genhtml and readers of Cobertura look for the sources from the folder of the call; a path that climbs out of it would
// make genhtml write its pages there.
TEST_F(Choice, CoverageNamesSourcesFromTheFolderOfTheCall) {
  std::filesystem::create_directory(folder_.path() / "tests/sub");
  folder_.write("tests/sub/up.test.toml",
                "plant = \"../plant.toml\"\n[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"1s\"\n");
  folder_.write("tests/plant.toml", kPlant);
  const auto names = [&](const std::filesystem::path& from, const std::string& path) {
    EXPECT_EQ(run_ipos({"test", path, "--filter", "up", "--coverage", "c.info", "--coverage", "c.xml"}, from)
                  .exit_code,
              0);
    return read_text(from / "c.info").substr(0, read_text(from / "c.info").find("\nFN:")) + " " +
           std::string(
               read_text(from / "c.xml").find("filename=\"" + (folder_.path() / "tests/A.IPC").string()) !=
                       std::string::npos
                   ? "absolute"
                   : "relative");
  };
  EXPECT_EQ(names(folder_.path(), "tests"), "TN:\nSF:tests/A.IPC relative");
  EXPECT_EQ(names(folder_.path() / "tests", "."), "TN:\nSF:A.IPC relative");
  EXPECT_EQ(names(folder_.path(), folder_.path().string()), "TN:\nSF:tests/A.IPC relative");
  EXPECT_EQ(names(folder_.path() / "tests/sub", "."),
            "TN:\nSF:" + (folder_.path() / "tests/A.IPC").string() + " absolute");
}

// A test, its plant and its program in three folders.
TEST_F(Choice, WatchLooksAtPlantsAndProgramsElsewhere) {
  for (const char* name : {"plants", "programs"}) std::filesystem::create_directory(folder_.path() / name);
  folder_.write("programs/B.IPC", "long a;\nmain() { a = 5; while (1) ; }\n");
  const std::string plant = "[[station]]\nname = \"u\"\nunit = \"md60a\"\nprogram = \"../programs/B.IPC\"\n";
  folder_.write("plants/p.toml", plant);
  folder_.write("tests/far.test.toml",
                "plant = \"../plants/p.toml\"\n[[expect]]\nvariable = \"a\"\nequals = 5\nat = \"100ms\"\n");
  RunningIpos watching({"test", "tests", "--filter", "far", "--watch"}, folder_.path());
  ASSERT_TRUE(watching.tells("waiting for a change"));
  EXPECT_TRUE(watching.prints("1 test, 1 passed\n"));
  folder_.write("programs/B.IPC", "long a;\nmain() { a = 55; while (1) ; }\n");
  EXPECT_TRUE(watching.prints("a of u is 55 at 100 ms, expected 5"));
  folder_.write("plants/p.toml", plant + "[[stimulus]]\nat = \"50ms\"\nstation = \"u\"\nvariable = \"a\"\nset = 5\n");
  EXPECT_TRUE(watching.prints("1 failed\n\nok      tests/far"));
  watching.signal(SIGINT);
  EXPECT_EQ(watching.wait().exit_code, 130);
}

TEST_F(Choice, WatchRunsAgainAfterAChange) {
  RunningIpos watching({"test", "tests", "--filter", "hoist", "--watch"}, folder_.path());
  ASSERT_TRUE(watching.tells("waiting for a change"));
  EXPECT_TRUE(watching.prints("1 test, 1 passed\n"));
  folder_.write("tests/A.IPC", "long a;\nmain() { a = 55; while (1) ; }\n");
  EXPECT_TRUE(watching.prints("a of u is 55 at 100 ms, expected 5"));
  folder_.write("tests/hoist.test.toml", test_of(55));
  EXPECT_TRUE(watching.prints("1 failed\n\nok      tests/hoist"));
  watching.signal(SIGINT);
  EXPECT_EQ(watching.wait().exit_code, 130);
}

}  // namespace
}  // namespace ipos::tests
