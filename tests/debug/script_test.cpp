// ipos debug as a user meets it: a script on standard input, with snapshots that take over when time goes
// back.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
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

// A round has four commands and takes 5 ms at a command a millisecond with its wait; the 300th has one more. So the 600th
// begins after 4 * 599 + 1 commands, at 5 * 599 + 1 ms.
TEST(DebugScript, WhoChangedAValueLast) {
  const std::string script = "until 3s\nb 8 if lCount == 700\nwho lWrong\nwho lCount\nwho H99\np lCount\nc\np lCount\nquit\n";
  const ScriptResult result = debug(script);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  for (const char* text : {"lWrong: 0 -> 1 by MAIN task 1, main at MAIN.IPC:8 (1497.000 ms, 1198 commands)\n",
                           "lCount: 599 -> 600 by MAIN task 1, main at MAIN.IPC:7 (2996.000 ms, 2397 commands)\n",
                           "nobody has changed H99 = 0 so far\n", "lCount = 600\n", "lCount = 700\n"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
  EXPECT_EQ(debug(script, "--no-snapshots").output, result.output);
}

// A round of the loop: increment, compare, wait, jump.
TEST(DebugScript, CostOfARound) {
  const ScriptResult result = debug("info cost\nb 7\nc\nc\nc\ninfo cost\nquit\n");
  EXPECT_NE(result.output.find("nothing has run since the session began\n"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("5.000 ms since the stop before\n  MAIN task 1: 4 commands\n"), std::string::npos) << result.output;
}

TEST(DebugScript, WhoLeavesWhatStandsThere) {
  const ScriptResult result =
      debug("until 3s\nset lWrong = 5\nwho lWrong\nwatch lWrong\nwho lWrong\np lWrong\nb 7\nc\nwho lCount\nc\nquit\n");
  EXPECT_NE(result.output.find("lWrong: 1 -> 5 by no command: a telegram, the unit, a stimulus or 'set' (3000.000 ms"), std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("lWrong = 5\n"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("Breakpoint 2\n"), std::string::npos) << result.output;
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

// A number that no point has is a mistake in every command that takes one.
TEST(DebugScript, PointsThatAreNotThereAreTold) {
  for (const char* command : {"enable 99", "disable 99", "hits 99 3", "condition 99 lCount", "delete 99", "enable x"}) {
    const ScriptResult result = debug(std::string("b 7\nwatch lCount\n") + command + "\ninfo breakpoints\nquit\n");
    EXPECT_NE(result.output.find("there is no breakpoint "), std::string::npos) << command << result.output;
    EXPECT_EQ(result.output.find("disabled"), std::string::npos) << command << result.output;
  }
}

TEST(DebugScript, AWatchStopsAtItsHits) {
  const ScriptResult result = debug("watch lCount\nhits 1 3\nc\np lCount\nhits 1 % 5\nc\np lCount\ninfo breakpoints\nquit\n");
  for (const char* text : {"lCount: 2 -> 3", "lCount: 4 -> 5", "watch lCount at hits % 5, 5 hits"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
  for (const char* text : {"lCount: 1 -> 2", "lCount: 3 -> 4"})
    EXPECT_EQ(result.output.find(text), std::string::npos) << text << "\n" << result.output;
}

TEST(DebugScript, TimeThatIsOverIsNotRunTo) {
  const ScriptResult result = debug("until 10ms\np lCount\nuntil 5ms\nuntil 10ms\np lCount\nquit\n");
  const std::string told = "it is 10.000 ms already";
  const size_t first = result.output.find(told);
  ASSERT_NE(first, std::string::npos) << result.output;
  EXPECT_NE(result.output.find(told, first + 1), std::string::npos) << result.output;
  const size_t before = result.output.find("lCount = "), behind = result.output.rfind("lCount = ");
  EXPECT_NE(before, behind);
  EXPECT_EQ(result.output.substr(before, 12), result.output.substr(behind, 12)) << "nothing has run";
}

TEST(DebugScript, MainHasNoCallToFinish) {
  const ScriptResult result = debug("s\nfinish\np lCount\nquit\n");
  EXPECT_NE(result.output.find("main() is none"), std::string::npos) << result.output;
  EXPECT_LT(result.output.size(), 1'000U) << "nothing has run";
}

// The fault of the program, and the name of the drive's own fault.
TEST(DebugScript, TheFaultOfAProgramHasANumber) {
  const TemporaryFolder folder;
  folder.write("F.IPC", "long a, b;\nmain()\n{\n  a = 7;\n  a = a / b;\n}\n");
  const std::string input = folder.write("script", "c\np fault\np program_fault\nquit\n");
  const ScriptResult result =
      run_script({"/bin/sh", "-c", fmt::format("cd '{}' && exec 2>&1; '{}' debug F.IPC < '{}'", folder.path().string(),
                                               ipos_program(), input)});
  for (const char* text : {"F10: division by zero", "program_fault = 10"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
}

// What `ipos test` does is done here at the same times, and done again when time goes back and forward.
class DebuggedTest : public ::testing::Test {
 protected:
  DebuggedTest() {
    folder.write("MAIN.IPC", kProgram);
    folder.write("p.toml", "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"MAIN.IPC\"\n");
    folder.write("a.test.toml", kTest);
  }
  std::string debug(const std::string& script, const std::string& options = "a.test.toml") {
    const std::string input = folder.write("script", script);
    return run_script({"/bin/sh", "-c", fmt::format("cd '{}' && exec 2>&1; '{}' debug {} < '{}'", folder.path().string(),
                                                    ipos_program(), options, input)})
        .output;
  }
  static constexpr const char* kTest =
      "plant = \"p.toml\"\n[[step]]\nat = \"100ms\"\nvariable = \"lWrong\"\nset = 5\n"
      "[[expect]]\nvariable = \"lWrong\"\nequals = 5\n"
      "[[expect]]\nvariable = \"lCount\"\nmin = 100\nwithin = \"1s\"\n"
      "[[step]]\nvariable = \"lCount\"\nset = 1000\n"
      "[[expect]]\nnote = \"a mistake\"\nvariable = \"lCount\"\nequals = 7\nafter = \"10ms\"\n";
  TemporaryFolder folder;
};

TEST_F(DebuggedTest, CarriesOutItsStepsAtTheirTime) {
  for (const char* options : {"a.test.toml", "--no-snapshots a.test.toml"}) {
    const std::string said = debug(
        "watch lWrong\nc\ninfo tasks\nuntil 99ms\ndelete\nrc\np lWrong\nuntil 99ms\np lWrong\nuntil 100ms\np lWrong\nquit\n",
        options);
    EXPECT_NE(said.find("lWrong: 0 -> 5"), std::string::npos) << said;
    EXPECT_NE(said.find("100.000 ms"), std::string::npos) << said;
    const size_t first = said.find("lWrong = 0"), second = said.find("lWrong = 0", first + 1);
    ASSERT_NE(second, std::string::npos) << said;
    EXPECT_NE(said.find("lWrong = 5", second), std::string::npos) << said << "the step comes again";
  }
}

TEST_F(DebuggedTest, TellsWhatTheTestTells) {
  const CommandResult tested = run_ipos({"test", "a.test.toml"}, folder.path());
  EXPECT_EQ(tested.exit_code, 1);
  const std::string said = debug("until 2s\nquit\n");
  const size_t begin = tested.out.find("  a.test.toml:"), end = tested.out.find("1 test, ");
  ASSERT_LT(begin, end);
  EXPECT_NE(said.find(tested.out.substr(begin, end - begin)), std::string::npos) << tested.out << said;
  EXPECT_NE(said.find("3 checks, 1 not met"), std::string::npos) << said;
}

// The same number of checks at the same time, in every example whose test has no cases.
TEST(DebuggedExamples, EndAsUnderTest) {
  size_t compared = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(project("examples"))) {
    const std::string path = entry.path().string();
    if (!path.ends_with(".test.toml") || read_text(path).find("[[case]]") != std::string::npos) continue;
    const CommandResult tested = run_ipos({"test", path, "--json", "-"});
    const auto number = [&](const char* key) {
      const size_t at = tested.out.find(fmt::format("\"{}\":", key));
      return at == std::string::npos ? -1 : std::stoll(tested.out.substr(tested.out.find_first_of("0123456789", at)));
    };
    const TemporaryFolder folder;
    const std::string input = folder.write("script", "until 30s\nc\nquit\n");
    const ScriptResult debugged = run_script(
        {"/bin/sh", "-c", fmt::format("exec '{}' debug '{}' < '{}' 2>&1", ipos_program(), path, input)});
    EXPECT_NE(debugged.output.find(fmt::format("the test is over at {} ms: {} checks, 0 not met",
                                               number("time_us") / 1000, number("checks"))),
              std::string::npos)
        << path << tested.out << debugged.output;
    ++compared;
  }
  EXPECT_GT(compared, 15U);
}

TEST_F(DebuggedTest, OneOfItsCasesIsChosen) {
  folder.write("c.test.toml", std::string("plant = \"p.toml\"\n[[case]]\nname = \"one\"\nx = 11\n[[case]]\nname = \"two\"\nx = 22\n") +
                                  "[[step]]\nat = \"50ms\"\nvariable = \"lWrong\"\nset = \"$x\"\n[[expect]]\nvariable = \"lWrong\"\nequals = \"$x\"\n");
  EXPECT_NE(debug("until 60ms\np lWrong\nquit\n", "--case two c.test.toml").find("lWrong = 22"), std::string::npos);
  for (const char* options : {"c.test.toml", "--case three c.test.toml"})
    EXPECT_NE(debug("quit\n", options).find("has the cases one, two"), std::string::npos) << options;
  EXPECT_NE(debug("quit\n", "--case one a.test.toml").find("has no cases"), std::string::npos);
  EXPECT_NE(debug("quit\n", "--case one p.toml").find("only a test"), std::string::npos);
}

// What is wrong is said in the response: editors hide what is printed.
TEST_F(DebuggedTest, AnEditorIsToldWhyThereIsNothingToDebug) {
  folder.write("BAD.IPC", "main()\n{\n  nobody = 5;\n}\n");
  folder.write("bad.toml", "[[station]]\nname = \"u\"\nunit = \"none\"\n");
  folder.write("bad.test.toml", "plant = \"p.toml\"\n[[step]]\nat = \"1ms\"\n");
  folder.write("name.test.toml", "plant = \"p.toml\"\n[[expect]]\nvariable = \"lNobody\"\nequals = 1\nat = \"1ms\"\n");
  const auto launched = [&](const std::string& arguments) {
    std::string session;
    for (const auto& [seq, command, of_it] :
         {std::tuple(1, "initialize", std::string("{}")), {2, "launch", arguments}, {3, "disconnect", std::string("{}")}}) {
      const std::string body =
          fmt::format(R"({{"type":"request","seq":{},"command":"{}","arguments":{}}})", seq, command, of_it);
      session += fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
    }
    folder.write("session", session);
    const std::string out = run_script({"/bin/sh", "-c", fmt::format("cd '{}' && '{}' dap 2>printed < session",
                                                                     folder.path().string(), ipos_program())})
                                .output;
    const size_t begin = out.find("\"message\":");
    return begin == std::string::npos ? out : out.substr(begin, out.find("\"request_seq\"", begin) - begin);
  };
  for (const auto& [arguments, part] :
       {std::pair(R"({"program": "BAD.IPC"})", "BAD.IPC:3:3: error"), {R"({"plant": "bad.toml"})", "bad.toml:3:8: error"},
        {R"({"plant": "bad.test.toml"})", "bad.test.toml:2:1: error"}, {R"({"plant": "name.test.toml"})", "lNobody"},
        {R"({"plant": "none.toml"})", "none.toml"}}) {
    const std::string message = launched(arguments);
    EXPECT_NE(message.find(part), std::string::npos) << arguments << message;
    EXPECT_EQ(message.find("see the messages"), std::string::npos) << message;
  }
  launched(R"({"program": "BAD.IPC"})");
  EXPECT_NE(read_text(folder.path() / "printed").find("BAD.IPC:3:3: error"), std::string::npos) << "it is printed, too";
  EXPECT_NE(launched(R"({"plant": "a.test.toml"})").find("\"success\":true"), std::string::npos);
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

// Both programs of the example send every 100 ms; what was caught is forgotten with its number, and kept when time goes back.
TEST(DebugScript, AFrameStopsThePlant) {
  const TemporaryFolder folder;
  const std::string input =
      folder.write("script", "catch sbus 400#*\ncatch hello\ninfo breakpoints\nc\nrsi\nc\nd 1\nd 1\nuntil 2s\nquit\n");
  const ScriptResult result = run_script({"/bin/sh", "-c",
                                          fmt::format("exec 2>&1; exec '{}' debug '{}' < '{}'", ipos_program(),
                                                      project("examples/scom/scom.toml").string(), input)});
  for (const char* text : {"Breakpoint 1: frame sbus 400#*\n", "'hello' is no frame", "1   frame sbus 400#*, 0 hits\n", "Breakpoint 1: 400#",
                           " on sbus\n", "there is no breakpoint 1\n", "(2000.000 ms"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
  const size_t first = result.output.find("Breakpoint 1: 400#");
  EXPECT_NE(result.output.find("Breakpoint 1: 400#", first + 1), std::string::npos) << result.output;
}

TEST(DebugScript, DisplaysAreShownAtEachStop) {
  const ScriptResult result = debug("display lCount\ndisplay /x lCount + 10\ndisplay nobody\ns\ns\nrs\nundisplay 1\nundisplay 7\ns\ndisplay\nquit\n");
  const auto count = [&](const std::string& text) {
    size_t n = 0;
    for (size_t at = result.output.find(text); at != std::string::npos; at = result.output.find(text, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("1: lCount = "), 3U) << result.output;   // at three stops; when it was made it had no number
  EXPECT_EQ(count("2: lCount + 10 = 0x"), 5U) << result.output;
  EXPECT_EQ(count("there is no display 7"), 1U) << result.output;
  EXPECT_EQ(count("3: "), 0U) << result.output;
}

// A round takes 5 ms: at 8 ms the second one waits. At line 9 of the third, line 7 is done once more.
TEST(DebugScript, JumpSetsTheNextStatement) {
  const std::string script =
      "jump 8\nuntil 8ms\njump 7\nb 9\nc\np lCount\njump MAIN@7\ns\np lCount\njump 1000\njump nobody\nquit\n";
  const ScriptResult result = debug(script);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("(ipos) jump 8\nnothing of that program has been executed yet\n"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("waits inside a command, which must end first\n"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("lCount = 3\n"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("lCount = 4\n"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("no command belongs to 'nobody'\n"), std::string::npos) << result.output;
  EXPECT_EQ(debug(script, "--no-snapshots").output, result.output);
}

// Line 9 waits, so at 8 the jump to 9 leaves nothing out but the comparison, and the one back to 7 counts twice in a round.
TEST(DebugScript, AJumpBackDoesAStatementAgain) {
  const ScriptResult result = debug("b 8\nc\np lCount\njump 7\nc\np lCount\nrs\np lCount\nquit\n");
  const size_t one = result.output.find("lCount = 1\n"), two = result.output.find("lCount = 2\n");
  ASSERT_NE(one, std::string::npos) << result.output;
  ASSERT_NE(two, std::string::npos) << result.output;
  EXPECT_NE(result.output.find("lCount = 1\n", two), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("MAIN.IPC:7 ("), std::string::npos) << result.output;
}

// At each stop its words; `c` among them goes on to the next stop, and the third one has no more to go to.
TEST(DebugScript, ABreakpointHasWords) {
  const std::string script = "b 8 if lCount >= 4\ncommands\np lCount * 100\np now\nend\nc\nwatch lWrong\ncommands 2\nrsi\nend\nd 1\nc\np lCount\ncommands 9\nquit\n";
  const ScriptResult result = debug(script);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  for (const char* text : {"lCount * 100 = 400\n", "Watchpoint 2: lWrong: 0 -> 1\n", "lCount = 300\n", "there is no breakpoint 9\n"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
  EXPECT_EQ(debug(script, "--no-snapshots").output, result.output);
}

TEST(DebugScript, APointThatGoesOnComesAgain) {
  const ScriptResult result = debug("b 8 if lCount % 100 == 0\ncommands $\np lCount\nc\nend\nuntil 1s\nquit\n", "--for 1s");
  for (const char* text : {"lCount = 100\n", "lCount = 200\n", "the time to run is over"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
  EXPECT_EQ(result.output.find("lCount = 300\n"), std::string::npos) << result.output;  // at 1.5 s
}

// What was saved gives the same list again, in another session.
TEST(DebugScript, PointsAreSavedAndComeAgain) {
  const std::string made =
      "b 8 if lCount > 3\nhits $ >= 2\ntb main\nb *0\ndisable $\ndprintf MAIN.IPC:9,at {lCount}\nwatch lWrong if lCount == 300\ncommands\np lCount\nbt\nend\ndisplay /x lCount\n";
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "points").string();
  const ScriptResult first = debug(made + "info breakpoints\nsave " + file + "\nsave /nobody/there\nquit\n");
  const ScriptResult again = debug("source " + file + "\nsource nobody\nsource\nsave\ninfo breakpoints\nc\nquit\n");
  const auto list = [](const std::string& output) {
    const size_t begin = output.find("info breakpoints\n");
    return output.substr(begin, output.find("(ipos)", begin) - begin);
  };
  EXPECT_EQ(list(again.output), list(first.output)) << read_text(file);
  EXPECT_NE(list(first.output).find(" at hits >= 2"), std::string::npos) << first.output;
  EXPECT_NE(list(first.output).find(", disabled"), std::string::npos) << first.output;
  EXPECT_NE(again.output.find("1: lCount = 0x"), std::string::npos) << again.output;
  EXPECT_NE(first.output.find("/nobody/there"), std::string::npos) << first.output;
  EXPECT_NE(again.output.find("nobody"), std::string::npos) << again.output;
  EXPECT_NE(again.output.find("source needs the name of a file\n"), std::string::npos) << again.output;
}

// Structures and arrays of them, of this and of another station, by what the program of each has written.
TEST(DebugScript, WholesAreShownOfEachStation) {
  const TemporaryFolder folder;
  folder.write("M.IPC",
               "typedef struct { long id; long w[2]; } Rec;\nRec rec[2];\nlong arr[3];\nmain()\n{\n  rec[0].id = 7;\n  rec[1].w[1] = 9;\n"
               "  arr[2] = 20;\n  while (1) {}\n}\n");
  folder.write("p.toml", "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"M.IPC\"\n[[station]]\nname = \"a\"\nunit = \"mdxb\"\nprogram = \"M.IPC\"\n");
  folder.write("script", "until 30ms\np rec\np a.rec[1]\np /x a.arr\ndisplay a.rec[0]\nx/2 a.arr\nx rec\nquit\n");
  const ScriptResult result =
      run_script({"/bin/sh", "-c", fmt::format("cd '{}' && exec 2>&1; '{}' debug p.toml < script", folder.path().string(), ipos_program())});
  for (const char* text : {"p rec\nrec[0].id = 7\nrec[0].w = {0, 0}\nrec[1].id = 0\nrec[1].w = {0, 9}\n", "a.rec[1].id = 0\na.rec[1].w = {0, 9}\n",
                           "a.arr = {0x0, 0x0, 0x14}\n", "display a.rec[0]\na.rec[0].id = 7\na.rec[0].w = {0, 0}\n"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
}

// What an editor asks in its console while the session goes back over snapshots; the next requests wait until it has its answer.
TEST(DapSession, TheLastWriterIsToldAcrossSnapshots) {
  const TemporaryFolder folder;
  const std::string program = folder.write("MAIN.IPC", kProgram);
  std::string session;
  int seq = 0;
  const auto send = [&](const std::string& command, const std::string& arguments = "{}") {
    const std::string body = fmt::format(R"({{"type":"request","seq":{},"command":"{}","arguments":{}}})", ++seq, command, arguments);
    session += fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
  };
  send("initialize");
  send("launch", fmt::format(R"({{"program":"{}","unit":"mdxb"}})", program));
  send("setBreakpoints", fmt::format(R"({{"source":{{"path":"{}"}},"breakpoints":[{{"line":9,"condition":"lCount == 700"}}]}})", program));
  send("configurationDone");
  send("continue", R"({"threadId":2})");
  send("scopes", R"({"frameId":128})");
  send("evaluate", R"({"expression":"who lWrong","context":"repl"})");
  send("variables", R"({"variablesReference":1})");
  send("evaluate", R"({"expression":"lCount * 1000"})");
  send("next", R"({"threadId":2})");  // or the end of the session would end the run before
  send("disconnect");
  folder.write("session", session);
  for (const char* options : {"", "--no-snapshots"}) {
    const ScriptResult result = run_script(
        {"/bin/sh", "-c", fmt::format("cd '{}' && '{}' dap {} < session 2>&1", folder.path().string(), ipos_program(), options)});
    EXPECT_EQ(result.exit_code, 0) << options;
    // The round of 300 has a command more than the 299 before it: 4 * 299 + 2 commands, 5 * 299 + 2 ms.
    EXPECT_NE(result.output.find("lWrong: 0 -> 1 by MAIN task 1, main at MAIN.IPC:8 (1497.000 ms, 1198 commands)"), std::string::npos)
        << options << "\n" << result.output;
    EXPECT_NE(result.output.find("\"result\":\"700000\""), std::string::npos) << options << "\n" << result.output;
    EXPECT_EQ(result.output.find("\"success\":false"), std::string::npos) << options << "\n" << result.output;
    size_t stops = 0;
    for (size_t at = 0; (at = result.output.find("\"event\":\"stopped\"", at)) != std::string::npos; ++at) ++stops;
    EXPECT_EQ(stops, 3U) << options << "\n" << result.output;
  }
}

// A run beside the clock, and a place for its socket that no other test has.
class AttachedRun : public ::testing::Test {
 protected:
  AttachedRun() {
    setenv("XDG_RUNTIME_DIR", place_.path().c_str(), 1);
    folder_.write("MAIN.IPC", kProgram);
  }
  ~AttachedRun() override { unsetenv("XDG_RUNTIME_DIR"); }

  RunningIpos run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", "--unit", "mdxb", "MAIN.IPC", "--realtime"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {arguments, folder_.path()};
  }
  std::vector<std::filesystem::path> sockets() const {
    std::vector<std::filesystem::path> all;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(place_.path() / "ipos", error)) all.push_back(entry.path());
    return all;
  }
  bool comes(size_t count) const {
    for (int n = 0; n < 2000 && sockets().size() != count; ++n) usleep(10'000);
    return sockets().size() == count;
  }
  ScriptResult shell(const std::string& command) const {
    return run_script({"/bin/sh", "-c", fmt::format("cd '{}' && exec 2>&1; {}", folder_.path().string(), command)});
  }
  ScriptResult look(const std::string& script, const std::string& option = "--attach") const {
    folder_.write("script", script);
    return shell(fmt::format("'{}' debug {} < script", ipos_program(), option));
  }

  TemporaryFolder folder_, place_;
};

TEST_F(AttachedRun, IsLookedAtAndNoMore) {
  RunningIpos running = run();
  ASSERT_TRUE(comes(1));
  const ScriptResult first = look("p lCount\np lCount * 0 + 7\ninfo tasks\nbt\nlist\nx/2 lCount\ndisas\nhelp\nquit\n");
  EXPECT_EQ(first.exit_code, 0) << first.output;
  for (const char* text : {"looks at the run of MAIN.IPC, which goes on", "MAIN task 1", "lCount * 0 + 7 = 7\n", "lCount++", "#0 main at MAIN.IPC:"})
    EXPECT_NE(first.output.find(text), std::string::npos) << text << "\n" << first.output;
  EXPECT_EQ(first.output.find("reverse-continue"), std::string::npos) << "help tells what works: " << first.output;
  const auto count = [](const std::string& output) {
    const size_t at = output.find("lCount = ");
    return at == std::string::npos ? -1 : std::stoi(output.substr(at + 9));
  };
  for (const char* word : {"c", "s", "n", "si", "finish", "until 1h", "rc", "rs", "b 7", "tb 7", "watch lCount", "who lCount", "catch 1#", "jump 8",
                           "set lCount = 1", "save there", "source there", "commands", "dprintf 7,x", "delete", "info cost"}) {
    const ScriptResult refused = look(std::string(word) + "\nquit\n");
    EXPECT_NE(refused.output.find("the run is only looked at"), std::string::npos) << word << "\n" << refused.output;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "there"));
  const int before = count(first.output), after = count(look("p lCount\nquit\n").output);
  EXPECT_GT(before, 0);
  EXPECT_GT(after, before) << "it has gone on";
  running.signal(SIGINT);
  const CommandResult end = running.wait();
  EXPECT_NE(end.err.find("real time: "), std::string::npos) << end.err;
  EXPECT_TRUE(comes(0)) << "its place is gone with it";
}

TEST_F(AttachedRun, IsChosenByItsProcess) {
  EXPECT_NE(look("quit\n").output.find("no 'ipos run --realtime' of this user goes on"), std::string::npos);
  RunningIpos one = run(), other = run();
  ASSERT_TRUE(comes(2));
  const ScriptResult several = look("quit\n");
  EXPECT_NE(several.exit_code, 0);
  EXPECT_NE(several.output.find("several runs go on: "), std::string::npos) << several.output;
  for (const auto& socket : sockets()) {
    const std::string name = socket.filename().string();
    const std::string process = name.substr(0, name.find('-'));
    EXPECT_NE(several.output.find(process + " (MAIN)"), std::string::npos) << several.output;
    EXPECT_NE(look("quit\n", "--attach=" + process).output.find("looks at the run of MAIN.IPC"), std::string::npos);
  }
  EXPECT_NE(look("quit\n", "--attach=1").output.find("process 1 is no 'ipos run --realtime' of this user"), std::string::npos);
  EXPECT_NE(look("quit\n", "--attach=x").output.find("'x' is no number of a process"), std::string::npos);
  EXPECT_NE(look("quit\n", "--attach MAIN.IPC").output.find("--attach looks at a run, which knows its file"), std::string::npos);
  // A process that ends without a word leaves its socket, which nobody takes for a run.
  one.signal(SIGKILL);
  other.signal(SIGKILL);
  one.wait();
  other.wait();
  EXPECT_NE(look("quit\n").output.find("no 'ipos run --realtime' of this user goes on"), std::string::npos);
}

TEST_F(AttachedRun, IsOfItsUserAlone) {
  RunningIpos running = run();
  ASSERT_TRUE(comes(1));
  EXPECT_EQ(std::filesystem::status(place_.path() / "ipos").permissions(), std::filesystem::perms::owner_all);
  EXPECT_EQ(std::filesystem::status(sockets()[0]).permissions(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  if (geteuid() != 0 || std::system("command -v setpriv > /dev/null") != 0) GTEST_SKIP() << "another user cannot be tried here";
  std::filesystem::permissions(place_.path(), std::filesystem::perms::all);
  std::filesystem::permissions(folder_.path(), std::filesystem::perms::all);
  const ScriptResult other =
      shell(fmt::format("setpriv --reuid 54321 --clear-groups '{}' debug --attach < /dev/null", ipos_program()));
  EXPECT_NE(other.output.find("no 'ipos run --realtime' of this user goes on"), std::string::npos) << other.output;
  // Whoever opens the folder to others gets no place in it.
  std::filesystem::permissions(place_.path() / "ipos", std::filesystem::perms::all);
  EXPECT_NE(look("quit\n").output.find("no 'ipos run --realtime' of this user goes on"), std::string::npos);
}

TEST_F(AttachedRun, MayHaveNoPlace) {
  RunningIpos running = run({"--no-attach"});
  usleep(500'000);
  EXPECT_TRUE(sockets().empty());
}

// What an editor sends in any session, and what it must not: the first answers come of the adapter, all others of the run.
TEST_F(AttachedRun, IsShownToAnEditor) {
  RunningIpos running = run();
  ASSERT_TRUE(comes(1));
  int seq = 0;
  std::string session;
  const auto send = [&](const std::string& command, const std::string& arguments = "{}") {
    const std::string body = fmt::format(R"({{"type":"request","seq":{},"command":"{}","arguments":{}}})", ++seq, command, arguments);
    session += fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
  };
  send("initialize", R"({"supportsInvalidatedEvent":true})");
  send("attach");
  send("setBreakpoints", R"({"source":{"path":"MAIN.IPC"},"breakpoints":[{"line":7}]})");
  send("setExceptionBreakpoints", R"({"filters":["fault"]})");
  send("configurationDone");
  send("threads");
  send("stackTrace", R"({"threadId":2})");
  send("scopes", R"({"frameId":128})");
  send("variables", R"({"variablesReference":1})");
  send("evaluate", R"({"expression":"lCount * 0 + 11","frameId":128})");
  const int good = seq;
  send("next", R"({"threadId":2})");
  send("stepBack", R"({"threadId":2})");
  send("setVariable", R"({"variablesReference":1,"name":"lCount","value":"1"})");
  send("evaluate", R"({"expression":"lCount = 1","context":"repl"})");
  send("evaluate", R"({"expression":"who lCount","context":"repl"})");
  send("goto", R"({"threadId":2,"targetId":1})");
  send("restart");
  send("launch", R"({"program":"MAIN.IPC"})");
  const int bad = seq;
  send("pause", R"({"threadId":2})");
  folder_.write("begin", session);
  session.clear();
  send("continue", R"({"threadId":2})");
  send("disconnect");
  folder_.write("end", session);
  const ScriptResult result = shell(fmt::format("(cat begin; sleep 2.5; cat end) | '{}' dap", ipos_program()));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  const auto answer = [&](int n) {
    const size_t end = result.output.find(fmt::format("\"request_seq\":{},", n));
    if (end == std::string::npos) return std::string("none");
    const size_t begin = result.output.rfind("Content-Length", end);
    return result.output.substr(begin, result.output.find("Content-Length", end) - begin);
  };
  for (int n = 1; n <= seq; ++n)
    EXPECT_NE(answer(n).find(n > good && n <= bad ? "\"success\":false" : "\"success\":true"), std::string::npos) << n << answer(n);
  EXPECT_NE(answer(3).find("\"verified\":false"), std::string::npos) << answer(3);
  EXPECT_NE(answer(9).find("\"lCount\""), std::string::npos) << answer(9);
  EXPECT_NE(answer(10).find("\"result\":\"11\""), std::string::npos) << answer(10);
  for (const char* text : {"\"event\":\"invalidated\"", "\"event\":\"capabilities\"", "\"reason\":\"pause\"", "looks at the run of MAIN.IPC"})
    EXPECT_NE(result.output.find(text), std::string::npos) << text << "\n" << result.output;
  size_t begun = 0;
  for (size_t at = 0; (at = result.output.find("\"event\":\"initialized\"", at)) != std::string::npos; ++at) ++begun;
  EXPECT_EQ(begun, 1U);
  const ScriptResult nobody = shell(fmt::format("cat begin | XDG_RUNTIME_DIR=/nobody '{}' dap", ipos_program()));
  EXPECT_NE(nobody.output.find("no 'ipos run --realtime' of this user goes on"), std::string::npos) << nobody.output;
}

// The run ends: its editor hears so.
TEST_F(AttachedRun, ToldTheEditorThatItHasEnded) {
  RunningIpos running = run({"--for", "1500ms"});
  ASSERT_TRUE(comes(1));
  std::string session;
  for (const char* command : {"initialize", "attach"}) {
    const std::string body = fmt::format(R"({{"type":"request","seq":{},"command":"{}","arguments":{{}}}})", session.empty() ? 1 : 2, command);
    session += fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
  }
  folder_.write("begin", session);
  const ScriptResult result = shell(fmt::format("(cat begin; sleep 4) | '{}' dap", ipos_program()));
  EXPECT_NE(result.output.find("the run has ended"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("\"event\":\"terminated\""), std::string::npos) << result.output;
}

TEST(DebugScript, EndsWithItsInput) { EXPECT_EQ(debug("s\ns\nrs\n").exit_code, 0); }

TEST(DebugScript, WrongProgramsEndIt) { EXPECT_EQ(run_ipos({"debug", "nobody.IPC"}).exit_code, 66); }

}  // namespace
}  // namespace ipos::tests
