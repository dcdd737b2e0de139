// The npm side: the language server driven by the packages editors use, and the tests and the package of the
// VS Code extension. Packages are installed into the build tree; without node or without a registry the tests
// are skipped.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "tests/realbus/script.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

ScriptResult shell(const fs::path& folder, const std::string& command) {
  return run_script({"/bin/sh", "-c", "cd '" + folder.string() + "' && exec 2>&1; " + command});
}

// A copy of a package of the project with its dependencies, made once for all tests of it.
struct Package {
  fs::path folder;
  std::string missing;  // why it cannot be used; empty: it can
  std::string broken;   // what npm says when that is our mistake
};

// What npm prints when nobody answers, or nobody that has packages.
bool unreachable(const std::string& output) {
  static const std::regex kNetwork(
      "ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|ERR_SOCKET_TIMEOUT|E50["
      "0-9]|"
      "network request|CERT");
  return std::regex_search(output, kNetwork);
}

Package install(const std::string& source) {
  Package package;
  package.folder = fs::path(IPOS_PACKAGES_DIR) / fs::path(source).filename();
  if (shell("/", "command -v node && command -v npm").exit_code != 0) {
    package.missing = "there is no node and npm here";
    return package;
  }
  fs::create_directories(package.folder);
  for (const auto& entry : fs::directory_iterator(project(source))) {
    const std::string name = entry.path().filename().string();
    if (name == "node_modules" || name == "out") continue;
    fs::remove_all(package.folder / name);
    fs::copy(entry.path(), package.folder / name, fs::copy_options::recursive);
  }
  // No script of a package is run: some would fetch programs from elsewhere.
  const ScriptResult result = shell(
      package.folder, "npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1");
  if (result.exit_code == 0) return package;
  if (unreachable(result.output))
    package.missing = "the npm registry cannot be reached";
  else
    package.broken = result.output;
  return package;
}

// All tests of a run passed, and at least so many were run.
void expect_passed(const ScriptResult& result, int count) {
  EXPECT_EQ(result.exit_code, 0) << result.output;
  std::smatch passed;
  const std::regex line("(#|ℹ) pass (\\d+)");
  ASSERT_TRUE(std::regex_search(result.output, passed, line)) << result.output;
  EXPECT_GE(std::stoi(passed[2]), count) << result.output;
}

const std::string kProgram = "IPOS_PROGRAM='" IPOS_PROGRAM "' ";

const Package& clients() {
  static const Package made = install("tests/editor");
  return made;
}

TEST(DebugAdapter, AnswersThePackageOfEditors) {
  const Package& package = clients();
  if (!package.missing.empty()) GTEST_SKIP() << package.missing;
  ASSERT_EQ(package.broken, "");
  expect_passed(shell(package.folder, kProgram + "node --test --test-reporter=tap dap.test.mjs"), 4);
}

TEST(LanguageServer, AnswersThePackagesOfEditors) {
  const Package& package = clients();
  if (!package.missing.empty()) GTEST_SKIP() << package.missing;
  ASSERT_EQ(package.broken, "");
  expect_passed(shell(package.folder, kProgram + "node --test --test-reporter=tap lsp.test.mjs"), 12);
}

class Extension : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!package().missing.empty()) GTEST_SKIP() << package().missing;
    ASSERT_EQ(package().broken, "");
  }
  static const Package& package() {
    static const Package made = install("tools/vscode");
    return made;
  }
};

TEST_F(Extension, CompilesAndPassesItsTests) {
  expect_passed(shell(package().folder, kProgram + "npm test"), 6);
}

TEST_F(Extension, GrammarGivesTheScopesItsTestsExpect) {
  const ScriptResult result = shell(package().folder, "npm run test:grammar");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(Extension, IsPackedByOneCommand) {
  fs::remove(package().folder / "ipos.vsix");
  const ScriptResult result = shell(package().folder, "npm run package");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  ASSERT_TRUE(fs::exists(package().folder / "ipos.vsix")) << result.output;
  EXPECT_GT(fs::file_size(package().folder / "ipos.vsix"), 100'000U);
  for (const char* file : {"extension.js", "launch.js"})
    EXPECT_TRUE(fs::exists(package().folder / "out/src" / file)) << file;
  EXPECT_EQ(result.output.find("launch.test.js"), std::string::npos) << "tests are in the package";
}

}  // namespace
}  // namespace ipos::tests
