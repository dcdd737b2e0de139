// One HTML file for a browser: each source with its lines, and below a line what survived in it.
#include <fmt/format.h>

#include <map>

#include "tools/cli/files.hpp"
#include "tools/cli/text_lines.hpp"
#include "tools/cli/xml_text.hpp"
#include "tools/mutants/reports.hpp"
#include "tools/testing/report_words.hpp"

namespace ipos::tools::mutants {
namespace {

constexpr std::string_view kStyle =
    ".source td { border: 0; padding: 0 10px; }\n.source code { white-space: pre; }\n"
    ".noticed .number { background: #d6f0e0; } .survivor { background: #fbe3e3; } .equivalent { color: #666; }\n"
    ".told { color: #C00000; } td.told { padding-left: 3em; }\n";

std::string row(uint32_t number, const std::string& line, const std::vector<const Mutant*>& mutants) {
  size_t noticed = 0;
  bool survivor = false;
  std::string below;
  for (const Mutant* mutant : mutants) {
    noticed += mutant->fate == Fate::Noticed ? 1U : 0U;
    survivor = survivor || survives(*mutant);
    if (survives(*mutant))
      below += fmt::format("<tr class=\"survivor\"><td></td><td class=\"told\">{}{}</td></tr>\n", xml_text(mutant->text),
                           mutant->fate == Fate::Unreached ? " <i>(no test reaches it)</i>" : "");
    if (mutant->fate == Fate::Equivalent)
      below += fmt::format("<tr class=\"equivalent\"><td></td><td>{} <i>(equivalent: {})</i></td></tr>\n",
                           xml_text(mutant->text), xml_text(mutant->because));
  }
  const std::string title = noticed == 0 ? "" : fmt::format(" title=\"{} noticed\"", noticed);
  return fmt::format("<tr class=\"{}\"{}><td class=\"number\">{}</td><td><code>{}</code></td></tr>\n{}",
                     survivor ? "survivor" : noticed != 0 ? "noticed" : "", title, number, xml_text(line), below);
}

std::string section(const std::string& file, const std::vector<Mutant>& mutants, size_t id) {
  std::map<uint32_t, std::vector<const Mutant*>> of_line;
  for (const Mutant& mutant : mutants) of_line[mutant.place.line].push_back(&mutant);
  std::string text = fmt::format("<h2 id=\"f{}\">{}</h2>\n<p>{}</p>\n<table class=\"source\"><tbody>\n", id, xml_text(file),
                                 score_line(score_of(mutants)));
  uint32_t number = 0;
  for (const std::string& line : text_lines(try_read_file(file).value_or(""))) {
    ++number;
    text += row(number, line, of_line[number]);
  }
  return text + "</tbody></table>\n";
}

}  // namespace

std::string html_report(const std::vector<Mutant>& mutants) {
  std::map<std::string, std::vector<Mutant>> files;
  for (const Mutant& mutant : mutants) files[mutant.file].push_back(mutant);
  std::string text = testing::html_head(kStyle) + fmt::format("<h1>{}</h1>\n", score_line(score_of(mutants)));
  text += "<table><thead><tr><th>source</th><th>score</th><th>planted</th><th>survivors</th><th>equivalent</th></tr></thead><tbody>\n";
  std::string sections;
  size_t id = 0;
  for (const auto& [file, of_file] : files) {
    const Score score = score_of(of_file);
    text += fmt::format("<tr><td><a href=\"#f{}\">{}</a></td><td class=\"number\">{} %</td><td class=\"number\">{}</td>"
                        "<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
                        ++id, xml_text(file), score.percent(), score.planted, score.planted - score.noticed, score.equivalent);
    sections += section(file, of_file, id);
  }
  return text + "</tbody></table>\n" + sections + "</body></html>\n";
}

}  // namespace ipos::tools::mutants
