// Runs a script and reads what it says of its checks: lines "ok NAME", "FAIL NAME: ..."
// and "end" at the end (checks.py).
#pragma once

#include <string>
#include <vector>

namespace ipos::tests {

struct ScriptResult {
  int exit_code;  // -1 when it did not end by itself
  std::string output;
};

// Standard output and errors of a program found by its path.
ScriptResult run_script(const std::vector<std::string>& command);

// Debian's Python, the one that has python3-can and python3-serial.
inline constexpr const char* kPython = "/usr/bin/python3";

// Adds a failure for each FAIL, for an output without "end", and for fewer than `checks` checks.
void expect_all_ok(const std::string& output, size_t checks);

}  // namespace ipos::tests
