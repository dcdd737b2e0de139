// First the tests as they are, with their coverage and times; then each mistake.
#include "tools/mutants/trial.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "tools/cli/interrupt.hpp"
#include "tools/coverage/collector.hpp"
#include "tools/mutants/planting.hpp"
#include "tools/mutants/reach.hpp"
#include "tools/testing/workers.hpp"

namespace ipos::tools::mutants {
namespace {

using testing::Outcome;
using testing::TestCase;
using testing::TestResult;

class Trials {
 public:
  Trials(const std::vector<TestCase>& tests, const testing::SuiteOptions& options)
      : tests_(tests), options_(options), clean_(tests.size()), coverage_(tests.size()) {}

  // False: a test does not pass.
  bool run_clean() {
    testing::Programs programs(options_.compile);
    testing::share_work(tests_.size(), options_.jobs, [&](size_t n) {
      testing::RunOptions run = options_.run;
      run.prepare = [&](runtime::Plant& plant) -> std::shared_ptr<void> {
        return {new coverage::Collector(plant), [this, n](coverage::Collector* collector) {
                  coverage_[n] = collector->coverage();
                  delete collector;
                }};
      };
      if (!interrupted()) clean_[n] = testing::run_test(tests_[n], programs, run);
    });
    known_ = programs.known();
    return std::all_of(clean_.begin(), clean_.end(),
                       [](const TestResult& result) { return result.outcome == Outcome::Passed; });
  }
  const std::vector<TestResult>& clean() const { return clean_; }

  void run(Planting& planting, const std::function<void(const Mutant&, size_t, size_t)>& on_done) {
    const Reach reach(coverage_);
    std::vector<Planted>& mutants = planting.mutants();
    std::mutex mutex;
    size_t done = 0;
    testing::share_work(mutants.size(), options_.jobs, [&](size_t n) {
      if (mutants[n].mutant.fate != Fate::Equivalent) try_one(mutants[n], reach.of(mutants[n]));
      const std::lock_guard lock(mutex);
      on_done(mutants[n].mutant, ++done, mutants.size());
    });
  }

 private:
  void try_one(Planted& planted, std::vector<size_t> tests) const {
    std::stable_sort(tests.begin(), tests.end(), [this](size_t a, size_t b) { return clean_[a].seconds < clean_[b].seconds; });
    testing::KnownPrograms with = known_;
    for (const auto& [program, change] : planted.in) {
      auto other = std::make_shared<testing::Program>(*known_.at(program->name()));
      other->image = program->image_with(change);
      with[program->name()] = std::move(other);
    }
    testing::Programs programs(options_.compile, std::move(with));
    for (const size_t n : tests) {
      testing::RunOptions run = options_.run;
      run.to_first_finding = true;
      run.limit_s = limit_of(clean_[n].seconds, run.limit_s);
      const bool passed = testing::run_test(tests_[n], programs, run).outcome == Outcome::Passed;
      if (interrupted()) return;
      if (passed) continue;
      planted.mutant.fate = Fate::Noticed;
      planted.mutant.because = tests_[n].name;
      return;
    }
    planted.mutant.fate = tests.empty() ? Fate::Unreached : Fate::Missed;
  }

  const std::vector<TestCase>& tests_;
  const testing::SuiteOptions& options_;
  std::vector<TestResult> clean_;
  std::vector<coverage::Coverage> coverage_;
  testing::KnownPrograms known_;
};

std::vector<Mutant> results_of(Planting& planting) {
  std::vector<Mutant> mutants;
  for (Planted& planted : planting.mutants()) mutants.push_back(std::move(planted.mutant));
  return mutants;
}

}  // namespace

uint32_t limit_of(double clean_seconds, uint32_t limit_s) {
  constexpr double kLeast = 20;
  constexpr double kTimes = 20;
  return static_cast<uint32_t>(std::min(static_cast<double>(limit_s), kLeast + std::ceil(kTimes * clean_seconds)));
}

Trial try_mutants(const std::vector<TestCase>& tests, const testing::SuiteOptions& options,
                  const std::function<void(const Mutant& mutant, size_t done, size_t all)>& on_done) {
  Trials trials(tests, options);
  Trial trial;
  if (!trials.run_clean()) {
    for (const TestResult& result : trials.clean())
      if (result.outcome != Outcome::Passed) trial.not_clean.push_back(result);
    return trial;
  }
  Planting planting(tests, options.compile);
  trial.notes = planting.notes();
  for (auto& [path, text] : planting.sources()) trial.sources.push_back({path, text});
  trials.run(planting, on_done);
  trial.mutants = results_of(planting);
  return trial;
}

Trial list_mutants(const std::vector<TestCase>& tests, const testing::SuiteOptions& options) {
  Planting planting(tests, options.compile);
  Trial trial;
  trial.notes = planting.notes();
  trial.mutants = results_of(planting);
  return trial;
}

}  // namespace ipos::tools::mutants
