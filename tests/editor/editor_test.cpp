// The npm side: the language server driven by the packages editors use, and the tests and the package of the
// VS Code extension. Packages are installed into the build tree; without node or without a registry the tests
// are skipped.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/editor/npm_package.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

const std::string kProgram = "IPOS_PROGRAM='" IPOS_PROGRAM "' ";

const Package& clients() {
  static const Package made = install_package("tests/editor", IPOS_PACKAGES_DIR);
  return made;
}

TEST(DebugAdapter, AnswersThePackageOfEditors) {
  const Package& package = clients();
  if (!package.missing.empty()) GTEST_SKIP() << package.missing;
  ASSERT_EQ(package.broken, "");
  expect_node_passed(shell(package.folder, kProgram + "node --test --test-reporter=tap dap.test.mjs"), 4);
}

TEST(LanguageServer, AnswersThePackagesOfEditors) {
  const Package& package = clients();
  if (!package.missing.empty()) GTEST_SKIP() << package.missing;
  ASSERT_EQ(package.broken, "");
  expect_node_passed(shell(package.folder, kProgram + "node --test --test-reporter=tap lsp.test.mjs"), 13);
}

class Extension : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!package().missing.empty()) GTEST_SKIP() << package().missing;
    ASSERT_EQ(package().broken, "");
  }
  static const Package& package() {
    static const Package made = install_package("tools/vscode", IPOS_PACKAGES_DIR);
    return made;
  }
};

TEST_F(Extension, CompilesAndPassesItsTests) {
  expect_node_passed(shell(package().folder, kProgram + "npm test"), 6);
}

TEST_F(Extension, GrammarGivesTheScopesItsTestsExpect) {
  const ScriptResult result = shell(package().folder, "npm run test:grammar");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(Extension, IsPackedByOneCommandAndStartsOutOfItsPackage) {
  fs::remove(package().folder / "ipos.vsix");
  const ScriptResult result = shell(package().folder, "npm run package");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  ASSERT_TRUE(fs::exists(package().folder / "ipos.vsix")) << result.output;
  EXPECT_GT(fs::file_size(package().folder / "ipos.vsix"), 100'000U);
  EXPECT_EQ(result.output.find("launch.test.js"), std::string::npos) << "tests are in the package";
  const std::string vsix = "IPOS_VSIX='" + (package().folder / "ipos.vsix").string() + "' ";
  expect_node_passed(
      shell(project("tests/editor"), kProgram + vsix + "node --test --test-reporter=tap extension.test.mjs"), 3);
}

}  // namespace
}  // namespace ipos::tests
