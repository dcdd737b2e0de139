// A plant runs as `ipos run` runs it, tests as `ipos test` does; measures and the trace hash look on.
#include "tools/campaign/case_runner.hpp"

#include <fmt/format.h>

#include <chrono>

#include "runtime/plant/trace_hash.hpp"
#include "tools/campaign/row.hpp"
#include "tools/input/engine.hpp"
#include "tools/testing/plant_builder.hpp"
#include "tools/testing/run_test.hpp"

namespace ipos::tools::campaign {
namespace {

// The process that started the worker counts the time of a case; tests must not give up before.
constexpr uint32_t kNoLimit = 100'000'000;

std::string place_text(const std::string& file, FilePlace place) { return fmt::format("{}:{}:{}", file, place.line, place.column); }

}  // namespace

// What looks on at a run.
class CaseRunner::Watch {
 public:
  Watch(const CaseRunner& runner, runtime::Plant& plant) : campaign_(runner.campaign_), plant_(plant), hash_(plant) {
    if (runner.watcher_) more_ = runner.watcher_(plant);
    meters_.reserve(campaign_.measures.size());
    for (const Measure& measure : campaign_.measures) meters_.emplace_back(measure, signals::find_signals(plant, measure.signal).value().front());
  }

  void sample(Time now) {
    hash_.sample(now);
    if (now % runtime::kMillisecond == 0)
      for (Meter& meter : meters_) meter.sample(now);
  }
  // Tests may be over before the time that is measured.
  void finish() {
    if (campaign_.tests.empty() || plant_.now() >= campaign_.duration) return;
    plant_.run_until(campaign_.duration, [this](Time now) { return sample(now), true; });
  }
  uint64_t hash() const { return hash_.value(); }
  void take_measures(std::vector<std::optional<double>>& measures) const {
    measures.clear();
    for (const Meter& meter : meters_) measures.push_back(meter.value());
  }

 private:
  const Campaign& campaign_;
  runtime::Plant& plant_;
  runtime::TraceHash hash_;
  std::vector<Meter> meters_;
  std::shared_ptr<void> more_;
};

CaseRunner::Built CaseRunner::build(const Levels& levels) {
  const Prepared& prepared = subject_.prepared(levels);
  if (!prepared.refused.empty()) return {nullptr, prepared.refused};
  if (!campaign_.tests.empty()) {
    testing::BuiltPlant built = testing::build_plant(changed(prepared.tests.front(), levels), subject_.programs(), {});
    return {std::move(built.plant), built.messages};
  }
  runtime::PlantFile file = prepared.plant;
  subject_.apply(levels, file);
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(std::move(file), prepared.programs, std::nullopt, errors, execution_of());
  if (!errors.empty()) return {nullptr, errors.front().text};
  return {std::move(plant), ""};
}

testing::TestCase CaseRunner::changed(const testing::TestCase& test, const Levels& levels) const {
  testing::TestCase changed = test;
  subject_.apply(levels, changed.plant);
  return changed;
}

std::string CaseRunner::refused(const Levels& levels) { return build(levels).refused; }

tl::expected<std::string, std::string> CaseRunner::unit_of(const std::string& signal, const Levels& levels) {
  const Built built = build(levels);
  if (!built.plant) return tl::unexpected(built.refused);
  const auto found = signals::find_signals(*built.plant, signal);
  if (!found) return tl::unexpected(found.error());
  if (found->size() != 1) return tl::unexpected(fmt::format("'{}' is {} signals; a measure has one", signal, found->size()));
  return found->front().unit;
}

void CaseRunner::run_plant(const Levels& levels, Outcome& outcome) {
  const Built built = build(levels);
  if (!built.plant) {
    outcome.failed.push_back("refused: " + built.refused);
    return;
  }
  runtime::Plant& plant = *built.plant;
  Watch watch(*this, plant);
  plant.run_until(campaign_.duration, [&](Time now) { return watch.sample(now), true; });
  plant.store_memories();
  const auto place = [&](FilePlace at) { return place_text(campaign_.name_of(campaign_.plant), at); };
  for (const runtime::ExpectationResult& result : plant.results()) {
    const runtime::Expectation& one = *result.expectation;
    if (!result.met)
      outcome.failed.push_back(fmt::format("{}: {} of {} is {} at {}, expected {}", place(one.place), one.signal.name,
                                           one.signal.station, runtime::decimal_text(result.actual, one.signal.decimals),
                                           testing::time_text(one.at), runtime::decimal_text(one.equals, one.signal.decimals)));
  }
  for (const runtime::PlantError& failure : plant.machines().failures())
    outcome.failed.push_back(fmt::format("{}: {}", place(failure.place), failure.text));
  for (const runtime::Station* station : plant.unforeseen_faults())
    outcome.failed.push_back(fmt::format("{}: has fault F{:02}", station->config().name, station->fault()));
  watch.take_measures(outcome.measures);
  outcome.hash = watch.hash();
}

void CaseRunner::run_tests(const Levels& levels, Outcome& outcome) {
  const Prepared& prepared = subject_.prepared(levels);
  if (!prepared.refused.empty()) {
    outcome.failed.push_back("refused: " + prepared.refused);
    return;
  }
  runtime::NumberHash all;
  uint64_t last = 0;
  for (const testing::TestCase& test : prepared.tests) {
    const testing::TestCase with_values = changed(test, levels);
    std::shared_ptr<Watch> watch;
    testing::RunOptions options;
    options.limit_s = kNoLimit;
    options.prepare = [&](runtime::Plant& plant) { return watch = std::make_shared<Watch>(*this, plant); };
    options.sample = [&](Time now) { watch->sample(now); };
    options.finish = [&] {
      watch->finish();
      last = watch->hash();
      all.add(last);
      watch->take_measures(outcome.measures);
      watch.reset();
    };
    const testing::TestResult result = testing::run_test(with_values, subject_.programs(), options);
    for (const testing::Finding& finding : result.findings)
      outcome.failed.push_back(fmt::format("{}: {}", place_text(campaign_.name_of(finding.file), finding.place), finding.text));
    if (!result.messages.empty()) outcome.failed.push_back("refused: " + result.messages);
    if (teller_) teller_(result);
  }
  outcome.hash = prepared.tests.size() == 1 ? last : all.value();
}

void CaseRunner::judge_measures(Outcome& outcome) const {
  for (size_t n = 0; n < outcome.measures.size(); ++n) {
    const MeasureOutline& row = campaign_.outline.measures[n];
    const std::optional<double>& value = outcome.measures[n];
    if (!value && (row.at_least || row.at_most)) outcome.failed.push_back(fmt::format("{}: has no value", row.name));
    if (value && row.at_most && *value > *row.at_most)
      outcome.failed.push_back(fmt::format("{}: {} is more than {}", row.name, number_text(*value), number_text(*row.at_most)));
    if (value && row.at_least && *value < *row.at_least)
      outcome.failed.push_back(fmt::format("{}: {} is less than {}", row.name, number_text(*value), number_text(*row.at_least)));
  }
}

Outcome CaseRunner::run(const Levels& levels) {
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome;
  campaign_.tests.empty() ? run_plant(levels, outcome) : run_tests(levels, outcome);
  judge_measures(outcome);
  outcome.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

}  // namespace ipos::tools::campaign
