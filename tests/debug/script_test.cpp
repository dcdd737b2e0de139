// ipos debug as a user meets it: a script on standard input, with snapshots that take over when time goes
// back.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

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

// A script of another system.
TEST(DebugScript, LinesMayEndWithCrLf) {
  std::string script = kBack;
  for (size_t at = 0; (at = script.find('\n', at)) != std::string::npos; at += 2) script.insert(at, "\r");
  EXPECT_EQ(debug(script).output, debug(kBack).output);
}

// Where no process can be made at the moment of going back, the way is the longer one. The limit counts the processes of
// a user; it does not bind root.
TEST(DebugScript, GoesTheLongerWayWhenAForkFailsOnTheWayBack) {
  if (geteuid() == 0 && std::system("command -v setpriv > /dev/null") != 0) GTEST_SKIP() << "no setpriv here";
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  folder.write("MAIN.IPC", kProgram);
  const std::string input = folder.write("script", kBack);
  const std::string as = geteuid() == 0 ? "setpriv --reuid 54321 --clear-groups" : "";
  // Nobody else is that user: the shell's process becomes the first of ipos, the second is its worker, and there is
  // room for one snapshot but not for the copy that would go on from it.
  for (const int processes : {2, 3, 4}) {
    const ScriptResult result =
        run_script({"/bin/sh", "-c",
                    fmt::format("cd '{}' && {} bash -c \"ulimit -u {}; exec '{}' debug --unit mdxb MAIN.IPC < '{}'\" 2>&1",
                                folder.path().string(), as, processes, ipos_program(), input)});
    EXPECT_EQ(result.exit_code, 0) << processes << "\n" << result.output;
    EXPECT_EQ(result.output, debug(kBack).output) << processes;
  }
}

// What an editor sends arrives in pieces of any size. dd writes byte by byte.
TEST(DapSession, IsTheSameInOnePieceAndByteByByte) {
  const TemporaryFolder folder;
  const std::string program = folder.write("MAIN.IPC", kProgram);
  std::string session;
  int seq = 0;
  const auto send = [&](const std::string& command, const std::string& arguments = "{}") {
    const std::string body = fmt::format(R"({{"type":"request","seq":{},"command":"{}","arguments":{}}})", ++seq,
                                         command, arguments);
    session += fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
  };
  send("initialize");
  send("launch", fmt::format(R"({{"program":"{}","unit":"mdxb"}})", program));
  send("setBreakpoints", fmt::format(R"({{"source":{{"path":"{}"}},"breakpoints":[{{"line":8,"hitCondition":"== 3"}}]}})", program));
  send("configurationDone");
  send("continue", R"({"threadId":2})");
  send("stackTrace", R"({"threadId":2})");
  send("evaluate", R"({"expression":"lCount"})");
  send("continue", R"({"threadId":2})");  // nothing stops it but what follows
  send("pause", R"({"threadId":2})");
  send("threads");
  send("continue", R"({"threadId":2})");
  send("terminate");
  send("disconnect");
  folder.write("session", session);
  for (const char* feed : {"cat session", "dd bs=1 if=session status=none", "dd bs=37 if=session status=none"}) {
    const ScriptResult result =
        run_script({"/bin/sh", "-c", fmt::format("cd '{}' && {} | '{}' dap 2>&1", folder.path().string(), feed,
                                                 ipos_program())});
    EXPECT_EQ(result.exit_code, 0) << feed;
    for (int n = 1; n <= seq; ++n) {
      const std::string answer = fmt::format("\"request_seq\":{},", n);
      EXPECT_NE(result.output.find(answer), std::string::npos) << feed << " " << n << "\n" << result.output;
    }
    EXPECT_EQ(result.output.find("\"success\":false"), std::string::npos) << feed << "\n" << result.output;
    EXPECT_NE(result.output.find("\"event\":\"terminated\""), std::string::npos) << feed;
    EXPECT_NE(result.output.find("\"result\":\"3\""), std::string::npos) << feed << "\n" << result.output;
  }
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
