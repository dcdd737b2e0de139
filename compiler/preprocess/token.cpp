// Look-up of operators and words in tokens.def.
#include "compiler/preprocess/token.hpp"

namespace ipos::compiler {
namespace {

// The characters of a spelling as one number, so that a switch can find it.
constexpr uint64_t pack(std::string_view text) {
  uint64_t packed = 0;
  for (char c : text) packed = packed << 8 | static_cast<unsigned char>(c);
  return packed;
}

constexpr size_t kLongestSpelling = 8;

}  // namespace

std::optional<TokenKind> punctuator_kind(std::string_view text) {
  if (text.size() > kLongestSpelling) return std::nullopt;
  switch (pack(text)) {
// clang-format off
#define PUNCTUATOR(kind, spelling) case pack(spelling): return TokenKind::kind;
#include "compiler/preprocess/tokens.def"
      // clang-format on
    default: return std::nullopt;
  }
}

TokenKind keyword_kind(std::string_view text) {
  if (text.size() > kLongestSpelling) return TokenKind::Name;
  switch (pack(text)) {
// clang-format off
#define KEYWORD(kind, spelling) case pack(spelling): return TokenKind::kind;
#include "compiler/preprocess/tokens.def"
      // clang-format on
    default: return TokenKind::Name;
  }
}

std::string_view category(TokenKind kind) {
  switch (kind) {
    case TokenKind::End: return "end";
    case TokenKind::Newline: return "newline";
    case TokenKind::Name: return "name";
    case TokenKind::Number: return "number";
    case TokenKind::String: return "string";
    case TokenKind::Character: return "character";
    case TokenKind::OpenQuote: return "open quote";
    case TokenKind::BadName: return "bad name";
    case TokenKind::Stray: return "stray";
    case TokenKind::Hash: return "hash";
    case TokenKind::HeaderName: return "header";
    case TokenKind::Pragma:
    case TokenKind::Declare: return "directive";
    case TokenKind::DirectiveEnd:
      return "directive end";
// clang-format off
#define PUNCTUATOR(kind, spelling) case TokenKind::kind: return "operator";
#define KEYWORD(kind, spelling) case TokenKind::kind: return "keyword";
#include "compiler/preprocess/tokens.def"
      // clang-format on
  }
  return "";
}

}  // namespace ipos::compiler
