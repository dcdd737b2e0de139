// Words and sums.
#include "tools/mutants/mutant.hpp"

namespace ipos::tools::mutants {

const char* word_of(Fate fate) {
  switch (fate) {
    case Fate::Noticed: return "noticed";
    case Fate::Missed: return "missed";
    case Fate::Unreached: return "unreached";
    case Fate::Equivalent: return "equivalent";
    case Fate::NotRun: break;
  }
  return "not_run";
}

Score score_of(const std::vector<Mutant>& mutants) {
  Score score;
  for (const Mutant& mutant : mutants) {
    if (mutant.fate == Fate::Equivalent) ++score.equivalent;
    if (mutant.fate == Fate::Noticed) ++score.noticed;
    if (mutant.fate == Fate::Noticed || survives(mutant)) ++score.planted;
  }
  return score;
}

}  // namespace ipos::tools::mutants
