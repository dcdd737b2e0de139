// Workers take the next test; results are told in the order of the tests.
#include "tools/testing/suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "tools/cli/interrupt.hpp"

namespace ipos::tools::testing {
namespace {

class Suite {
 public:
  Suite(const std::vector<TestCase>& tests, const SuiteOptions& options, const ResultListener& on_result)
      : tests_(tests),
        options_(options),
        on_result_(on_result),
        programs_(options.compile),
        results_(tests.size() * options.repeat) {}

  std::vector<TestResult> run() {
    {
      std::vector<std::jthread> workers;
      const size_t wanted = std::min<size_t>(std::max(options_.jobs, 1U), results_.size());
      for (size_t n = 1; n < wanted; ++n) workers.emplace_back([this] { work(); });
      work();
    }
    if (failure_) std::rethrow_exception(failure_);
    std::vector<TestResult> results;
    for (std::optional<TestResult>& result : results_) results.push_back(std::move(*result));
    return results;
  }

 private:
  // An exception, say of the listener when nothing can be written, would end the program in a thread: nothing
  // is begun any more, and run() passes the first on when all workers are done.
  void work() {
    try {
      take_tests();
    } catch (...) {
      next_ = results_.size();
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }

  void take_tests() {
    for (size_t n = next_++; n < results_.size(); n = next_++) {
      TestResult result = run_one(n);
      const bool good = result.outcome == Outcome::Passed;
      const std::lock_guard lock(mutex_);
      if (!good && options_.fail_fast) stop_ = true;
      results_[n] = std::move(result);
      for (; told_ < results_.size() && results_[told_]; ++told_)
        if (on_result_) on_result_(*results_[told_], told_ + 1, results_.size());
    }
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
  std::atomic<size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  size_t told_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<TestResult> run_suite(const std::vector<TestCase>& tests, const SuiteOptions& options,
                                  const ResultListener& on_result) {
  return Suite(tests, options, on_result).run();
}

}  // namespace ipos::tools::testing
