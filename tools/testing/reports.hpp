// The forms in which results are told: for people, for Jenkins and its relatives (JUnit XML), TAP 14, JSON.
// Every text is valid UTF-8.
#pragma once

#include <string>
#include <vector>

#include "tools/testing/result.hpp"

namespace ipos::tools::testing {

// One test: a line, and what is wrong with all that helps to mend it.
std::string text_of(const TestResult& result);
// "18 tests, 17 passed, 1 failed".
std::string summary(const std::vector<TestResult>& results);

std::string junit_report(const std::vector<TestResult>& results);
std::string tap_report(const std::vector<TestResult>& results);
std::string json_report(const std::vector<TestResult>& results);

}  // namespace ipos::tools::testing
