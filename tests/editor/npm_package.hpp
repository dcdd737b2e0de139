// A package of npm as a test uses it: a copy in the build tree with its dependencies. Without node or without a
// registry its tests are skipped with the reason.
#pragma once

#include <filesystem>
#include <string>

#include "tests/realbus/script.hpp"

namespace ipos::tests {

// A command line in a folder, standard output and errors together.
ScriptResult shell(const std::filesystem::path& folder, const std::string& command);

struct Package {
  std::filesystem::path folder;
  std::string missing;  // why it cannot be used; empty: it can
  std::string broken;   // what npm says when that is our mistake
};

// Copies a folder of the project to `packages` and installs what its lock file says.
Package install_package(const std::string& source, const std::filesystem::path& packages);

// All tests of a run of node passed, and at least so many were run.
void expect_node_passed(const ScriptResult& result, int count);

}  // namespace ipos::tests
