// ipos in WebAssembly does what the native program does: every example, 300 random plants and the programs of tests/language,
// in node and in Debian's Chromium. So does the npm package. And the page without a server, which opens from a file, in Chromium and in Firefox. Skipped with the reason where
// ./dev web has not been run on this commit: building it takes longer than all suites together.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/editor/npm_package.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

fs::path built() { return project("build/web"); }

// What --version names of both.
std::string commit_of(const std::string& program) {
  const std::string text = shell(".", program + " --version").output;
  const size_t at = text.find("(commit");
  return at == std::string::npos ? text : text.substr(at);
}

class InWebAssembly : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(built() / "tools/ipos.wasm"))
      GTEST_SKIP() << "build/web is not there: ./dev web makes it, ./dev check web makes it and compares";
    if (!package().missing.empty()) GTEST_SKIP() << package().missing;
    ASSERT_EQ(package().broken, "");
    const std::string in_wasm =
        commit_of("node " + project("tests/web-wasm/verb.mjs").string() + " " + (built() / "tools").string());
    if (in_wasm != commit_of(IPOS_PROGRAM)) GTEST_SKIP() << "build/web is of another commit: " << in_wasm;
  }
  static const Package& package() {
    static const Package made = install_package("web", IPOS_PACKAGES_DIR);
    return made;
  }
  static fs::path random_plants(const std::string& count) {
    fs::path plants = fs::path(IPOS_PACKAGES_DIR) / "plants";
    fs::remove_all(plants);
    EXPECT_EQ(shell(".", IPOS_RANDOM_PLANTS " " + plants.string() + " " + count).exit_code, 0);
    return plants;
  }
  // Both compare the same cases.
  static void expect_equal(const std::string& where) {
    const fs::path plants = random_plants("300");
    const ScriptResult result =
        shell(package().folder, "node " + project("tests/web-wasm/equal.mjs").string() + " " IPOS_PROGRAM " " +
                                    (built() / "tools").string() + " " + project(".").lexically_normal().string() + " " + plants.string() + " " + where);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    std::puts(result.output.c_str());
    // None was left out.
    for (const char* const group : {"examples: ", "plants: 300 cases", "language: "})
      EXPECT_NE(result.output.find(group), std::string::npos) << group;
  }
  // web/test/NAME.test.mjs, with so many tests.
  static void expect_journeys(const std::string& name, int count) {
    const ScriptResult result =
        shell(package().folder, "IPOS_PROGRAM='" IPOS_PROGRAM "' IPOS_EXAMPLES='" + project("examples").string() + "' IPOS_WEB='" +
                                    built().string() + "' node --test --test-reporter=tap test/" + name + ".test.mjs");
    expect_node_passed(result, count);
    std::puts(result.output.c_str());
  }
};

TEST_F(InWebAssembly, RunsAsNativelyInNode) { expect_equal("node"); }

// build/web/ipos-wasm, of the same commit as all of build/web.
std::string npm_package() {
  const fs::path folder = built() / "ipos-wasm";
  return fs::exists(folder / "ipos-plant.js") ? folder.string() : "";
}

TEST_F(InWebAssembly, TheNpmPackageDoesTheSameInNode) {
  if (npm_package().empty()) GTEST_SKIP() << "build/web/ipos-wasm is not there: ./dev web makes it";
  const ScriptResult result = shell(package().folder, "node " + project("tests/web-wasm/package.mjs").string() + " " IPOS_PROGRAM " " +
                                                          npm_package() + " " + project(".").lexically_normal().string() + " " +
                                                          random_plants("60").string());
  EXPECT_EQ(result.exit_code, 0) << result.output;
  std::puts(result.output.c_str());
}

class InChromium : public InWebAssembly {
 protected:
  void SetUp() override {
    InWebAssembly::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (!fs::exists("/usr/bin/chromium")) GTEST_SKIP() << "/usr/bin/chromium is not installed";
  }
};

TEST_F(InChromium, RunsAsNatively) { expect_equal("chromium"); }

TEST_F(InChromium, OpensFromAFileWithoutANetwork) { expect_journeys("alone", 9); }
TEST_F(InChromium, HasAllViewsWithoutAServer) { expect_journeys("alone_views", 7); }

TEST_F(InChromium, TheElementRunsInAPage) {
  if (npm_package().empty()) GTEST_SKIP() << "build/web/ipos-wasm is not there: ./dev web makes it";
  const ScriptResult result = shell(package().folder, "node " + project("tests/web-wasm/element.mjs").string() + " " + npm_package() +
                                                          " " + project(".").lexically_normal().string());
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(InWebAssembly, OpensInFirefox) {
  if (!fs::exists("/usr/bin/firefox-esr")) GTEST_SKIP() << "/usr/bin/firefox-esr is not installed";
  expect_journeys("firefox", 4);
}

}  // namespace
}  // namespace ipos::tests
