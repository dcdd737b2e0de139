// JUnit XML as Jenkins' schema has it (junit-10.xsd): a testsuite for each file, a testcase for each test. A
// test that was not met is a failure, a malformed one an error.
#include <fmt/format.h>

#include "tools/cli/xml_text.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

std::string testcase(const TestResult& result) {
  const std::string head =
      fmt::format("    <testcase name=\"{}\" classname=\"{}\" time=\"{:.3f}\"", xml_attribute(result.name),
                  xml_attribute(result.file), result.seconds);
  if (result.outcome == Outcome::Passed) return head + "/>\n";
  std::string text = head + ">\n";
  if (result.outcome == Outcome::NotRun) text += "      <skipped message=\"a test before it failed\"/>\n";
  if (result.outcome == Outcome::Malformed)
    text += fmt::format("      <error type=\"malformed\" message=\"{}\">{}</error>\n",
                        xml_attribute(result.messages.substr(0, result.messages.find('\n'))),
                        xml_text(result.messages));
  for (const Finding& finding : result.findings)
    text += fmt::format("      <failure type=\"expectation\" message=\"{}\">{}</failure>\n",
                        xml_attribute(finding.text), xml_text(text_of_finding(finding)));
  return text + "    </testcase>\n";
}

std::string counts(const std::vector<TestResult>& results) {
  double seconds = 0;
  for (const TestResult& result : results) seconds += result.seconds;
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", results.size(),
                     count(results, Outcome::Failed), count(results, Outcome::Malformed), seconds);
}

}  // namespace

std::string junit_report(const std::vector<TestResult>& results) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"ipos\" {}>\n", counts(results));
  std::vector<std::vector<TestResult>> suites;
  for (const TestResult& result : results) {
    auto suite = suites.begin();
    while (suite != suites.end() && suite->front().file != result.file) ++suite;
    if (suite == suites.end()) suite = suites.emplace(suites.end());
    suite->push_back(result);
  }
  for (const std::vector<TestResult>& suite : suites) {
    text += fmt::format("  <testsuite name=\"{}\" {} skipped=\"{}\" file=\"{}\">\n",
                        xml_attribute(suite.front().file), counts(suite), count(suite, Outcome::NotRun),
                        xml_attribute(suite.front().file));
    for (const TestResult& result : suite) text += testcase(result);
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace ipos::tools::testing
