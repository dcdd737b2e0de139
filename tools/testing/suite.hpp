// Runs tests on several cores. Tests share nothing, so the results do not depend on how many there are.
#pragma once

#include <functional>
#include <vector>

#include "tools/input/program.hpp"
#include "tools/testing/run_test.hpp"

namespace ipos::tools::testing {

struct SuiteOptions {
  RunOptions run;
  CompileFlags compile;
  unsigned jobs = 1;
  unsigned repeat = 1;     // each time with the next seed
  bool fail_fast = false;  // nothing is begun any more after a test that did not pass
};

// Called in the order of the tests, from one thread at a time.
// What there is to say beside the results, at their end.
using Notes = std::vector<std::string>;

using ResultListener = std::function<void(const TestResult& result, size_t done, size_t total)>;

std::vector<TestResult> run_suite(const std::vector<TestCase>& tests, const SuiteOptions& options,
                                  const ResultListener& on_result = {}, Notes* notes = nullptr);

}  // namespace ipos::tools::testing
