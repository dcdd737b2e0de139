// ipos test: finds tests, runs them and tells what is wrong.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string_view>
#include <thread>

#include "compiler/diag/places.hpp"
#include "runtime/plant_file/state_names.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/output_forms.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/coverage/collector.hpp"
#include "tools/coverage/coverage_reports.hpp"
#include "tools/test/mutate.hpp"
#include "tools/test_file/read_tests.hpp"
#include "tools/testing/artifacts.hpp"
#include "tools/testing/changes.hpp"
#include "tools/testing/last_failed.hpp"
#include "tools/testing/pattern.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"
#include "tools/testing/suite.hpp"

namespace ipos::tools {
namespace {

using namespace testing;

struct TestFlags {
  std::vector<std::string> paths;
  std::vector<std::string> filters;
  bool list = false;
  bool last_failed = false;
  bool watch = false;
  bool mutate = false;
  uint32_t durations = 0;
  std::string format;
  SuiteOptions suite;
  std::string junit;
  std::string tap;
  std::string json;
  std::string html;
  std::string artifacts;
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

// Of all tests those that --filter and --last-failed leave.
std::vector<TestCase> find_tests(const TestFlags& flags, const LastFailed& last_failed) {
  std::vector<TestCase> tests;
  for (const std::string& path : flags.paths)
    for (TestCase& test : read_tests(path)) tests.push_back(std::move(test));
  if (!flags.filters.empty())
    std::erase_if(tests, [&](const TestCase& test) {
      return std::none_of(flags.filters.begin(), flags.filters.end(),
                          [&](const std::string& filter) { return is_chosen(filter, test.name); });
    });
  if (!flags.last_failed) return tests;
  const auto failed = [&](const TestCase& test) { return last_failed.names().contains(test.name); };
  if (std::none_of(tests.begin(), tests.end(), failed))
    fmt::print(stderr, "ipos: none of these tests failed last time: all are run\n");
  else
    std::erase_if(tests, std::not_fn(failed));
  return tests;
}

void write_report(const std::string& path, const std::string& text) {
  if (!path.empty()) replace_file(path, text);
}

// Refused before anything runs.
void check_flags(const TestFlags& flags) {
  const CompileFlags& compile = flags.suite.compile;
  if (!compile.unit.empty() && stdlib::find_unit_or_plate(compile.unit) == nullptr)
    throw Failure(kUsage, stdlib::no_unit_text(compile.unit));
  if (compile.diagnostics != "text")
    throw Failure(kUsage, "the messages of programs are part of the report; --json has them");
  if (is_standard_output(flags.junit) + is_standard_output(flags.tap) + is_standard_output(flags.json) > 1)
    throw Failure(kUsage, "only one report can go to standard output");
  if (flags.mutate && (flags.watch || flags.suite.fail_fast || flags.suite.repeat > 1 || flags.durations != 0 ||
                       !flags.tap.empty() || !flags.artifacts.empty() || !flags.coverage.empty()))
    throw Failure(kUsage, "--mutate has no --watch, --fail-fast, --repeat, --durations, --tap, --artifacts or --coverage");
  output_ending("--junit", flags.junit);
  output_ending("--tap", flags.tap);
  output_ending("--json", flags.json);
  output_ending("--html", flags.html);
}

// In steps of GitHub's, its variable says so.
bool for_github(const TestFlags& flags) {
  const char* in_action = std::getenv("GITHUB_ACTIONS");
  return flags.format.empty() ? in_action != nullptr && in_action == std::string_view("true")
                              : flags.format == "github";
}

std::string root_of_github() {
  const char* root = std::getenv("GITHUB_WORKSPACE");
  return root == nullptr ? std::string() : std::string(root);
}

// A report on standard output stands alone.
bool is_output_taken(const TestFlags& flags) {
  return is_standard_output(flags.junit) || is_standard_output(flags.tap) || is_standard_output(flags.json);
}

std::vector<TestResult> run_tests(const std::vector<TestCase>& tests, const TestFlags& flags,
                                  const SuiteOptions& options) {
  const bool alone = is_output_taken(flags);
  const bool github = for_github(flags);
  const bool progress = is_terminal(STDERR_FILENO);
  const bool colours = has_colours(STDOUT_FILENO);
  size_t bad = 0;
  const auto show = [&](size_t done) {
    if (progress && done < tests.size() * options.repeat)
      fmt::print(stderr, "{} of {}, {} not passed", done, tests.size() * options.repeat, bad);
  };
  show(0);
  Notes notes;
  const std::vector<TestResult> results =
      run_suite(tests, options, [&](const TestResult& result, size_t done, size_t) {
        if (progress) fmt::print(stderr, "\r\033[K");
        if (!alone) fmt::print("{}", text_of(result, colours));
        if (!alone && github) fmt::print("{}", github_annotations(result, root_of_github()));
        std::fflush(stdout);
        bad += result.outcome == Outcome::Passed ? 0U : 1U;
        show(done);
      }, &notes);
  for (const std::string& note : notes) fmt::print(stderr, "{}\n", note);
  if (!alone && flags.durations != 0) fmt::print("{}", durations(results, flags.durations));
  if (!alone) fmt::print("{}", summary(results, colours));
  return results;
}

// How a page names a folder: from its own folder on, where both are below the same.
std::string link_from(const std::string& page, const std::string& folder) {
  if (page.empty() || folder.empty()) return {};
  const auto base = std::filesystem::absolute(page).parent_path();
  return std::filesystem::absolute(folder)
      .lexically_normal()
      .lexically_relative(base.lexically_normal())
      .generic_string();
}

int code_of(const std::vector<TestResult>& results) {
  if (interrupted()) return kInterrupted;
  if (count(results, Outcome::Malformed) != 0) return kBadInput;
  return count(results, Outcome::Failed) != 0 ? kFindings : kGood;
}

// Once, however many tests still count in thousandths.
void tell_old_states(const std::vector<TestCase>& tests) {
  for (const TestCase& test : tests)
    for (const Item& item : test.items)
      if (const auto* expect = std::get_if<Expect>(&item.what); expect != nullptr && expect->subject.is_old())
        return fmt::print(stderr, "ipos: note: {}:{}:{}: {}\n", compiler::printable(test.file), item.place.line,
                          item.place.column, runtime::old_state(expect->subject.signal.name));
}

int run_once(const TestFlags& flags, std::vector<TestCase>& tests) {
  LastFailed last_failed(std::filesystem::current_path().string());
  tests = find_tests(flags, last_failed);
  const CoverageReports coverage_reports(flags.coverage, is_output_taken(flags));
  if (tests.empty()) {
    fmt::print(stderr, "ipos: there is no test{} in {}\n", flags.filters.empty() ? "" : " of that name",
               fmt::join(flags.paths, " "));
    return kFindings;
  }
#ifndef __EMSCRIPTEN__  // the page has to stay small, and has no --mutate
  if (flags.mutate)
    return mutate(tests, {flags.suite, flags.list, for_github(flags), root_of_github(), flags.junit, flags.json, flags.html});
#endif
  if (flags.list) {
    for (const TestCase& test : tests)
      fmt::print("{}\n", compiler::printable(fmt::format("{}  {}:{}", test.name, test.file, test.place.line)));
    return kGood;
  }
  tell_old_states(tests);
  for (const std::string& report : {flags.junit, flags.tap, flags.json, flags.html}) check_output(report);
  TotalCoverage coverage;
  SuiteOptions options = flags.suite;
  if (coverage_reports.wanted()) {
    coverage_reports.check();
    options.run.prepare = [&](runtime::Plant& plant) { return coverage.watch(plant); };
  }
  const std::vector<TestResult> results = run_tests(tests, flags, options);
  last_failed.update(tests, results);
  if (!flags.artifacts.empty()) write_artifacts(flags.artifacts, tests, results, flags.suite);
  write_report(flags.junit, junit_report(results, flags.artifacts));
  write_report(flags.tap, tap_report(results));
  write_report(flags.json, json_report(results));
  write_report(flags.html, html_report(results, link_from(flags.html, flags.artifacts)));
  coverage_reports.write(coverage.total());
  return code_of(results);
}

// Again whenever a file has changed, until Ctrl-C. A file that is being written may not be readable yet.
int watch(const TestFlags& flags) {
  std::vector<TestCase> tests;
  Changes changes(flags.paths);
  for (;;) {
    try {
      run_once(flags, tests);
    } catch (const Failure& failure) {
      fmt::print(stderr, "ipos: {}\n", compiler::printable(failure.what()));
    }
    std::fflush(stdout);
    changes.add(tests);
    fmt::print(stderr, "ipos: waiting for a change; Ctrl-C ends\n");
    if (!changes.wait()) return kInterrupted;
    fmt::print("\n");
  }
}

int run(const TestFlags& flags) {
  check_flags(flags);
  catch_interrupts();
  std::vector<TestCase> tests;
  return flags.watch && !flags.list ? watch(flags) : run_once(flags, tests);
}

}  // namespace

void add_test(cli::Verb& app) {
  auto flags = std::make_shared<TestFlags>();
  flags->suite.jobs = std::max(1U, std::thread::hardware_concurrency());
  cli::Verb& verb = app.verb("test", "run the tests of plants and programs");
  verb.option("PATH", flags->paths,
              "*.test.toml, plant with [[expect]], program with // expect comments, or folder of them; default: this folder");
  verb.option("--filter", flags->filters,
              "only tests whose name has this in it, or matches a pattern such as 'examples/*/scom*'")
      .separated_by(',')
      .one_each();
  verb.flag("--last-failed", flags->last_failed,
            "only those that did not pass when they were run last in this folder");
  verb.flag("--watch", flags->watch, "run them again whenever a file of theirs changes, until Ctrl-C");
#ifndef __EMSCRIPTEN__
  verb.flag("--mutate", flags->mutate,
            "plant mistakes into the programs, one at a time, and tell those that no test notices");
#endif
  verb.flag("--list", flags->list, "tell the names and run nothing; with --mutate: what would be planted");
  verb.option("--jobs,-j", flags->suite.jobs, "tests at a time; default: the number of cores")
      .between(1U, 256U);
  verb.option("--seed", flags->suite.run.seed, "moves the seeds of faults that strike by chance");
  verb.option("--repeat", flags->suite.repeat, "run every test so often, each time with the next seed")
      .between(1U, 1'000'000U);
  verb.option("--time-limit", flags->suite.run.limit_s,
              "seconds on the clock that a test may take; default 600. One that takes longer has failed")
      .between(1U, 1'000'000U);
  verb.flag("--fail-fast", flags->suite.fail_fast, "begin no test any more when one has not passed");
  verb.option("--speed", flags->suite.run.speed,
              "commands per ms of every task, instead of P938 and P939, where the test does not say")
      .between(1U, 1'000'000U);
  verb.option("--durations", flags->durations,
              "at the end, so many of the tests that took longest on the clock");
  verb.option("--format", flags->format,
              "github also writes a line for each failure that GitHub shows beside the source; json is --json -; default: "
              "github where "
              "GITHUB_ACTIONS is true, else text")
      .one_of({"text", "github", "json"});
  verb.option("--junit", flags->junit, "write a report as JUnit XML; - is standard output");
  verb.option("--tap", flags->tap, "write a report as TAP 13");
  verb.option("--json", flags->json, "write a report as JSON");
  verb.option("--html", flags->html, "write a report as HTML");
  verb.option("--artifacts", flags->artifacts,
              "folder for plot, trace, log of the buses and journal of every test that fails");
  add_coverage_option(verb, flags->coverage);
  add_plant_options(verb, flags->suite.compile);
  verb.footer("Examples:\n  ipos test examples --junit report.xml\n  ipos test --mutate examples/hoist");
  verb.runs([flags] {
    if (flags->paths.empty()) flags->paths.emplace_back(".");
    if (flags->format == "json") flags->json = "-";
    return run(*flags);
  });
}

}  // namespace ipos::tools
