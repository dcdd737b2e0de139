// A block whose lines are followed by one that stands no deeper than the head of the block should have been
// closed before that line.
#include "compiler/parse/indentation.hpp"

#include <algorithm>
#include <vector>

namespace ipos::compiler {
namespace {

struct Open {
  size_t token;
  uint32_t indent;  // column of the first token of its line
};

}  // namespace

bool misses_closing_brace(std::span<const Token> tokens) {
  int level = 0;
  for (const Token& token : tokens) {
    if (token.kind == TokenKind::LeftBrace) ++level;
    if (token.kind == TokenKind::RightBrace) --level;
  }
  return level > 0;
}

std::optional<size_t> unclosed_brace(std::span<const Token> tokens, const SourceMap& map) {
  if (!misses_closing_brace(tokens)) return std::nullopt;
  std::vector<Open> open;
  uint32_t indent = 1;
  for (size_t i = 0; i < tokens.size(); ++i) {
    const Token& token = tokens[i];
    if (token.line_start) indent = map.position(token.span.begin).column;
    const bool closes = token.kind == TokenKind::RightBrace;
    // Its own '}' stands as deep as the head; a '}' further left, or any other line as far left, belongs to a
    // block around it. Labels may stand anywhere.
    const bool label = token.kind == TokenKind::Case || token.kind == TokenKind::Default;
    const bool opens = token.kind == TokenKind::LeftBrace;
    if (token.line_start && !open.empty() && !label && !opens && token.kind != TokenKind::End &&
        (closes ? indent < open.back().indent : indent <= open.back().indent))
      return open.back().token;
    if (opens) open.push_back({i, indent});
    if (closes && !open.empty()) open.pop_back();
  }
  return std::nullopt;
}

}  // namespace ipos::compiler
