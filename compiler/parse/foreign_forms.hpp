// Forms of several words that people bring along from C and from PLC languages: constants by const and enum, numbers with a
// base or a time before '#', bits behind a point, and the declarations of VAR ... END_VAR. Each is reported once, with what to
// write, and replaced by what was meant, so that it causes no second message.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <vector>

#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/token.hpp"

namespace ipos::compiler {

// What is kept as long as the tokens are used.
struct ForeignForms {
  std::vector<Token> tokens;
  std::deque<std::string> texts;  // words that stand in no source
};

// The tokens for without_foreign_words(): those of `changed`, or those given where there is nothing to change.
std::span<const Token> without_foreign_forms(std::span<const Token> tokens, ForeignForms& changed, Diagnostics& diagnostics);

}  // namespace ipos::compiler
