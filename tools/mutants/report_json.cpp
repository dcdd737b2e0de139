// One JSON object: sums, and an entry for each mistake.
#include <nlohmann/json.hpp>

#include "tools/cli/json_text.hpp"
#include "tools/cli/xml_text.hpp"
#include "tools/mutants/reports.hpp"

namespace ipos::tools::mutants {

std::string json_report(const std::vector<Mutant>& mutants) {
  using nlohmann::ordered_json;
  const Score score = score_of(mutants);
  ordered_json report{{"score", score.percent()},
                      {"noticed", score.noticed},
                      {"planted", score.planted},
                      {"equivalent", score.equivalent}};
  report["mutants"] = ordered_json::array();
  for (const Mutant& mutant : mutants) {
    ordered_json one{{"file", utf8(mutant.file)},     {"line", mutant.place.line},
                     {"column", mutant.place.column}, {"kind", compiler::mutants::word_of(mutant.kind)},
                     {"text", utf8(mutant.text)},     {"outcome", word_of(mutant.fate)}};
    if (mutant.fate == Fate::Noticed) one["test"] = utf8(mutant.because);
    if (mutant.fate == Fate::Equivalent) one["reason"] = utf8(mutant.because);
    report["mutants"].push_back(std::move(one));
  }
  return json_text(report, 2) + "\n";
}

}  // namespace ipos::tools::mutants
