// Puts preprocessor, token feed, parser and builder together.
#include "compiler/parse/parse.hpp"

#include <fmt/format.h>

#include "compiler/parse/foreign_forms.hpp"
#include "compiler/parse/foreign_words.hpp"
#include "compiler/parse/indentation.hpp"
#include "compiler/parse/token_feed.hpp"
#include "stdlib/language_tables.hpp"

namespace ipos::compiler {
ast::Program parse_program(SourceMap& map, const SourceFile& main, const PreprocessOptions& options,
                           Diagnostics& diagnostics) {
  const PreprocessedText text = preprocess(map, main, options, diagnostics);
  return text.complete ? parse_tokens(map, text, diagnostics) : ast::Program{};
}

ast::Program parse_tokens(const SourceMap& map, const PreprocessedText& text, Diagnostics& diagnostics) {
  ast::Program program;
  for (const auto& [name, place] : text.record.left_out) program.left_out.emplace(name, ast::Program::LeftOut{place.name, place.condition});
  TypeNames types;
  for (const stdlib::Structure& structure : stdlib::structures()) types.insert(structure.name);
  ForeignForms forms;
  std::vector<Token> words;
  const std::span<const Token> tokens = without_foreign_words(without_foreign_forms(text.tokens, forms, diagnostics), words, diagnostics);
  Builder build(program, types, map, diagnostics, misses_closing_brace(tokens));
  TokenFeed feed(tokens, types, diagnostics, unclosed_brace(tokens, map));
  // The result says no more than the diagnostics do.
  static_cast<void>(Parser(feed, build).parse());
  return program;
}

std::string print_tokens(const SourceMap& map, const SourceFile& main, const PreprocessedText& text) {
  std::string out;
  for (const Token& token : text.tokens) {
    const Position at = map.position(token.span.begin);
    if (at.file != nullptr && at.file != &main) out += fmt::format("{}:", at.file->name);
    out += fmt::format("{}:{} {}{}{}\n", at.line, at.column, category(token.kind), token.text.empty() ? "" : " ", token.text);
  }
  return out;
}

}  // namespace ipos::compiler
