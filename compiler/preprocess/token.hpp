// Tokens of the source text, as the scanner makes them and the preprocessor passes them on.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "compiler/source/source.hpp"

namespace ipos::compiler {

enum class TokenKind : uint8_t {
  End,
  Newline,     // inside the preprocessor only
  Name,        // any word; keyword_kind() tells the words of the language from it
  Number,      // everything that begins with a digit, right or wrong
  String,      // "..."
  Character,   // '...'
  OpenQuote,   // a quote that does not end on its line
  BadName,     // word with letters outside of ASCII
  Stray,       // byte without a meaning
  Hash,        // #
  HeaderName,  // <...> or "..." after #include
  Pragma,      // #pragma, then its words, then DirectiveEnd
  Declare,     // #declare, then its words, then DirectiveEnd
  DirectiveEnd,
#define PUNCTUATOR(kind, spelling) kind,
#define KEYWORD(kind, spelling) kind,
#include "compiler/preprocess/tokens.def"
};

struct Token {
  TokenKind kind = TokenKind::End;
  bool line_start = false;  // first token of its line
  bool spaced = false;      // blank or comment before it
  Span span;
  std::string_view text;  // in the SourceFile; names cut to their 32 significant characters
};

// The operator with that spelling, if there is one.
std::optional<TokenKind> punctuator_kind(std::string_view text);

// The word of the language or of C, else Name.
TokenKind keyword_kind(std::string_view text);

// For listings: "name", "number", "keyword", "operator", ...
std::string_view category(TokenKind kind);

}  // namespace ipos::compiler
