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
  for (const char* text : {"Breakpoint 1: frame sbus 400#*\n", "'hello' is no frame", "1   frame sbus 400#*\n", "Breakpoint 1: 400#",
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

TEST(DebugScript, EndsWithItsInput) { EXPECT_EQ(debug("s\ns\nrs\n").exit_code, 0); }

TEST(DebugScript, WrongProgramsEndIt) { EXPECT_EQ(run_ipos({"debug", "nobody.IPC"}).exit_code, 66); }

}  // namespace
}  // namespace ipos::tests
