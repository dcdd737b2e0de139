// Constant expressions of #if and #elif: operators and precedence of C on 32-bit numbers.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/token.hpp"

namespace ipos::compiler {

// `tokens`: the expression with macros expanded and `defined` replaced; `directive` names the line and its
// place. Names that are left count as 0 with a warning. nullopt: not an expression, which is reported.
std::optional<bool> evaluate_condition(std::span<const Token> tokens, const Token& directive,
                                       Diagnostics& diagnostics);

}  // namespace ipos::compiler
