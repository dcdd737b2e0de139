// What differs between the toolchain and an oracle, and the smallest program that still differs.
#pragma once

#include <functional>
#include <string>

#include "tests/generated/program.hpp"

namespace ipos::tests {

// Empty when `got` is what `expected` says; temporaries of the compiler do not count.
std::string difference(const Program& program, const Outcome& expected, const Outcome& got);

// Prints, runs and compares; empty: no difference. Programs that do not end by the evaluator have none.
std::string difference_to_tree(Program& program);
std::string difference_to_gcc(Program& program);

// Cuts statements and parts of expressions away as long as `differs` holds.
Program reduce(Program program, const std::function<bool(Program&)>& differs);

}  // namespace ipos::tests
