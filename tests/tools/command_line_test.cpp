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
      {{"verify"}, "FILE is required"},
      {{"help", "tset"}, "'tset' is no verb of 'ipos'; did you mean 'test'?"},
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
  // What one begins with stands first, and the verb that only shells ask nowhere.
  EXPECT_LT(asked.out.find("\nBegin:\n  new "), asked.out.find("\nRun and test:\n  run ")) << asked.out;
  EXPECT_LT(asked.out.find("  serve "), asked.out.find("Run and test:")) << asked.out;
  EXPECT_FALSE(contains(asked.out, "  complete ")) << asked.out;
  const CommandResult bare = run_ipos({});
  EXPECT_EQ(bare.exit_code, 64);
  EXPECT_EQ(bare.err, asked.out);
  EXPECT_EQ(run_ipos({"help", "run"}).out, run_ipos({"run", "--help"}).out);
  EXPECT_EQ(run_ipos({"help", "bus", "plan"}).out, run_ipos({"bus", "plan", "--help"}).out);
  EXPECT_EQ(run_ipos({"-V"}).out, run_ipos({"--version"}).out);
}

// Each verb that works on a plant takes the only one of a folder.
TEST(CommandLine, AFolderStandsForItsOnlyPlant) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "long a;\nmain()\n{\n    a = 5;\n}\n");
  const CommandResult program = run_ipos({"run", "--for", "10ms", "--watch"}, folder.path());
  EXPECT_TRUE(contains(program.out, "a")) << program.out << program.err;
  const std::string plant = "[[station]]\nname = \"u\"\nunit = \"MDX61B\"\nprogram = \"A.IPC\"\n";
  folder.write("line.toml", plant);
  folder.write("line.test.toml", "plant = \"line.toml\"\n[[expect]]\nat = \"10ms\"\nvariable = \"a\"\nequals = 5\n");
  folder.write("other.toml", "[tool]\nname = \"nothing of ours\"\n");
  const CommandResult run = run_ipos({"run", "--for", "10ms"}, folder.path());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const CommandResult watch = run_ipos({"run", "--for", "10ms", "--watch"}, folder.path());
  EXPECT_TRUE(contains(watch.out, "u (MOVIDRIVE MDX60B/61B)")) << "the nameplate names the unit: " << watch.out;
  EXPECT_EQ(run_ipos({"run", ".", "--for", "10ms"}, folder.path()).out, run.out);
  EXPECT_TRUE(contains(run_ipos({"test"}, folder.path()).out, "1 test, 1 passed"));
  const CommandResult near = run_ipos({"run", "lin.toml"}, folder.path());
  EXPECT_EQ(near.exit_code, 66);
  EXPECT_TRUE(contains(near.err, "did you mean 'line.toml'?")) << near.err;
  folder.write("two.toml", plant);
  const CommandResult two = run_ipos({"run"}, folder.path());
  EXPECT_EQ(two.exit_code, 64);
  EXPECT_TRUE(contains(two.err, "this folder has 2 plants; name one of them: line.toml, two.toml")) << two.err;
  const TemporaryFolder empty;
  EXPECT_EQ(run_ipos({"run"}, empty.path()).exit_code, 64);
}

TEST(CommandLine, AProgramOfManyStationsTellsItsMistakeOnce) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "main()\n{\n    b = 5;\n}\n");
  std::string plant;
  for (int n = 1; n <= 20; ++n)
    plant += "[[station]]\nname = \"axis" + std::to_string(n) + "\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n";
  folder.write("p.toml", plant);
  const CommandResult result = run_ipos({"run", "p.toml"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  const size_t first = result.err.find("[E0201]");
  ASSERT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("[E0201]", first + 1), std::string::npos) << result.err;
  EXPECT_TRUE(contains(result.err, "A.IPC is the program of 20 stations: axis1 to axis20")) << result.err;
}

// What the tools print can be asked for.
TEST(CommandLine, ExplainsWhatTheProgramItselfPrints) {
  const std::pair<std::vector<std::string>, std::string> rows[] = {
      {{"display", "t"}, "display t: waiting for data"},
      {{"display", "1"}, "display 1: controller inhibit"},
      {{"0503h"}, "status word 1: "},
      {{"status", "word", "1"}, "bit 0: output stage on"},
      {{"status", "word"}, "status word 1"},
      {{"IPOS", "INPUT"}, "a choice of P0"},
      {{"mdxb"}, "MOVIDRIVE MDX60B/61B"},
      {{"MDX61B0011-5A3-4-00"}, "MOVIDRIVE MDX60B/61B"},
      {{"numof"}, "number of a variable"},
      {{"3PD"}, "a choice of P"},
      {{"F47"}, "reset: "},
  };
  for (const auto& [words, part] : rows) {
    std::vector<std::string> arguments = words;
    arguments.insert(arguments.begin(), "explain");
    const CommandResult result = run_ipos(arguments);
    EXPECT_EQ(result.exit_code, 0) << words.front() << result.err;
    EXPECT_TRUE(contains(result.out, part)) << words.front() << ": " << result.out;
  }
  EXPECT_LT(run_ipos({"explain", "xyzzy"}).err.size(), 120U);
}

