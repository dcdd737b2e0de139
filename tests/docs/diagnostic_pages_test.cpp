// Every message has a page in docs/reference/diagnostics whose wrong program gives it and whose mended one gives
// nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "compiler/diag/diag.hpp"
#include "tests/docs/page.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

class DiagnosticPage : public testing::TestWithParam<compiler::DiagInfo> {};

TEST_P(DiagnosticPage, ShowsTheMistakeAndItsRepair) {
  const std::string code(GetParam().code);
  const std::string page = read_text(project("docs/reference/diagnostics/" + code + ".md"));
  ASSERT_TRUE(page.starts_with("# " + code + ": ")) << "no page " << code << ".md, or another title";

  const std::vector<Block> blocks = blocks_of(page);
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(blocks[0].heading, "Wrong:");
  EXPECT_EQ(blocks[1].heading, "Right:");
  const char* const language = code.substr(1, 2) == "03" ? "ipa" : "ipc";
  EXPECT_EQ(blocks[0].language, language);
  EXPECT_EQ(blocks[1].language, language);

  const Compiled wrong = compile_block(blocks[0]);
  EXPECT_NE(std::find(wrong.codes.begin(), wrong.codes.end(), code), wrong.codes.end()) << wrong.messages;
  EXPECT_EQ(compile_block(blocks[1]).messages, "");
}

INSTANTIATE_TEST_SUITE_P(All, DiagnosticPage,
                         testing::ValuesIn(compiler::diagnostic_table().begin(),
                                           compiler::diagnostic_table().end()),
                         [](const auto& row) { return std::string(row.param.code); });

TEST(DiagnosticPages, NoneIsLeftOver) {
  std::set<std::string> known;
  for (const compiler::DiagInfo& row : compiler::diagnostic_table())
    known.insert(std::string(row.code) + ".md");
  known.insert("comparison.md");
  for (const auto& file : std::filesystem::directory_iterator(project("docs/reference/diagnostics")))
    EXPECT_TRUE(known.contains(file.path().filename().string())) << file.path();
}

}  // namespace
}  // namespace ipos::tests
