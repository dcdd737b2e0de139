// `ipos test --artifacts DIR`: what helps to see why a test failed, in a folder of its own for each. The test is
// run once more, which gives the same run, and this time everything is recorded; tests that pass cost nothing.
#pragma once

#include <string>
#include <vector>

#include "tools/testing/suite.hpp"

namespace ipos::tools::testing {

// The folder of each result: the name of its test as a name of a file, and no two alike.
std::vector<std::string> artifact_folders(const std::vector<TestResult>& results);

// Of each result that did not pass: plot.html, trace.csv, trace.vcd, bus.pcapng, journal.txt, report.txt, and state.ipos for
// `ipos serve`. `results`
// are those of run_suite() with these tests.
void write_artifacts(const std::string& folder, const std::vector<TestCase>& tests,
                     const std::vector<TestResult>& results, const SuiteOptions& options);

}  // namespace ipos::tools::testing
