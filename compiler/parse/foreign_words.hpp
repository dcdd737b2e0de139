// Words and operators that people bring along: keywords in capitals or misspelt, `:=`, `<>`, AND, OR, NOT,
// MOD, THEN, BEGIN and END of PLC languages. Each is reported where it stands and replaced by what was meant,
// so that it causes no second message.
#pragma once

#include <span>
#include <vector>

#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/token.hpp"

namespace ipos::compiler {

// The tokens for the parser: `changed`, or those given where there is nothing to change. Only what can be no valid program is
// touched: all these words may be names.
std::span<const Token> without_foreign_words(std::span<const Token> tokens, std::vector<Token>& changed,
                                             Diagnostics& diagnostics);

}  // namespace ipos::compiler
