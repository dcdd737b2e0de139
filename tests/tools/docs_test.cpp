// Dumps in the documentation are real: every block that begins with "$ ipos ..." is what the program prints,
// and the tables of docs/reference/isa.md are those of the code.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "runtime/bus_plan/plan.hpp"
#include "tests/tools/command.hpp"
#include "vm/isa/isa.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {
namespace {

struct Dump {
  std::vector<std::string> arguments;
  std::string output;
};

std::vector<Dump> dumps_of(const std::string& page) {
  std::vector<Dump> dumps;
  std::istringstream in(page);
  std::string line;
  bool in_block = false, in_dump = false;
  while (std::getline(in, line)) {
    if (line.starts_with("```")) {
      in_block = !in_block;
      in_dump = false;
    } else if (in_block && line.starts_with("$ ipos ")) {
      in_dump = true;
      std::istringstream words(line.substr(7));
      dumps.emplace_back();
      for (std::string word; words >> word;) dumps.back().arguments.push_back(word);
    } else if (in_dump) {
      dumps.back().output += line + "\n";
    }
  }
  return dumps;
}

TEST(Documentation, DumpsOfTheTourAreReal) {
  const TemporaryFolder folder;  // the tour writes images
  for (const char* file : {"TOUR.IPC", "tour.toml"})
    folder.write(file, read_text(project("examples/tour") / file));
  const std::vector<Dump> dumps = dumps_of(read_text(project("docs/guide/tour.md")));
  EXPECT_GE(dumps.size(), 7U);
  for (const Dump& dump : dumps) {
    const CommandResult result = run_ipos(dump.arguments, folder.path());
    EXPECT_EQ(result.out + result.err, dump.output) << dump.arguments[0];
  }
}

TEST(Documentation, DumpsOfTheBusToolsAreReal) {
  const std::vector<Dump> dumps = dumps_of(read_text(project("docs/guide/bus-tools.md")));
  EXPECT_EQ(dumps.size(), 5U);
  for (const Dump& dump : dumps) {
    const CommandResult result = run_ipos(dump.arguments, project(""));
    EXPECT_EQ(result.out + result.err, dump.output) << dump.arguments[1];
  }
}

TEST(Documentation, BusToolsPageHasEveryFinding) {
  const std::string page = read_text(project("docs/guide/bus-tools.md"));
  for (const runtime::FindingType& type : runtime::finding_types()) {
    const std::string weight = type.weight == runtime::FindingWeight::Error ? "error" : "hint";
    const std::string row =
        "| " + std::string(type.code) + " | " + weight + " | " + std::string(type.meaning) + " |\n";
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(Documentation, DumpsOfTheParamPageAreReal) {
  const TemporaryFolder folder;
  const std::string page = read_text(project("docs/guide/param.md"));
  const size_t plant = page.find("```toml\n") + 8;
  folder.write("plant.toml", page.substr(plant, page.find("```", plant) - plant));
  const std::vector<Dump> dumps = dumps_of(page);
  EXPECT_GE(dumps.size(), 7U);
  for (const Dump& dump : dumps) {
    const CommandResult result = run_ipos(dump.arguments, folder.path());
    EXPECT_EQ(result.out + result.err, dump.output) << dump.arguments[1];
  }
  const std::string row = "  { number = \"P130\", index = 8470,";
  const std::string file = read_text(folder.path() / "mine.settings");
  const size_t at = page.find(row);
  EXPECT_NE(file.find(page.substr(at, page.find('\n', at) - at)), std::string::npos);
}

TEST(Documentation, DemoOutputInTheReadmeIsReal) {
  const CommandResult result =
      run_ipos({"run", "examples/scom/scom.toml", "--for", "1s", "--watch"}, project(""));
  const std::string readme = read_text(project("README.md"));
  EXPECT_NE(readme.find(result.out), std::string::npos) << result.out;
}

std::string escaped(std::string text) { return std::regex_replace(text, std::regex("\\|"), "\\|"); }

TEST(Documentation, InstructionSetPageHasEveryRow) {
  const std::string page = read_text(project("docs/reference/isa.md"));
  for (const vm::OpcodeInfo& row : vm::opcode_table()) {
    char code[8];
    std::snprintf(code, sizeof code, "0x%02X", static_cast<unsigned>(row.opcode));
    const std::string expected = "| " + std::string(code) + " | `" + escaped(std::string(row.text)) + "` | " +
                                 std::string(row.meaning) + " |\n";
    EXPECT_NE(page.find(expected), std::string::npos) << expected;
  }
  for (const vm::RuleInfo& rule : vm::rule_table())
    EXPECT_NE(page.find("| " + std::string(rule.code) + " | " + rule.meaning + " |\n"), std::string::npos)
        << rule.code;
}

}  // namespace
}  // namespace ipos::tests
