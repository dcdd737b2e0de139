// Programs on the pages of the language compile without a message, and the page names every warning.
#include <gtest/gtest.h>

#include <regex>
#include <span>
#include <sstream>

#include "compiler/asm/disassembler.hpp"
#include "compiler/compile.hpp"
#include "compiler/diag/diag.hpp"
#include "tests/docs/page.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

TEST(LanguagePages, ProgramsAreRight) {
  for (const char* file : {"docs/guide/language.md", "docs/reference/assembler.md"}) {
    int programs = 0;
    for (const Block& block : blocks_of(read_text(project(file)))) {
      if (block.language != "ipc" && block.language != "ipa") continue;
      ++programs;
      EXPECT_EQ(compile_block(block).messages, "") << file << "\n" << block.text;
    }
    EXPECT_GE(programs, 3) << file;
  }
}

TEST(LanguagePages, EveryWarningIsListed) {
  const std::string page = read_text(project("docs/guide/language.md"));
  for (const compiler::DiagInfo& row : compiler::diagnostic_table()) {
    if (row.severity != compiler::Severity::Warning) continue;
    const std::string line = "| " + std::string(row.code) + " | `" + std::string(row.flag) + "` |";
    EXPECT_NE(page.find(line), std::string::npos) << line;
  }
}

// Commands of main up to the one that ends it.
size_t commands_of(const std::string& statement) {
  const compiler::Compilation compiled = compiler::compile(
      "MAIN.IPC", "",
      "long a, b, c, d, v[4], w[4], p;\nSCREC s, t;\nf() { d++; }\nmain() {\n" + statement + "\n}\n");
  if (!compiled.image) return 0;
  const vm::Image& image = *compiled.image;
  const size_t end = image.functions.size() > 1 ? image.functions[1].address : image.code.size();
  const auto items = compiler::code_items(std::span(image.code).first(end));
  return items.size() - (items.back().command->opcode == vm::Opcode::End ? 1 : 0);
}

TEST(LanguagePages, CostsAreReal) {
  const std::string page = read_text(project("docs/guide/language.md"));
  const size_t begin = page.find("| statement | commands |");
  ASSERT_NE(begin, std::string::npos);
  std::istringstream lines(page.substr(begin));
  int rows = 0;
  for (std::string line; std::getline(lines, line) && line.starts_with("|");) {
    if (!line.starts_with("| `")) continue;
    const size_t end = line.find("` | ");
    const std::string statement = std::regex_replace(line.substr(3, end - 3), std::regex(R"(\\\|)"), "|");
    EXPECT_EQ(line.substr(end + 4), std::to_string(commands_of(statement)) + " |") << statement;
    ++rows;
  }
  EXPECT_GE(rows, 30);
}

// In the comparison an ipos block follows each program: it is what the compiler says.
TEST(ComparisonPage, MessagesAreReal) {
  const std::vector<Block> blocks = blocks_of(read_text(project("docs/reference/diagnostics/comparison.md")));
  int compared = 0;
  for (size_t n = 0; n + 1 < blocks.size(); ++n) {
    if (blocks[n].language != "ipc") continue;
    EXPECT_EQ(blocks[n + 1].heading, "ipos:");
    EXPECT_EQ(compile_block(blocks[n]).messages, blocks[n + 1].text) << blocks[n].text;
    ++compared;
  }
  EXPECT_EQ(compared, 15);
}

}  // namespace
}  // namespace ipos::tests