// All names that `ipos --help` prints at the beginning of a line.
std::set<std::string> verbs_in_help() {
  std::istringstream lines(run_ipos({"--help"}).out);
  std::set<std::string> verbs;
  for (std::string line; std::getline(lines, line);)
    if (line.size() > 3 && line.starts_with("  ") && line[2] != ' ' && line[2] != '-' && !line.starts_with("  ipos "))
      verbs.insert(line.substr(2, line.find(' ', 2) - 2));
  return verbs;
}

// What may stand for the last word, without what it does.
std::string completed(std::vector<std::string> words, const std::filesystem::path& folder = {}) {
  words.insert(words.begin(), {"complete", "--"});
  std::istringstream lines(run_ipos(words, folder).out);
  std::string text;
  for (std::string line; std::getline(lines, line);) text += (text.empty() ? "" : " ") + line.substr(0, line.find('\t'));
  return text;
}

TEST(CommandLine, TheManualPageAndTheCompletionHaveEveryVerb) {
  const std::set<std::string> verbs = verbs_in_help();
  EXPECT_GE(verbs.size(), 23U);
  const std::string page = run_ipos({"man"}).out;
  EXPECT_FALSE(contains(page, "ipos complete"));
  for (const std::string& verb : verbs) {
    EXPECT_TRUE(contains(page, "\n.SS ipos " + verb + "\n")) << verb;
    EXPECT_TRUE(contains(" " + completed({""}) + " ", " " + verb + " ")) << verb;
  }
}

TEST(CommandLine, CompletesWhatTablesAndThePlantKnow) {
  const TemporaryFolder folder;
  folder.write("line.toml", "[[station]]\nname = \"saw\"\nunit = \"mdxb\"\n[[station]]\nname = \"feed\"\nunit = \"mc07\"\n");
  EXPECT_EQ(completed({"run", "x.IPC", "--unit", "mc"}), "mc07 mc31 mc07b");
  EXPECT_EQ(completed({"param", "list", "--unit", "mdx"}), "mdxb");
  EXPECT_EQ(completed({"build", "x.IPC", "--emit=to"}), "--emit=tokens");
  EXPECT_EQ(completed({"build", "x.IPC", "--emit", "=", "to"}), "tokens");
  EXPECT_EQ(completed({"param", "get", "line.toml", "--station", ""}, folder.path()), "saw feed");
  EXPECT_EQ(completed({"param", "get", "line.toml", "P13"}, folder.path()),
            "P130 P131 P132 P133 P134 P135 P136 P137 P138");
  EXPECT_EQ(completed({"run", "line.toml", "--signals", "saw.spe"}, folder.path()), "saw.speed");
  EXPECT_EQ(completed({"run", "line.toml", "--signals", "saw.speed,feed.spe"}, folder.path()), "saw.speed,feed.speed");
  EXPECT_EQ(completed({"run", "broken.toml", "--signals", "saw.spe"}, folder.path()), "");
  EXPECT_EQ(completed({"new", "x", "--from", "hoi"}), "hoist");
  EXPECT_EQ(completed({"explain", "F4"}).substr(0, 3), "F41");
  EXPECT_EQ(completed({"run", "--coverage", "x.IP"}), "") << "a file, by the shell itself";
}

// What bash offers behind the words of a line; the last one is being typed.
std::string offered(const std::filesystem::path& script, const std::string& words) {
  const std::string command = "bash -c 'source " + script.string() + "; COMP_WORDS=(" + ipos_program() + " " + words +
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
  EXPECT_EQ(offered(script, "bui"), "build");
  EXPECT_EQ(offered(script, "bus \"\""), "plan decode monitor load replay dbc dissector --help");
  EXPECT_EQ(offered(script, "bus p"), "plan");
  EXPECT_EQ(offered(script, "run --engi"), "--engine");
  EXPECT_EQ(offered(script, "run --engine \"\""), "reference fast native");
  EXPECT_EQ(offered(script, "run --engine f"), "fast");
  EXPECT_EQ(offered(script, "run plant"), "");  // files, by bash itself
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
