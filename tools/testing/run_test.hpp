// Carries out one test: builds its plant, goes through its items in virtual time, looks at everything that is
// expected meanwhile. Tests share nothing, so several can run at a time.
#pragma once

#include <functional>
#include <memory>

#include "tools/testing/programs.hpp"
#include "tools/testing/result.hpp"

namespace ipos::tools::testing {

// Seconds on the clock that a test may take. Ours: a hundred times what the longest tests of whole machines take.
inline constexpr uint32_t kClockLimit = 600;

struct RunOptions {
  uint32_t speed = 0;  // commands per ms of every task where the test does not say; 0: P938 and P939
  uint32_t limit_s = kClockLimit;  // on the clock; a test that takes longer has failed
  uint64_t seed = 0;   // moves the seeds of faults that strike by chance
  bool to_first_finding = false;  // nothing more is asked than whether it passes

  // Called when a plant is built, before its first event: here collectors attach themselves to the machines
  // of its stations. What it returns lives until the test is over, but not longer than the plant. Called
  // from the thread of the test.
  std::function<std::shared_ptr<void>(runtime::Plant&)> prepare{};
  // Called in every millisecond when all of it has happened, and when the test is over, before what prepare()
  // has returned is gone. May be empty.
  std::function<void(Time)> sample{};
  std::function<void()> finish{};
};

TestResult run_test(const TestCase& test, Programs& programs, const RunOptions& options);

}  // namespace ipos::tools::testing
