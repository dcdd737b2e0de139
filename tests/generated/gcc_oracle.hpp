// The second oracle: the programs as C, through gcc -O0.
#pragma once

#include <string>
#include <vector>

#include "tests/generated/program.hpp"

namespace ipos::tests {

bool gcc_present();

// Outcomes of the programs in order, or what went wrong in `trouble`.
struct GccRun {
  std::vector<Outcome> outcomes;
  std::string trouble;
};
GccRun run_with_gcc(const std::vector<Program>& programs);

}  // namespace ipos::tests
