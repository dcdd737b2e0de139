// The page of ipos serve: its types hold, the bundle that is checked in is that of its sources, and it does in
// Debian's Chromium what its contract says. Skipped with the reason where npm, its registry or Chromium are missing.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/editor/npm_package.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!package().missing.empty()) GTEST_SKIP() << package().missing;
    ASSERT_EQ(package().broken, "");
  }
  static const Package& package() {
    static const Package made = install_package("web", IPOS_PACKAGES_DIR);
    return made;
  }
};

TEST_F(Page, HasTypesThatHold) {
  const ScriptResult result = shell(package().folder, "npm run check");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(Page, IsTheBundleOfItsSources) {
  const ScriptResult result = shell(package().folder, "node build.mjs built.html");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  for (const std::string file : {".html", ".worker.js"})
    EXPECT_TRUE(read_text(package().folder / ("built" + file)) == read_text(project("web/dist/index" + file)))
        << "web/dist/index" << file << " is not made of web/src: run `npm ci && npm run build` in web";
  EXPECT_TRUE(read_text(package().folder / "plot.html") == read_text(project("web/dist/plot.html"))) << "web/dist/plot.html, too";
}

class Browser : public Page {
 protected:
  void SetUp() override {
    Page::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (!std::filesystem::exists("/usr/bin/chromium")) GTEST_SKIP() << "/usr/bin/chromium is not installed";
  }
  static ScriptResult run_once(const std::string& file) {
    return shell(package().folder, "IPOS_PROGRAM='" IPOS_PROGRAM "' IPOS_EXAMPLES='" + project("examples").string() +
                                       "' node --test --test-reporter=tap test/" + file);
  }
  // Journeys wait for a browser and a clock, so they may try twice; both are told.
  static ScriptResult run(const std::string& file) {
    const ScriptResult first = run_once(file);
    if (first.exit_code == 0) return first;
    std::printf("%s is tried again after\n%s\n", file.c_str(), first.output.c_str());
    return run_once(file);
  }
};

TEST_F(Browser, FindsWhatTheContractNames) { expect_node_passed(run("page.test.mjs"), 17); }

TEST_F(Browser, PutsViewsSideBySide) { expect_node_passed(run("desk.test.mjs"), 10); }

TEST_F(Browser, TurnsAnAxisByAClick) { expect_node_passed(run("plant.test.mjs"), 18); }

TEST_F(Browser, ShowsCurves) { expect_node_passed(run("scope.test.mjs"), 8); }

TEST_F(Browser, SeesMachinesMove) { expect_node_passed(run("machine.test.mjs"), 7); }

TEST_F(Browser, EditsAndRebuilds) { expect_node_passed(run("edit.test.mjs"), 7); }

TEST_F(Browser, GoesToAnyMoment) { expect_node_passed(run("timeline.test.mjs"), 5); }

TEST_F(Browser, ReadsTelegramsAndSavesThem) { expect_node_passed(run("trace.test.mjs"), 4); }

TEST_F(Browser, ComparesAndSetsParameters) { expect_node_passed(run("parameters.test.mjs"), 2); }

TEST_F(Browser, KeepsClicksAsATestAndASession) { expect_node_passed(run("keep.test.mjs"), 3); }

TEST_F(Browser, ReadsTheReportOfACampaign) { expect_node_passed(run("report.test.mjs"), 6); }

TEST_F(Browser, OpensExamplesAndBuildsAPlant) { expect_node_passed(run("gallery.test.mjs"), 2); }

TEST_F(Browser, NeedsTheKeyboardAlone) { expect_node_passed(run("keyboard.test.mjs"), 4); }

TEST_F(Browser, HearsARealDrive) { expect_node_passed(run("device.test.mjs"), 3); }

}  // namespace
}  // namespace ipos::tests
