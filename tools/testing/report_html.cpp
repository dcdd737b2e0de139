// One HTML file for a browser: the tests in a table, what is wrong with those that did not pass, and the way
// to their artifacts.
#include <fmt/format.h>

#include "tools/cli/xml_text.hpp"
#include "tools/testing/artifacts.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

constexpr std::string_view kHead =
    "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">"
    "<title>ipos test</title>\n<style>\n"
    "body { font: 14px sans-serif; margin: 1em; color: #222; }\n"
    "table { border-collapse: collapse; }\n"
    "td, th { padding: 2px 10px; text-align: left; vertical-align: top; border-bottom: 1px solid #ddd; }\n"
    "td.number { text-align: right; font-variant-numeric: tabular-nums; }\n"
    ".ok { color: #006b3c; } .FAILED, .ERROR { color: #C00000; font-weight: bold; }\n"
    "pre { background: #f6f6f6; padding: 6px; overflow-x: auto; }\n"
    "iframe { width: 100%; height: 720px; border: 1px solid #ddd; }\n";

// `folder` is empty without artifacts.
std::string links(const std::string& folder, const TestResult& result) {
  if (folder.empty() || (result.outcome != Outcome::Failed && result.outcome != Outcome::Malformed))
    return "";
  std::string text = "<p>";
  for (const char* file : {"plot.html", "trace.csv", "trace.vcd", "bus.pcapng", "journal.txt", "report.txt", "state.ipos"})
    if (result.outcome == Outcome::Failed || std::string_view(file) == "report.txt")
      text += fmt::format("<a href=\"{}/{}\">{}</a> ", xml_attribute(folder), file, file);
  text += "</p>";
  if (result.outcome == Outcome::Failed)
    text += fmt::format("<details><summary>Curves</summary><iframe title=\"{}\" loading=\"lazy\" src=\"{}/plot.html\"></iframe></details>",
                        xml_attribute(result.name), xml_attribute(folder));
  return text;
}

// To the moment of a check in the curves.
std::string moment(const std::string& folder, const Finding& finding) {
  if (folder.empty() || finding.time == 0) return "";
  return fmt::format("<a href=\"{}/plot.html#{}\">{:.3f} s in the curves</a>", xml_attribute(folder),
                     finding.time / runtime::kMillisecond, static_cast<double>(finding.time) / 1e9);
}

std::string row(const TestResult& result, const std::string& folder) {
  std::string details;
  if (!result.messages.empty()) details += fmt::format("<pre>{}</pre>", xml_text(result.messages));
  for (const Finding& finding : result.findings)
    details += fmt::format("<pre>{}</pre>{}", xml_text(text_of_finding(finding)),
                           result.outcome == Outcome::Failed ? moment(folder, finding) : "");
  details += links(folder, result);
  return fmt::format(
      "<tr><td class=\"{0}\">{0}</td><td>{1}{2}</td><td class=\"number\">{3}</td><td "
      "class=\"number\">{4:.3f}</td>"
      "<td class=\"number\">{5:.3f}</td></tr>\n",
      word_of(result.outcome), xml_text(result.name), details, result.checks,
      static_cast<double>(result.time) / 1e9, result.seconds);
}

}  // namespace

std::string html_head(std::string_view more_style) {
  return fmt::format("{}{}</style></head><body>\n", kHead, more_style);
}

std::string html_report(const std::vector<TestResult>& results, const std::string& artifacts) {
  std::string text = html_head() + fmt::format("<h1>{}</h1>\n", xml_text(summary(results)));
  text +=
      "<table><thead><tr><th>outcome</th><th>test</th><th>checks</th><th>virtual "
      "s</th><th>s</th></tr></thead><tbody>\n";
  const std::vector<std::string> folders = artifact_folders(results);
  // What is wrong comes first.
  for (const bool bad : {true, false})
    for (size_t n = 0; n < results.size(); ++n)
      if ((results[n].outcome == Outcome::Failed || results[n].outcome == Outcome::Malformed) == bad)
        text += row(results[n], artifacts.empty() ? "" : artifacts + "/" + folders[n]);
  return text + "</tbody></table>\n</body></html>\n";
}

}  // namespace ipos::tools::testing
