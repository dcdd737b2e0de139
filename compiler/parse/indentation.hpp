// Which '{' is not closed when a '}' is missing somewhere: the brackets only say that one is, the indentation
// says which.
#pragma once

#include <optional>
#include <span>

#include "compiler/preprocess/token.hpp"

namespace ipos::compiler {

bool misses_closing_brace(std::span<const Token> tokens);

// The token of the '{'; nothing when no '}' is missing, or when the indentation does not tell.
std::optional<size_t> unclosed_brace(std::span<const Token> tokens, const SourceMap& map);

}  // namespace ipos::compiler
