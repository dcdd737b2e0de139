// From preprocessed tokens to the parser's symbols. Numbers, texts and characters that are wrong are reported
// here and delivered as something harmless, so that they cause no second message.
#include "compiler/parse/token_feed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "compiler/preprocess/number.hpp"

namespace ipos::compiler {
namespace {

bool is_stray(const Token& token) { return token.kind == TokenKind::Stray || token.kind == TokenKind::Hash; }

std::string describe_byte(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text[0]);
  if (byte > 0x20 && byte < 0x7F) return "'" + std::string(text) + "'";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  return std::string("the byte 0x") + kDigits[byte >> 4U] + kDigits[byte & 15U];
}

}  // namespace

Symbol TokenFeed::next() {
  if (resuming_) return resume();
  if (last_ < tokens_.size()) accepted(last_);
  if (!stopped_ && diagnostics_.error_count() >= Diagnostics::kMostErrors) {
    diagnostics_.report(Diag::TooManyErrors, tokens_[next_].span);
    stop();
  } else if (!stopped_ && open_.size() > ast::kMaxDepth) {
    diagnostics_.report(Diag::NestingTooDeep, found().span, {std::to_string(ast::kMaxDepth)});
    stop();
  }
  while (is_stray(tokens_[next_])) stray();
  last_ = next_;
  if (found().kind != TokenKind::End) ++next_;
  // Adjacent texts are one in C: one message is enough.
  while (found().kind == TokenKind::String && tokens_[next_].kind == TokenKind::String) ++next_;
  const Symbol made = symbol(found());
  told_ = std::max(told_, next_);
  return made;
}

void TokenFeed::stop() {
  next_ = tokens_.size() - 1;
  stopped_ = true;
}

void TokenFeed::stray() {
  const Token& first = tokens_[next_++];
  Span span = first.span;
  // A run of such bytes is one mistake.
  while (is_stray(tokens_[next_]) && !tokens_[next_].spaced && !tokens_[next_].line_start)
    span.end = tokens_[next_++].span.end;
  diagnostics_.report(Diag::StrayCharacter, span, {describe_byte(first.text)});
}

// What is wrong in the token itself. After an error the same token may come again.
Diagnostic* TokenFeed::tell(Diag diag, Span place, std::vector<std::string> words) {
  return last_ >= told_ ? &diagnostics_.report(diag, place, std::move(words)) : nullptr;
}

Symbol TokenFeed::symbol(const Token& token) {
  const Span span = token.span;
  const auto ident = [&token](Parser::token_kind_type kind) {
    Symbol named{kind, token.span, {}};
    named.value.ident = {token.text, token.span};
    return named;
  };
  const auto constant = [&token](ast::Number number) {
    Symbol made{Parser::token::Number, token.span, {}};
    made.value.number = number;
    return made;
  };
  switch (token.kind) {
    case TokenKind::Name: {
      const TokenKind previous = before(1).kind;
      const bool member = previous == TokenKind::Dot || previous == TokenKind::Arrow;
      return ident(!member && types_.contains(token.text) ? Parser::token::TypeName
                                                          : Parser::token::Identifier);
    }
    case TokenKind::BadName:
      tell(Diag::BadIdentifier, span, {std::string(token.text)});
      return ident(Parser::token::Identifier);
    case TokenKind::Number: return constant(number(token));
    case TokenKind::String: tell(Diag::StringConstant, span); break;
    case TokenKind::Character: tell(Diag::CharConstant, span); break;
    case TokenKind::OpenQuote: tell(Diag::UnterminatedString, span); break;
    case TokenKind::Pragma: return {Parser::token::Pragma, span, {}};
    case TokenKind::Declare: return {Parser::token::Declare, span, {}};
    case TokenKind::DirectiveEnd:
      return {Parser::token::DirectiveEnd, span, {}};
// clang-format off
#define PUNCTUATOR(kind, spelling) case TokenKind::kind: return {Parser::token::kind, span, {}};
#define KEYWORD(kind, spelling) case TokenKind::kind: return {Parser::token::kind, span, {}};
#define FOREIGN_TYPE(kind, spelling) case TokenKind::kind: return ident(Parser::token::ForeignType);
#define FOREIGN_QUALIFIER(kind, spelling) \
  case TokenKind::kind: return ident(Parser::token::ForeignQualifier);
#include "compiler/preprocess/tokens.def"
      // clang-format on
    case TokenKind::End:
    case TokenKind::Newline:  // these four never leave preprocessor and next()
    case TokenKind::HeaderName:
    case TokenKind::Stray:
    case TokenKind::Hash: return {Parser::token::YYEOF, span, {}};
  }
  return constant({0});
}

ast::Number TokenFeed::number(const Token& token) {
  const ParsedNumber parsed = parse_number(token.text, before(1).kind == TokenKind::Minus);
  Diag diag{};
  switch (parsed.form) {
    case NumberForm::Good: return {static_cast<int32_t>(parsed.value), parsed.pattern};
    case NumberForm::Bad: diag = Diag::BadNumber; break;
    case NumberForm::Fraction: diag = Diag::FloatConstant; break;
    case NumberForm::TooLarge: diag = Diag::NumberTooLarge; break;
  }
  Diagnostic* message = tell(diag, token.span, {std::string(token.text)});
  const double seconds = std::strtod(std::string(token.text).c_str(), nullptr);
  if (message != nullptr && parsed.form == NumberForm::Fraction && before(1).kind == TokenKind::LeftParen &&
      before(2).text == "_Wait" && seconds < 1000)
    message->notes.push_back({{}, fmt::format("'_Wait' counts milliseconds: {} s are {}", token.text, std::lround(seconds * 1000))});
  return {0};
}

const Token& TokenFeed::before(size_t distance) const {
  static const Token kNone{};
  return last_ < distance ? kNone : tokens_[last_ - distance];
}

// The parser has taken the token: keeps account of brackets.
void TokenFeed::accepted(size_t token) {
  const TokenKind kind = tokens_[token].kind;
  if (open_.empty() && fresh_) declaration_ = token;
  switch (kind) {
    case TokenKind::If:
    case TokenKind::For:
    case TokenKind::While:
    case TokenKind::Switch:
    case TokenKind::LeftParen:
    case TokenKind::LeftBracket:
    case TokenKind::LeftBrace:
      open_.push_back({kind, token, token > 0 && tokens_[token - 1].kind == TokenKind::Assign});
      break;
    case TokenKind::RightParen:
      close(TokenKind::LeftParen);
      if (!open_.empty() && open_.back().kind != TokenKind::LeftParen &&
          open_.back().kind != TokenKind::LeftBracket && open_.back().kind != TokenKind::LeftBrace)
        open_.pop_back();  // the head ends
      break;
    case TokenKind::RightBracket: close(TokenKind::LeftBracket); break;
    case TokenKind::RightBrace:
      close(TokenKind::LeftBrace);
      if (open_.empty()) brace_reported_ = false;
      break;
    case TokenKind::Pragma:
    case TokenKind::Declare: directive_ = token; break;
    case TokenKind::DirectiveEnd: directive_.reset(); break;
    default: break;
  }
  fresh_ = open_.empty() &&
           (kind == TokenKind::Semicolon || kind == TokenKind::RightBrace || kind == TokenKind::DirectiveEnd);
}

void TokenFeed::close(TokenKind opener) {
  if (!open_.empty() && open_.back().kind == opener) open_.pop_back();
}

// Inside a function or a structure.
bool TokenFeed::inside_braces() const {
  return !open_.empty() && open_.front().kind == TokenKind::LeftBrace && !open_.front().values;
}

}  // namespace ipos::compiler
