// C of a generated program, for the second oracle. C leaves the order of operands open, so every operand gets
// its own temporary in a statement of its own; the operators themselves, wrap-around and control flow are
// C's.
#pragma once

#include <string>
#include <vector>

#include "tests/generated/program.hpp"

namespace ipos::tests {

// One C file for all programs; its main prints a line for each: "fault line number=value ...", variables that
// are 0 left out.
std::string c_text(const std::vector<Program>& programs);

}  // namespace ipos::tests
