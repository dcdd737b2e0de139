// A mistake that is planted into a program, and what came of it: plain data that the reports read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/mutants/change.hpp"
#include "runtime/plant_file/toml_text.hpp"

namespace ipos::tools::mutants {

enum class Fate : uint8_t {
  Noticed,
  Missed,      // every test that reaches it has passed
  Unreached,   // no test executes its line
  Equivalent,  // the source says that nobody can see it
  NotRun,      // interrupted
};
const char* word_of(Fate fate);  // as JSON has it

struct Mutant {
  std::string file;
  runtime::FilePlace place;
  compiler::mutants::Kind kind{};
  std::string text;  // "< became <="
  Fate fate = Fate::NotRun;
  std::string because;  // the test that noticed it, or the reason that the source gives
};

struct Score {
  size_t noticed = 0;
  size_t planted = 0;     // without the equivalent ones, and those that were not run
  size_t equivalent = 0;

  size_t percent() const { return planted == 0 ? 100 : 100 * noticed / planted; }
};
Score score_of(const std::vector<Mutant>& mutants);

inline bool survives(const Mutant& mutant) { return mutant.fate == Fate::Missed || mutant.fate == Fate::Unreached; }

}  // namespace ipos::tools::mutants
