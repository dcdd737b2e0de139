// One JSON object: totals and an entry for each test.
#include <nlohmann/json.hpp>

#include "tools/cli/xml_text.hpp"
#include "tools/cli/json_text.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

using nlohmann::ordered_json;

ordered_json list(const std::vector<std::string>& texts) {
  ordered_json out = ordered_json::array();
  for (const std::string& text : texts) out.push_back(utf8(text));
  return out;
}

ordered_json entry(const Finding& finding) {
  return {{"file", utf8(finding.file)},      {"line", finding.place.line},
          {"column", finding.place.column},  {"time_us", finding.time / runtime::kMicrosecond},
          {"message", utf8(finding.text)},   {"note", utf8(finding.note)},
          {"source", list(finding.source)},  {"values", list(finding.values)},
          {"programs", list(finding.tasks)}, {"frames", list(finding.frames)},
          {"reasons", list(finding.reasons)}};
}

const char* outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::Passed: return "passed";
    case Outcome::Failed: return "failed";
    case Outcome::Malformed: return "error";
    case Outcome::NotRun: break;
  }
  return "not_run";
}

}  // namespace

std::string json_report(const std::vector<TestResult>& results) {
  ordered_json report;
  report["tests"] = results.size();
  for (const Outcome outcome : {Outcome::Passed, Outcome::Failed, Outcome::Malformed, Outcome::NotRun})
    report[outcome_name(outcome)] = count(results, outcome);
  report["results"] = ordered_json::array();
  for (const TestResult& result : results) {
    ordered_json one{{"name", utf8(result.name)},        {"file", utf8(result.file)},
                     {"line", result.place.line},        {"outcome", outcome_name(result.outcome)},
                     {"checks", result.checks},          {"time_us", result.time / runtime::kMicrosecond},
                     {"seconds", result.seconds},        {"seed", result.seed},
                     {"messages", utf8(result.messages)}};
    one["findings"] = ordered_json::array();
    for (const Finding& finding : result.findings) one["findings"].push_back(entry(finding));
    report["results"].push_back(std::move(one));
  }
  return json_text(report, 2) + "\n";
}

}  // namespace ipos::tools::testing
