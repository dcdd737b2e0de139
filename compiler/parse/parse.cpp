// Puts preprocessor, token feed, parser and builder together.
#include "compiler/parse/parse.hpp"

#include <fmt/format.h>

#include "compiler/parse/token_feed.hpp"
#include "stdlib/language_tables.hpp"

namespace ipos::compiler {
namespace {

bool misses_closing_brace(const std::vector<Token>& tokens) {
  int level = 0;
  for (const Token& token : tokens) {
    if (token.kind == TokenKind::LeftBrace) ++level;
    if (token.kind == TokenKind::RightBrace) --level;
  }
  return level > 0;
}

}  // namespace

ast::Program parse_program(SourceMap& map, const SourceFile& main, const PreprocessOptions& options,
                           Diagnostics& diagnostics) {
  const PreprocessedText text = preprocess(map, main, options, diagnostics);
  return text.complete ? parse_tokens(map, text, diagnostics) : ast::Program{};
}

ast::Program parse_tokens(const SourceMap& map, const PreprocessedText& text, Diagnostics& diagnostics) {
  ast::Program program;
  TypeNames types;
  for (const stdlib::Structure& structure : stdlib::structures()) types.emplace(structure.name);
  Builder build(program, types, map, diagnostics, misses_closing_brace(text.tokens));
  TokenFeed feed(text.tokens, types, diagnostics);
  // The result says no more than the diagnostics do.
  static_cast<void>(Parser(feed, build).parse());
  return program;
}

std::string print_tokens(const SourceMap& map, const SourceFile& main, const PreprocessedText& text) {
  fmt::memory_buffer out;
  for (const Token& token : text.tokens) {
    const Position at = map.position(token.span.begin);
    if (at.file != nullptr && at.file != &main) fmt::format_to(std::back_inserter(out), "{}:", at.file->name);
    fmt::format_to(std::back_inserter(out), "{}:{} {}{}{}\n", at.line, at.column, category(token.kind),
                   token.text.empty() ? "" : " ", token.text);
  }
  return fmt::to_string(out);
}

}  // namespace ipos::compiler
