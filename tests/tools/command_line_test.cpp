// The command line as such: misspelt verbs and options, help, completion of shells, the manual page.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

TEST(CommandLine, MisspeltWordsAreNamedWithWhatWasProbablyMeant) {
  const struct {
    std::vector<std::string> words;
    std::string message;
  } cases[] = {
      {{"tset"}, "'tset' is no verb of 'ipos'; did you mean 'test'?"},
      {{"xyzzy"}, "'xyzzy' is no verb of 'ipos'\n"},
      {{"bus", "paln"}, "'paln' is no verb of 'ipos bus'; did you mean 'plan'?"},
      {{"bus"}, "which verb? 'ipos bus --help' lists them"},
      {{"run", "--fro", "x.toml"}, "'--fro' is no option of 'ipos run'; did you mean '--for'?"},
      {{"fmt", "--chek=1"}, "did you mean '--check'?"},
      {{"verify", "a.ipx", "b.ipx"}, "'b.ipx' is no word of 'ipos verify'"},
      {{"run", "x.toml", "--engine", "fsat"}, "--engine: fsat not in {reference,fast,native}"},
      {{"run", "x.toml", "--speed", "0"}, "0 is not in 1 to 1000000"},
      {{"run", "x.toml", "--speed", "-1"}, "-1 is not in 1 to 1000000"},
      {{"bus", "monitor", "x", "--count", "0"}, "0 is not 1 or more"},
      {{"run"}, "FILE is required"},
  };
  for (const auto& one : cases) {
    const CommandResult result = run_ipos(one.words);
    EXPECT_EQ(result.exit_code, 64) << one.words.front();
    EXPECT_EQ(result.out, "") << one.words.front();
    EXPECT_TRUE(contains(result.err, one.message)) << result.err;
  }
}

TEST(CommandLine, HelpComesWithAndWithoutAsking) {
  const CommandResult asked = run_ipos({"help"});
  EXPECT_EQ(asked.exit_code, 0);
  EXPECT_TRUE(contains(asked.out, "Subcommands:")) << asked.out;
  const CommandResult bare = run_ipos({});
  EXPECT_EQ(bare.exit_code, 64);
  EXPECT_EQ(bare.err, asked.out);
}

// All names that `ipos VERB --help` prints at the beginning of a line.
std::set<std::string> verbs_in_help() {
  std::istringstream lines(run_ipos({"--help"}).out);
  std::set<std::string> verbs;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "Subcommands:")
      inside = true;
    else if (line.empty())
      inside = false;
    else if (inside && line[2] != ' ')
      verbs.insert(line.substr(2, line.find(' ', 2) - 2));
  }
  return verbs;
}

TEST(CommandLine, TheManualPageAndTheCompletionsHaveEveryVerb) {
  const std::set<std::string> verbs = verbs_in_help();
  EXPECT_GE(verbs.size(), 17U);
  const std::string page = run_ipos({"man"}).out;
  const std::string bash = run_ipos({"completion", "bash"}).out;
  const std::string zsh = run_ipos({"completion", "zsh"}).out;
  const std::string fish = run_ipos({"completion", "fish"}).out;
  for (const std::string& verb : verbs) {
    EXPECT_TRUE(contains(page, "\n.SS ipos " + verb + "\n")) << verb;
    EXPECT_TRUE(contains(bash, "    '" + verb + "') words=")) << verb;
    EXPECT_TRUE(contains(zsh, "'" + verb + ":")) << verb;
    EXPECT_TRUE(contains(fish, " -f -a " + verb + " -d ")) << verb;
  }
}

// What bash offers behind the words of a line; the last one is being typed.
std::string offered(const std::filesystem::path& script, const std::string& words) {
  const std::string command = "bash -c 'source " + script.string() + "; COMP_WORDS=(" + words +
                              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _ipos; echo \"${COMPREPLY[*]}\"'";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (int c = 0; pipe != nullptr && (c = fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  if (pipe != nullptr) pclose(pipe);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

TEST(CommandLine, BashCompletesVerbsOptionsAndClosedLists) {
  const auto script = std::filesystem::path(testing::TempDir()) / "ipos.bash";
  std::ofstream(script) << run_ipos({"completion", "bash"}).out;
  EXPECT_EQ(offered(script, "ipos bui"), "build");
  EXPECT_EQ(offered(script, "ipos bus \"\""), "plan decode monitor load replay dbc dissector --help");
  EXPECT_EQ(offered(script, "ipos bus p"), "plan");
  EXPECT_EQ(offered(script, "ipos run --engi"), "--engine");
  EXPECT_EQ(offered(script, "ipos run --engine \"\""), "reference fast native");
  EXPECT_EQ(offered(script, "ipos run --engine f"), "fast");
  EXPECT_EQ(offered(script, "ipos run plant"), "");  // files, by bash itself
}

// A folder that is not there yet.
std::filesystem::path fresh(const std::string& name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::remove_all(folder);
  return folder;
}

TEST(New, TheProjectItMakesPassesItsTest) {
  const auto folder = fresh("ipos_new");
  const CommandResult made = run_ipos({"new", folder.string()});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  for (const char* file : {"line.toml", "line.test.toml", "LEADER.IPC", "FOLLOWER.IPC", "README.md",
                           ".github/workflows/ipos.yml", ".gitlab-ci.yml"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / file)) << file;
    EXPECT_TRUE(contains(made.out, file)) << file;
  }
  const CommandResult tested = run_ipos({"test", folder.string()});
  EXPECT_EQ(tested.exit_code, 0) << tested.out;
  EXPECT_TRUE(contains(tested.out, "1 test, 1 passed")) << tested.out;
  EXPECT_EQ(run_ipos({"fmt", "--check", folder.string()}).exit_code, 0);
  EXPECT_EQ(run_ipos({"bus", "plan", (folder / "line.toml").string()}).exit_code, 0);
}

TEST(New, WhatIsThereAlreadyIsNotTouched) {
  const auto folder = fresh("ipos_new_again");
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "line.toml") << "mine";
  const CommandResult result = run_ipos({"new", folder.string()});
  EXPECT_EQ(result.exit_code, 74);
  EXPECT_TRUE(contains(result.err, "line.toml: is there already; nothing was written")) << result.err;
  std::ifstream kept(folder / "line.toml");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder / "LEADER.IPC"));
  const CommandResult file = run_ipos({"new", (folder / "line.toml").string()});
  EXPECT_EQ(file.exit_code, 74);
  EXPECT_TRUE(contains(file.err, "is no folder")) << file.err;
}

TEST(New, CopiesAnExample) {
  const auto folder = fresh("ipos_new_hoist");
  EXPECT_EQ(run_ipos({"new", folder.string(), "--from", "hoist"}).exit_code, 0);
  EXPECT_EQ(run_ipos({"test", folder.string()}).exit_code, 0);
  const CommandResult unknown = run_ipos({"new", folder.string(), "--from", "hiost"});
  EXPECT_EQ(unknown.exit_code, 64);
  EXPECT_TRUE(contains(unknown.err, "there is no example 'hiost', did you mean 'hoist'?")) << unknown.err;
}

}  // namespace
}  // namespace ipos::tests
