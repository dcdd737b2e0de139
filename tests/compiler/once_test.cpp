// A message that comes several times for one thing is told once, with a count.
#include <gtest/gtest.h>

#include "compiler/diag/once.hpp"
#include "compiler/diag/render.hpp"
#include "tests/compiler/backend_test.hpp"
#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

using compiler::test::compile_text;

std::string once(const compiler::Compilation& made) {
  return compiler::render_text(compiler::each_once(made.diagnostics.all(), *made.sources), *made.sources, false);
}

TEST(EachOnce, OfAHeaderThatIsIncludedTwice) {
  FrontendRun run("#include \"a.h\"\n#include \"a.h\"\n#include \"a.h\"\nmain() { }\n", {{"a.h", "/* one /* two */\n"}});
  run.parse();
  ASSERT_EQ(run.diagnostics.all().size(), 3U);
  const auto told = compiler::each_once(run.diagnostics.all(), run.map);
  ASSERT_EQ(told.size(), 1U);
  ASSERT_EQ(told.front().notes.size(), 1U);
  EXPECT_EQ(told.front().notes.front().text, "the same 2 more times in this place");
}

TEST(EachOnce, OfAMacroThatIsUsedAgain) {
  const compiler::Compilation made = compile_text(
      "#define BIG (100000 * 65536)\nlong a;\nmain() {\n  a = BIG;\n  H1 = a;\n  a = BIG;\n  H2 = a;\n  a = BIG;\n  H3 = a; }\n");
  ASSERT_EQ(made.diagnostics.all().size(), 3U);
  const std::string text = once(made);
  EXPECT_EQ(text.find(":4:7: warning: "), text.find(": warning: ") - 4) << text;
  EXPECT_EQ(text.find(": warning: "), text.rfind(": warning: ")) << text;
  EXPECT_NE(text.find(":6:7: note: the same in 2 more uses of the macro, the next one here\n"), std::string::npos) << text;
}

TEST(EachOnce, LeavesWhatIsWrittenTwice) {
  const compiler::Compilation made = compile_text("long a;\nmain() {\n  a = 100000 * 65536; H1 = a;\n  a = 100000 * 65536; H1 = a; }\n");
  ASSERT_EQ(made.diagnostics.all().size(), 2U);
  EXPECT_EQ(compiler::each_once(made.diagnostics.all(), *made.sources).size(), 2U);
  EXPECT_EQ(once(made).find("the same"), std::string::npos);
}

}  // namespace
}  // namespace ipos::tests
