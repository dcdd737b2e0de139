// TAP version 13 (testanything.org), which readers of version 14 and `prove` take: a test point for each test, with a YAML block where it is not ok.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/cli/json_text.hpp"
#include "tools/cli/text_lines.hpp"
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

// A JSON text is a YAML scalar; U+FFFE and U+FFFF are no characters of YAML but may be escaped.
std::string scalar(std::string_view text) {
  std::string out = json_text(nlohmann::json(utf8(text)));
  for (const auto& [character, escape] : {std::pair{"\xEF\xBF\xBE", "\\uFFFE"}, {"\xEF\xBF\xBF", "\\uFFFF"}})
    for (size_t at = 0; (at = out.find(character, at)) != std::string::npos;) out.replace(at, 3, escape);
  return out;
}

// Lines of a literal block, moved to the left together; the reader of `prove` knows no number after the |, no empty
// line and no first line that stands deeper. What has one of them, or a character that only an escape can say, is a
// scalar.
std::string block(std::string_view key, const std::string& text) {
  const std::vector<std::string> lines = text_lines(utf8(text));
  const auto indent = [](const std::string& line) { return std::min(line.find_first_not_of(' '), line.size()); };
  const size_t left = lines.empty() ? 0 : indent(lines.front());
  const bool plain = !lines.empty() && std::all_of(lines.begin(), lines.end(), [&](const std::string& line) {
    return indent(line) >= left && indent(line) != line.size() && line.find("\xEF\xBF") == std::string::npos;
  });
  if (!plain) return fmt::format("  {}: {}\n", key, scalar(text));
  std::string out = fmt::format("  {}: |\n", key);
  for (const std::string& line : lines) out += "    " + line.substr(left) + "\n";
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
  std::string text = fmt::format("TAP version 13\n1..{}\n", results.size());
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
