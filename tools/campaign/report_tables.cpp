// CSV as RFC 4180 has it, and JUnit XML.
#include <fmt/format.h>

#include <algorithm>

#include "tools/campaign/reports.hpp"
#include "tools/cli/xml_text.hpp"

namespace ipos::tools::campaign {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string values_text(const Outline& outline, const Levels& levels) {
  std::string text;
  for (size_t n = 0; n < levels.size(); ++n)
    text += fmt::format("{}{} = {}", n == 0 ? "" : ", ", outline.factors[n].name, outline.factors[n].levels[levels[n]].text);
  return text;
}

std::string csv_report(const Results& results) {
  const Outline& outline = results.outline;
  std::string text;
  const auto add = [&](const std::string& value, bool first) {
    if (!first) text += ',';
    text += field(value);
  };
  for (size_t n = 0; n < outline.factors.size(); ++n) add(outline.factors[n].name, n == 0);
  for (size_t n = 0; n < outline.measures.size(); ++n) add(outline.measures[n].name, n == 0 && outline.factors.empty());
  text += '\n';
  for (size_t rank = 0; rank < results.rows.size(); ++rank) {
    if (!results.there[rank]) continue;
    const Row& row = results.rows[rank];
    for (size_t n = 0; n < outline.factors.size(); ++n) add(outline.factors[n].levels[results.levels[rank][n]].text, n == 0);
    for (size_t n = 0; n < outline.measures.size(); ++n) {
      const bool has_value = n < row.measures.size() && row.measures[n];
      add(has_value ? number_text(*row.measures[n]) : "", n == 0 && outline.factors.empty());
    }
    text += '\n';
  }
  return text;
}

std::string jsonl_report(const Results& results) {
  const RowWriter writer(results.outline);
  std::string text;
  for (size_t rank = 0; rank < results.rows.size(); ++rank)
    if (const Row& row = results.rows[rank]; results.there[rank])
      writer.append(text, row.id, results.levels[rank], row.measures, row.failed, row.hash, std::nullopt);
  return text;
}

std::string junit_report(const Results& results) {
  const auto there = std::count(results.there.begin(), results.there.end(), true);
  const auto failed = std::count_if(results.rows.begin(), results.rows.end(), [](const Row& row) { return !row.failed.empty(); });
  const std::string counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\"", there, failed);
  const std::string name = xml_attribute(results.outline.campaign);
  std::string text = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"ipos\" {}>\n  <testsuite name=\"{}\" {}>\n", counts, name, counts);
  for (size_t rank = 0; rank < results.rows.size(); ++rank) {
    if (!results.there[rank]) continue;
    const Row& row = results.rows[rank];
    text += fmt::format("    <testcase name=\"{} {}\" classname=\"{}\"", hex(row.id), xml_attribute(values_text(results.outline, results.levels[rank])), name);
    if (row.failed.empty()) {
      text += "/>\n";
      continue;
    }
    text += ">\n";
    // One element: a case that fails is one failure, whatever it fails of.
    std::string all;
    for (const std::string& failure : row.failed) all += failure + "\n";
    text += fmt::format("      <failure type=\"check\" message=\"{}\">{}</failure>\n    </testcase>\n", xml_attribute(row.failed.front()), xml_text(all));
  }
  return text + "  </testsuite>\n</testsuites>\n";
}

}  // namespace ipos::tools::campaign
