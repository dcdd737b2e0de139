// ipos test: finds tests, runs them and tells what is wrong.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <thread>

#include "stdlib/unit_types.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/coverage/collector.hpp"
#include "tools/coverage/coverage_reports.hpp"
#include "tools/input/program.hpp"
#include "tools/testing/read_tests.hpp"
#include "tools/testing/reports.hpp"
#include "tools/testing/suite.hpp"

namespace ipos::tools {
namespace {

using namespace testing;

struct TestFlags {
  std::vector<std::string> paths;
  std::vector<std::string> filters;
  bool list = false;
  SuiteOptions suite;
  std::string junit;
  std::string tap;
  std::string json;
  std::vector<std::string> coverage;
};

// Coverage of all tests together; they run on several threads.
class TotalCoverage {
 public:
  // Lives as long as the plant of one test.
  std::shared_ptr<void> watch(runtime::Plant& plant) {
    return {new coverage::Collector(plant), [this](coverage::Collector* collector) {
              const std::lock_guard lock(mutex_);
              total_.merge(collector->coverage());
              delete collector;
            }};
  }
  const coverage::Coverage& total() const { return total_; }

 private:
  std::mutex mutex_;
  coverage::Coverage total_;
};

std::vector<TestCase> find_tests(const TestFlags& flags) {
  std::vector<TestCase> tests;
  for (const std::string& path : flags.paths)
    for (TestCase& test : read_tests(path)) tests.push_back(std::move(test));
  if (!flags.filters.empty())
    std::erase_if(tests, [&](const TestCase& test) {
      return std::none_of(flags.filters.begin(), flags.filters.end(),
                          [&](const std::string& filter) { return matches(filter, test.name); });
    });
  return tests;
}

void write_report(const std::string& path, const std::string& text) {
  if (!path.empty()) replace_file(path, text);
}

// Refused before anything runs.
void check_flags(const TestFlags& flags) {
  const CompileFlags& compile = flags.suite.compile;
  if (!compile.unit.empty() && stdlib::find_unit(compile.unit) == nullptr)
    throw Failure(kUsage, fmt::format("'{}' is no unit type", compile.unit));
  if (compile.diagnostics != "text")
    throw Failure(kUsage, "the messages of programs are part of the report; --json has them");
  if (is_standard_output(flags.junit) + is_standard_output(flags.tap) + is_standard_output(flags.json) > 1)
    throw Failure(kUsage, "only one report can go to standard output");
}

int run(TestFlags& flags) {
  check_flags(flags);
  const std::vector<TestCase> tests = find_tests(flags);
  // A report on standard output stands alone.
  const bool alone =
      is_standard_output(flags.junit) || is_standard_output(flags.tap) || is_standard_output(flags.json);
  CoverageReports coverage_reports(flags.coverage, alone);
  if (tests.empty()) {
    fmt::print(stderr, "ipos: there is no test{} in {}\n", flags.filters.empty() ? "" : " of that name",
               fmt::join(flags.paths, " "));
    return kFindings;
  }
  if (flags.list) {
    for (const TestCase& test : tests) fmt::print("{}  {}:{}\n", test.name, test.file, test.place.line);
    return kGood;
  }
  for (const std::string& report : {flags.junit, flags.tap, flags.json}) check_output(report);
  catch_interrupts();
  TotalCoverage coverage;
  if (coverage_reports.wanted()) {
    coverage_reports.check();
    flags.suite.run.prepare = [&](runtime::Plant& plant) { return coverage.watch(plant); };
  }
  const bool progress = isatty(STDERR_FILENO) != 0;
  size_t bad = 0;
  const std::vector<TestResult> results =
      run_suite(tests, flags.suite, [&](const TestResult& result, size_t done, size_t total) {
        if (progress) fmt::print(stderr, "\r\033[K");
        if (!alone) fmt::print("{}", text_of(result));
        std::fflush(stdout);
        bad += result.outcome == Outcome::Passed ? 0U : 1U;
        if (progress && done < total) fmt::print(stderr, "{} of {}, {} not passed", done, total, bad);
      });
  if (!alone) fmt::print("{}", summary(results));
  write_report(flags.junit, junit_report(results));
  write_report(flags.tap, tap_report(results));
  write_report(flags.json, json_report(results));
  coverage_reports.write(coverage.total());
  if (interrupted()) return kInterrupted;
  const auto any = [&](Outcome outcome) {
    return std::any_of(results.begin(), results.end(),
                       [&](const TestResult& r) { return r.outcome == outcome; });
  };
  if (any(Outcome::Malformed)) return kBadInput;
  return any(Outcome::Failed) ? kFindings : kGood;
}

}  // namespace

void add_test(cli::Verb& app) {
  auto flags = std::make_shared<TestFlags>();
  flags->suite.jobs = std::max(1U, std::thread::hardware_concurrency());
  cli::Verb& verb = app.verb("test", "run the tests of plants and programs");
  verb.option("PATH", flags->paths, "*.test.toml, plant, program with // expect comments, or folder of them")
      .required();
  verb.option("--filter", flags->filters, "only tests whose name matches, for example 'examples/*/scom*'")
      .separated_by(',')
      .one_each();
  verb.flag("--list", flags->list, "tell the names and run nothing");
  verb.option("--jobs,-j", flags->suite.jobs, "tests at a time; default: the number of cores")
      .between(1U, 256U);
  verb.option("--seed", flags->suite.run.seed, "moves the seeds of faults that strike by chance");
  verb.option("--repeat", flags->suite.repeat, "run every test so often, each time with the next seed")
      .between(1U, 1'000'000U);
  verb.flag("--fail-fast", flags->suite.fail_fast, "begin no test any more when one has not passed");
  verb.option("--speed", flags->suite.run.speed,
              "commands per ms of every task, instead of P938 and P939, where the test does not say")
      .between(1U, 1'000'000U);
  verb.option("--junit", flags->junit, "write a report as JUnit XML; - is standard output");
  verb.option("--tap", flags->tap, "write a report as TAP 14");
  verb.option("--json", flags->json, "write a report as JSON");
  add_coverage_option(verb, flags->coverage);
  add_compile_options(verb, flags->suite.compile);
  verb.footer("Example:\n  ipos test examples --junit report.xml");
  verb.runs([flags] { return run(*flags); });
}

}  // namespace ipos::tools
