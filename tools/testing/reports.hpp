// The forms in which results are told: for people, for Jenkins and its relatives (JUnit XML), TAP 13, JSON, HTML.
// Every text is valid UTF-8.
#pragma once

#include <string>
#include <vector>

#include "tools/testing/result.hpp"

namespace ipos::tools::testing {

// One test: a line, and what is wrong with all that helps to mend it. With `colours` for a terminal.
std::string text_of(const TestResult& result, bool colours = false);
// "18 tests, 17 passed, 1 failed".
std::string summary(const std::vector<TestResult>& results, bool colours = false);
// The tests that took longest on the clock, `most` of them: a line each.
std::string durations(const std::vector<TestResult>& results, size_t most);
// A line for each thing that is wrong, for GitHub's view of a change. `root` is the folder of the repository; empty: the
// current one.
std::string github_annotations(const TestResult& result, const std::string& root);

// `artifacts`: the folder of --artifacts, which has been written, or empty.
std::string junit_report(const std::vector<TestResult>& results, const std::string& artifacts = {});
std::string tap_report(const std::vector<TestResult>& results);
std::string json_report(const std::vector<TestResult>& results);
// `artifacts`: the folder of --artifacts as a link from the report, or empty.
std::string html_report(const std::vector<TestResult>& results, const std::string& artifacts);

}  // namespace ipos::tools::testing
