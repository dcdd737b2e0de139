// What is different on a terminal: colours, and Ctrl-C at the debugger's prompt.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/realbus/script.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

// `environment` as words in front of a command of the shell; keys as terminal.py takes them.
ScriptResult on_terminal(const TemporaryFolder& folder, const std::string& environment,
                         const std::string& keys, const std::string& arguments) {
  return run_script(
      {"/bin/sh", "-c",
       fmt::format("cd '{}' && exec env {} XDG_CACHE_HOME=. '{}' '{}' '{}' '{}' {}", folder.path().string(),
                   environment, kPython, project("tests/tools/terminal.py").string(), keys, ipos_program(),
                   arguments)});
}

class Terminal : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_pty()) GTEST_SKIP() << kNoPty;
    folder_.write("A.IPC", "long a;\nmain()\n{\n  a = 5;  // expect a == 5\n}\n");
    folder_.write("BAD.IPC", "main() { a = 1; }\n");
    folder_.write("bad.toml", "x = 1\n");
  }
  TemporaryFolder folder_;
};

// One rule for all verbs: a terminal has colours, unless NO_COLOR says no (no-color.org) or it is a dumb one.
TEST_F(Terminal, ColoursAreAlikeEverywhere) {
  for (const char* arguments : {"test A.IPC", "build BAD.IPC", "run bad.toml --for 1s"}) {
    SCOPED_TRACE(arguments);
    const auto has_colours = [&](const std::string& environment) {
      return on_terminal(folder_, environment, "", arguments).output.find("\x1b[1;3") != std::string::npos;
    };
    EXPECT_TRUE(has_colours("-u NO_COLOR TERM=xterm"));
    EXPECT_TRUE(has_colours("NO_COLOR= TERM=xterm"));
    EXPECT_FALSE(has_colours("NO_COLOR=1 TERM=xterm"));
    EXPECT_FALSE(has_colours("-u NO_COLOR TERM=dumb"));
  }
}

TEST_F(Terminal, ADumbOneGetsNoEscapes) {
  const ScriptResult result = on_terminal(folder_, "TERM=dumb", "", "test A.IPC");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(result.output.find('\x1b'), std::string::npos) << result.output;
}

// A run that takes longer than half a second shows how far it is, and takes that away at its end.
TEST_F(Terminal, ARunShowsHowFarItIs) {
  const ScriptResult result = on_terminal(folder_, "TERM=xterm", "", "run A.IPC --realtime --for 1200ms");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  std::smatch shown;
  ASSERT_TRUE(std::regex_search(result.output, shown, std::regex(R"(\r([01]\.\d) s of 1\.2 s)")))
      << result.output;
  EXPECT_TRUE(result.output.ends_with("\r\x1b[K")) << result.output;
}

// Each key is taken once, and q gives the terminal back with the table below what was there.
TEST_F(Terminal, KeysOfTheMonitor) {
  folder_.write("a.log", "(1000000000.000000) can0 20B#3100207E00000000\n");
  const ScriptResult result = on_terminal(folder_, "TERM=xterm TERMINAL_PROMPT='sorted by'", "|s|s|q",
                                          "bus monitor a.log --follow --table");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  size_t at = 0;
  for (const char* seen : {"\x1b[?1049h", "sorted by identifier", "sorted by count", "sorted by last change",
                           "\x1b[?1049l", "sorted by last change", "ipos: 1 telegrams, 1 shown"}) {
    at = result.output.find(seen, at);
    ASSERT_NE(at, std::string::npos) << seen << "\n" << result.output;
  }
}

TEST_F(Terminal, CtrlCAtThePromptGivesAPrompt) {
  const ScriptResult result =
      on_terminal(folder_, "TERM=dumb", "|b A.IPC:4\\n|\\x03|\\x03|info b\\n|quit\\n", "debug A.IPC");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  // The breakpoint of the first line is still there.
  const size_t asked = result.output.find("info b");
  ASSERT_NE(asked, std::string::npos) << result.output;
  EXPECT_NE(result.output.find("A.IPC:4", asked), std::string::npos) << result.output;
}

}  // namespace
}  // namespace ipos::tests
