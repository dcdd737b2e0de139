// TAP version 14 (testanything.org): a test point for each test, with a YAML block where it is not ok.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/cli/xml_text.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

// A # would begin a directive.
std::string description(std::string_view text) {
  std::string out;
  for (const char c : utf8(text)) {
    if (c == '#' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

// A JSON text is a YAML scalar.
std::string scalar(std::string_view text) { return nlohmann::json(utf8(text)).dump(); }

std::string block(std::string_view key, const std::string& text) {
  std::string out = fmt::format("  {}: |2\n", key);
  std::istringstream lines(utf8(text));
  for (std::string line; std::getline(lines, line);) out += "    " + line + "\n";
  return out;
}

std::string yaml(const TestResult& result) {
  std::string text = "  ---\n";
  if (result.outcome == Outcome::Malformed) {
    text += fmt::format("  message: {}\n  severity: error\n",
                        scalar(result.messages.substr(0, result.messages.find('\n'))));
    text += block("output", result.messages);
    return text + "  ...\n";
  }
  const Finding& first = result.findings.front();
  text += fmt::format("  message: {}\n  severity: fail\n  at:\n    file: {}\n    line: {}\n    column: {}\n",
                      scalar(first.text), scalar(first.file), first.place.line, first.place.column);
  std::string all;
  for (const Finding& finding : result.findings) all += text_of_finding(finding);
  return text + block("output", all) + "  ...\n";
}

}  // namespace

std::string tap_report(const std::vector<TestResult>& results) {
  std::string text = fmt::format("TAP version 14\n1..{}\n", results.size());
  for (size_t n = 0; n < results.size(); ++n) {
    const TestResult& result = results[n];
    const bool good = result.outcome == Outcome::Passed || result.outcome == Outcome::NotRun;
    text += fmt::format("{}ok {} - {}{}\n", good ? "" : "not ", n + 1, description(result.name),
                        result.outcome == Outcome::NotRun ? " # SKIP a test before it failed" : "");
    if (!good) text += yaml(result);
  }
  return text;
}

}  // namespace ipos::tools::testing
