// JUnit XML as Jenkins' schema has it (junit-10.xsd): a testsuite for each file, a testcase for each test. A
// test that was not met is a failure, a malformed one an error. What was kept of a test is told as GitLab and the JUnit
// Attachments plugin of Jenkins read it, [[ATTACHMENT|path]] on a line of system-out.
#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/files.hpp"
#include "tools/cli/xml_text.hpp"
#include "tools/testing/artifacts.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

std::string attachments(const std::string& folder) {
  std::vector<std::string> names = list_files(folder);
  std::sort(names.begin(), names.end());
  std::string lines;
  for (const std::string& name : names) lines += fmt::format("[[ATTACHMENT|{}/{}]]\n", folder, name);
  return lines.empty() ? "" : fmt::format("      <system-out>{}</system-out>\n", xml_text(lines));
}

// `folder` is that of its artifacts, empty without them.
std::string testcase(const TestResult& result, const std::string& folder) {
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
  if (!folder.empty() && result.outcome != Outcome::NotRun) text += attachments(folder);
  return text + "    </testcase>\n";
}

std::string counts(const std::vector<TestResult>& results) {
  double seconds = 0;
  for (const TestResult& result : results) seconds += result.seconds;
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", results.size(),
                     count(results, Outcome::Failed), count(results, Outcome::Malformed), seconds);
}

}  // namespace

std::string junit_report(const std::vector<TestResult>& results, const std::string& artifacts) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"ipos\" {}>\n", counts(results));
  const std::vector<std::string> folders = artifact_folders(results);
  std::vector<std::vector<TestResult>> suites;
  std::vector<std::string> cases;  // of each suite
  for (size_t n = 0; n < results.size(); ++n) {
    size_t suite = 0;
    while (suite < suites.size() && suites[suite].front().file != results[n].file) ++suite;
    if (suite == suites.size()) suites.emplace_back(), cases.emplace_back();
    suites[suite].push_back(results[n]);
    cases[suite] += testcase(results[n], artifacts.empty() ? "" : artifacts + "/" + folders[n]);
  }
  for (size_t n = 0; n < suites.size(); ++n) {
    const std::string file = xml_attribute(suites[n].front().file);
    text += fmt::format("  <testsuite name=\"{0}\" {1} skipped=\"{2}\" file=\"{0}\">\n", file, counts(suites[n]), count(suites[n], Outcome::NotRun));
    text += cases[n] + "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace ipos::tools::testing
