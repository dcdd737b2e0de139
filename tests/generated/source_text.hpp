// IPOS source of a generated program, with no more brackets than the precedences of C need and the generator
// asks for, so that the parser's precedences are tested.
#pragma once

#include <string>

#include "tests/generated/program.hpp"

namespace ipos::tests {

// Also notes the line of each expression in the tree.
std::string source_text(Program& program);

std::string expression_text(const Expr& expr);

}  // namespace ipos::tests
