// Runs the tests against each mistake: those that reach it, the fastest first, until one notices it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/mutants/mutant.hpp"
#include "tools/testing/suite.hpp"

namespace ipos::tools::mutants {

struct Source {
  std::string path;
  std::string text;
};

struct Trial {
  std::vector<Mutant> mutants;                 // in the order of files and lines
  std::vector<Source> sources;                 // what was planted into, as it was read
  std::vector<std::string> notes;              // about marks
  std::vector<testing::TestResult> not_clean;  // tests that do not pass without a mistake; nothing was planted then
};

// Seconds on the clock that a test may take with a mistake in its program (ours): many times what it took without one, as a
// program that waits is quicker than one that runs in circles.
uint32_t limit_of(double clean_seconds, uint32_t limit_s);

// `on_done` is told of each mistake, from one thread at a time.
Trial try_mutants(const std::vector<testing::TestCase>& tests, const testing::SuiteOptions& options,
                  const std::function<void(const Mutant& mutant, size_t done, size_t all)>& on_done);

// All that would be planted; runs nothing.
Trial list_mutants(const std::vector<testing::TestCase>& tests, const testing::SuiteOptions& options);

}  // namespace ipos::tools::mutants
