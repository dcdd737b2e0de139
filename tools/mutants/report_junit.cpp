// JUnit XML as the reports of tests have it (tools/testing/report_junit.cpp).
#include <fmt/format.h>

#include "tools/cli/xml_text.hpp"
#include "tools/mutants/reports.hpp"

namespace ipos::tools::mutants {
namespace {

std::string testcase(const Mutant& mutant) {
  const std::string head =
      fmt::format("    <testcase name=\"{}:{} {}\" classname=\"{}\" time=\"0.000\"", mutant.place.line, mutant.place.column,
                  xml_attribute(mutant.text), xml_attribute(mutant.file));
  if (mutant.fate == Fate::Noticed) return head + "/>\n";
  if (mutant.fate == Fate::Equivalent)
    return fmt::format("{}>\n      <skipped message=\"equivalent: {}\"/>\n    </testcase>\n", head, xml_attribute(mutant.because));
  if (mutant.fate == Fate::NotRun) return head + ">\n      <skipped message=\"interrupted\"/>\n    </testcase>\n";
  return fmt::format("{}>\n      <failure type=\"survivor\" message=\"{}\">{}</failure>\n    </testcase>\n", head,
                     mutant.fate == Fate::Unreached ? "no test reaches it" : "no test notices it", xml_text(line_of(mutant)));
}

std::string counts(const std::vector<Mutant>& mutants) {
  const Score score = score_of(mutants);
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" time=\"0.000\"", mutants.size(), score.planted - score.noticed);
}

}  // namespace

std::string junit_report(const std::vector<Mutant>& mutants) {
  std::string text =
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"ipos\" {}>\n", counts(mutants));
  for (size_t n = 0; n < mutants.size();) {  // they are in the order of files
    std::vector<Mutant> of_file;
    std::string cases;
    for (const std::string& file = mutants[n].file; n < mutants.size() && mutants[n].file == file; ++n) {
      of_file.push_back(mutants[n]);
      cases += testcase(mutants[n]);
    }
    const Score score = score_of(of_file);
    const std::string file = xml_attribute(of_file.front().file);
    text += fmt::format("  <testsuite name=\"{0}\" {1} skipped=\"{2}\" file=\"{0}\">\n{3}  </testsuite>\n", file, counts(of_file),
                        of_file.size() - score.planted, cases);
  }
  return text + "</testsuites>\n";
}

}  // namespace ipos::tools::mutants
