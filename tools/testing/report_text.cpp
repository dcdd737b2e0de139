// Results for people. No wall-clock time but in durations(): the same tests give the same text.
#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/xml_text.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

void add_list(std::string& text, std::string_view title, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  text += fmt::format("    {}:\n", title);
  for (const std::string& line : lines) text += fmt::format("      {}\n", line);
}

// Bold green for what is good, bold red for what is not.
std::string painted(std::string text, bool good, bool colours) {
  return colours ? fmt::format("\033[1;{}m{}\033[0m", good ? 32 : 31, text) : text;
}

}  // namespace

std::string text_of_finding(const Finding& finding) {
  std::string text =
      fmt::format("  {}:{}:{}: {}\n", finding.file, finding.place.line, finding.place.column, finding.text);
  if (!finding.note.empty()) text += fmt::format("    ({})\n", finding.note);
  const size_t width = std::to_string(finding.place.line + finding.source.size()).size();
  for (size_t n = 0; n < finding.source.size(); ++n)
    text += fmt::format("    {} {:>{}} | {}\n", n == 0 ? '>' : ' ', finding.place.line + n, width,
                        finding.source[n]);
  add_list(text, "values", finding.values);
  add_list(text, "programs", finding.tasks);
  add_list(text, "last frames", finding.frames);
  add_list(text, "why", finding.reasons);
  return text;
}

std::string_view word_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::Passed: return "ok";
    case Outcome::Failed: return "FAILED";
    case Outcome::Malformed: return "ERROR";
    case Outcome::NotRun: break;
  }
  return "not run";
}

size_t count(const std::vector<TestResult>& results, Outcome outcome) {
  return static_cast<size_t>(std::count_if(
      results.begin(), results.end(), [&](const TestResult& result) { return result.outcome == outcome; }));
}

std::string text_of(const TestResult& result, bool colours) {
  std::string text = result.name;
  if (result.outcome == Outcome::Passed || result.outcome == Outcome::Failed)
    text += fmt::format("  {} {} in {:.3f} s", result.checks, result.checks == 1 ? "check" : "checks",
                        static_cast<double>(result.time) / 1e9);
  if (result.outcome == Outcome::Failed && result.seed != 0) text += fmt::format(", seed {}", result.seed);
  text += '\n';
  if (result.outcome == Outcome::Malformed) text += result.messages;
  for (const Finding& finding : result.findings) text += text_of_finding(finding);
  const std::string word = fmt::format("{:<8}", word_of(result.outcome));
  return painted(word, result.outcome == Outcome::Passed, colours && result.outcome != Outcome::NotRun) +
         utf8(text);
}

std::string summary(const std::vector<TestResult>& results, bool colours) {
  std::string text = fmt::format("{} {}, {} passed", results.size(), results.size() == 1 ? "test" : "tests",
                                 count(results, Outcome::Passed));
  for (const auto& [outcome, word] : {std::pair{Outcome::Failed, "failed"},
                                      {Outcome::Malformed, "with errors"},
                                      {Outcome::NotRun, "not run"}})
    if (const size_t number = count(results, outcome); number != 0)
      text += fmt::format(", {} {}", number, word);
  return painted(text, count(results, Outcome::Passed) == results.size(), colours) + '\n';
}

std::string durations(const std::vector<TestResult>& results, size_t most) {
  std::vector<const TestResult*> slowest;
  for (const TestResult& result : results) slowest.push_back(&result);
  std::stable_sort(slowest.begin(), slowest.end(),
                   [](const TestResult* a, const TestResult* b) { return a->seconds > b->seconds; });
  slowest.resize(std::min(most, slowest.size()));
  std::string text = "longest on the clock:\n";
  for (const TestResult* result : slowest)
    text += fmt::format("{:9.3f} s  {}\n", result->seconds, utf8(result->name));
  return text;
}

}  // namespace ipos::tools::testing
