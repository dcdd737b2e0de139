// See npm_package.hpp. No script of a package is run: some would fetch programs from elsewhere.
#include "tests/editor/npm_package.hpp"

#include <gtest/gtest.h>

#include <regex>

#include "tests/tools/command.hpp"

namespace ipos::tests {

namespace fs = std::filesystem;

namespace {

// What npm prints when nobody answers, or nobody that has packages.
bool unreachable(const std::string& output) {
  static const std::regex kNetwork(
      "ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|ERR_SOCKET_TIMEOUT|E50["
      "0-9]|"
      "network request|CERT");
  return std::regex_search(output, kNetwork);
}

}  // namespace

ScriptResult shell(const fs::path& folder, const std::string& command) {
  return run_script({"/bin/sh", "-c", "cd '" + folder.string() + "' && exec 2>&1; " + command});
}

Package install_package(const std::string& source, const fs::path& packages) {
  Package package;
  package.folder = packages / fs::path(source).filename();
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
  const ScriptResult result = shell(
      package.folder, "npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1");
  if (result.exit_code == 0) return package;
  if (unreachable(result.output))
    package.missing = "the npm registry cannot be reached";
  else
    package.broken = result.output;
  return package;
}

void expect_node_passed(const ScriptResult& result, int count) {
  EXPECT_EQ(result.exit_code, 0) << result.output;
  std::smatch passed;
  const std::regex line("(#|ℹ) pass (\\d+)");
  ASSERT_TRUE(std::regex_search(result.output, passed, line)) << result.output;
  EXPECT_GE(std::stoi(passed[2]), count) << result.output;
}

}  // namespace ipos::tests
