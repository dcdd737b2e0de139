// Lines for people, editors and GitHub.
#include <fmt/format.h>

#include "tools/cli/xml_text.hpp"
#include "tools/mutants/reports.hpp"
#include "tools/testing/report_words.hpp"

namespace ipos::tools::mutants {
namespace {

std::string what(const Mutant& mutant) {
  return mutant.fate == Fate::Unreached ? mutant.text + " (no test reaches it)" : mutant.text;
}

}  // namespace

std::string line_of(const Mutant& mutant) {
  return utf8(fmt::format("{}:{}:{}: {}", mutant.file, mutant.place.line, mutant.place.column, what(mutant))) + "\n";
}

std::string score_line(const Score& score) {
  return fmt::format("score {} % ({} of {} noticed)", score.percent(), score.noticed, score.planted);
}

std::string text_report(const std::vector<Mutant>& mutants) {
  std::string text;
  for (const Mutant& mutant : mutants)
    if (survives(mutant)) text += line_of(mutant);
  const Score score = score_of(mutants);
  if (score.equivalent != 0)
    text += fmt::format("{} {} by `// equivalent`\n", score.equivalent,
                        score.equivalent == 1 ? "mistake is taken out" : "mistakes are taken out");
  return text + score_line(score) + "\n";
}

std::string github_report(const std::vector<Mutant>& mutants, const std::string& root) {
  std::string text;
  for (const Mutant& mutant : mutants)
    if (survives(mutant))
      text += testing::github_annotation("warning", root, mutant.file, mutant.place, "no test notices", what(mutant));
  return text;
}

}  // namespace ipos::tools::mutants
