// Workers take the next test; results are told in the order of the tests.
#include "tools/testing/suite.hpp"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "tools/cli/interrupt.hpp"
#include "tools/testing/workers.hpp"

namespace ipos::tools::testing {
namespace {

class Suite {
 public:
  Suite(const std::vector<TestCase>& tests, const SuiteOptions& options, const ResultListener& on_result)
      : tests_(tests),
        options_(options),
        on_result_(on_result),
        programs_(options.compile),
        results_(tests.size() * options.repeat) {
    programs_.want_objects();
  }

  std::vector<TestResult> run() {
    share_work(results_.size(), options_.jobs, [this](size_t n) { take(n); });
    std::vector<TestResult> results;
    for (std::optional<TestResult>& result : results_) results.push_back(std::move(*result));
    return results;
  }

  Notes notes() const { return programs_.told_objects(); }

 private:
  void take(size_t n) {
    TestResult result = run_one(n);
    const bool good = result.outcome == Outcome::Passed;
    const std::lock_guard lock(mutex_);
    if (!good && options_.fail_fast) stop_ = true;
    results_[n] = std::move(result);
    for (; told_ < results_.size() && results_[told_]; ++told_)
      if (on_result_) on_result_(*results_[told_], told_ + 1, results_.size());
  }

  TestResult run_one(size_t n) {
    const TestCase& test = tests_[n % tests_.size()];
    const size_t turn = n / tests_.size();
    TestResult result;
    if (stop_ || interrupted()) {
      result.name = test.name;
      result.file = test.file;
      result.place = test.place;
      result.outcome = Outcome::NotRun;
    } else {
      RunOptions options = options_.run;
      options.seed += turn;
      result = run_test(test, programs_, options);
    }
    if (options_.repeat > 1) result.name += fmt::format("#{}", turn + 1);
    return result;
  }

  const std::vector<TestCase>& tests_;
  const SuiteOptions& options_;
  const ResultListener& on_result_;
  Programs programs_;
  std::vector<std::optional<TestResult>> results_;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  size_t told_ = 0;
};

}  // namespace

std::vector<TestResult> run_suite(const std::vector<TestCase>& tests, const SuiteOptions& options,
                                  const ResultListener& on_result, Notes* notes) {
  Suite suite(tests, options, on_result);
  std::vector<TestResult> results = suite.run();
  if (notes != nullptr) *notes = suite.notes();
  return results;
}

}  // namespace ipos::tools::testing
