// ipos debug as a user meets it: a script on standard input, with snapshots that take over when time goes
// back.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/realbus/script.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kProgram = R"(long lCount;
long lWrong;
main()
{
  while (1)
  {
    lCount++;
    if (lCount == 300) lWrong = 1;
    _Wait(2);
  }
}
)";

ScriptResult debug(const std::string& script, const std::string& options = {}) {
  const TemporaryFolder folder;
  folder.write("MAIN.IPC", kProgram);
  const std::string input = folder.write("script", script);
  return run_script({"/bin/sh", "-c",
                     fmt::format("cd '{}' && exec 2>&1; '{}' debug --unit mdxb {} MAIN.IPC < '{}'",
                                 folder.path().string(), ipos_program(), options, input)});
}

// A session that goes back over many snapshots; what comes behind it in the script is done by the process
// that goes on.
constexpr const char* kBack =
    "until 3s\nwatch lWrong\nrc\np lCount\np lWrong\nrn\nrn\nset lCount = 7\np lCount\ns\nquit\n";

TEST(DebugScript, GoesBackToTheCauseOfAWrongValue) {
  const ScriptResult result = debug(kBack);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  for (const char* text : {"lWrong: 0 -> 1", "lCount = 300\n", "lWrong = 0\n", "MAIN.IPC:7", "lCount = 7\n"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
}

TEST(DebugScript, SnapshotsGiveTheSameSessionAsRunningAnew) {
  const ScriptResult anew = debug(kBack, "--no-snapshots");
  EXPECT_EQ(debug(kBack).output, anew.output);
}

TEST(DebugScript, AnswersMistakes) {
  const ScriptResult result = debug("b 4711\np nobody\nfrob\nset\ninfo\nquit\n");
  EXPECT_EQ(result.exit_code, 0);
  for (const char* text : {"no command belongs to '4711'", "there is no 'nobody'", "'frob' is no command",
                           "set needs", "info knows"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
}

// 1024 and 1025 are what the programs of the example write.
TEST(DebugScript, ObjectsHaveTheirIdentifiersAsInLogsAndPrograms) {
  const TemporaryFolder folder;
  const std::string input = folder.write("script", "until 200ms\ninfo sbus\nquit\n");
  const ScriptResult result = run_script({"/bin/sh", "-c",
                                          fmt::format("exec '{}' debug '{}' < '{}'", ipos_program(),
                                                      project("examples/scom/scom.toml").string(), input)});
  for (const char* text :
       {"cyclic   object 400h (1024) data H426, every 100 ms", "receive  object 401h (1025) data"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
}

TEST(DebugScript, EndsWithItsInput) { EXPECT_EQ(debug("s\ns\nrs\n").exit_code, 0); }

TEST(DebugScript, WrongProgramsEndIt) { EXPECT_EQ(run_ipos({"debug", "nobody.IPC"}).exit_code, 66); }

}  // namespace
}  // namespace ipos::tests
