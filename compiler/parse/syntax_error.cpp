// What a syntax error says: what was found, what was expected in words a user knows, or the likely mistake
// after it.
#include <cassert>

#include "compiler/parse/token_feed.hpp"

namespace ipos::compiler {
namespace {

using Kind = Parser::symbol_kind;

bool is_type_word(const Token& token, const TypeNames& types) {
  switch (token.kind) {
    case TokenKind::Long:
#define FOREIGN_TYPE(kind, spelling) case TokenKind::kind:
#define KEYWORD(kind, spelling)
#include "compiler/preprocess/tokens.def"
      return true;
    case TokenKind::Name: return types.contains(token.text);
    default: return false;
  }
}

// Words and signs a statement begins with and no declaration.
bool opens_statement(TokenKind kind) {
  switch (kind) {
    case TokenKind::If:
    case TokenKind::Else:
    case TokenKind::For:
    case TokenKind::While:
    case TokenKind::Do:
    case TokenKind::Switch:
    case TokenKind::Case:
    case TokenKind::Default:
    case TokenKind::Break:
    case TokenKind::Continue:
    case TokenKind::Return:
    case TokenKind::Goto:
    case TokenKind::LeftBrace:
    case TokenKind::LeftParen:
    case TokenKind::Star:
    case TokenKind::Increment:
    case TokenKind::Decrement:
    case TokenKind::Number: return true;
    default: return false;
  }
}

}  // namespace

// The parser's own hooks.
void Parser::report_syntax_error(const context& where) const { feed.syntax_error(where); }
void Parser::error(const Span& /*place*/, const std::string& /*text*/) {
  // Only for exceptions of type syntax_error, which no action throws.
}

TokenFeed::Expected::Expected(const Parser::context& context) : set(Parser::YYNTOKENS, false) {
  Parser::symbol_kind_type kinds[Parser::YYNTOKENS];
  count = context.expected_tokens(kinds, Parser::YYNTOKENS);
  for (int i = 0; i < count; ++i) set[static_cast<size_t>(kinds[i])] = true;
}

void TokenFeed::syntax_error(const Parser::context& context) {
  const Expected expected(context);
  repeated_ = last_ == last_error_ ? repeated_ + 1 : 0;
  last_error_ = last_;
  resuming_ = true;
  semicolon_fits_ = expected.has(Kind::S_Semicolon);
  brace_fits_ = expected.has(Kind::S_LeftBrace);
  // What follows a reported character or an open quote is only its consequence.
  const TokenKind previous = before(1).kind;
  const bool consequence =
      previous == TokenKind::Stray || previous == TokenKind::Hash || previous == TokenKind::OpenQuote;
  if (repeated_ == 0 && !stopped_ && !consequence) explain(expected);
}

void TokenFeed::explain(const Expected& expected) {
  if (directive_) return explain_directive();
  if (inside_braces() ? explain_inside(expected) : explain_outside(expected)) return;

  const std::string words = expected_words(expected);
  Span place = found().span;
  if (last_ > 0 && (words == "';'" || found().line_start || found().kind == TokenKind::End))
    place = {before(1).span.end, before(1).span.end};
  Diagnostic& error = diagnostics_.report(Diag::ExpectedBefore, place, {words, found_words()});
  if (words == "'}'" && !open_.empty())
    error.notes.push_back(open_brace("to match this '{'"));
}

Note TokenFeed::open_brace(const char* text) const {
  if (unclosed_) return {tokens_[*unclosed_].span, "by the indentation this '{' is the one that is not closed"};
  return {tokens_[open_.back().token].span, text};
}

void TokenFeed::explain_directive() {
  if (tokens_[*directive_].kind == TokenKind::Declare) {
    diagnostics_.report(Diag::BadDeclare, found().span);
    return;
  }
  std::string form(tokens_[*directive_ + 1].text);
  if (form != "list") form += " LOW HIGH";
  diagnostics_.report(Diag::BadPragma, found().span, {std::move(form)});
}

bool TokenFeed::explain_inside(const Expected& expected) {
  const Token& previous = before(1);
  const bool statement_fits = expected.has(Kind::S_If);
  if (found().kind == TokenKind::End && brace_reported_) return true;
  if (found().kind == TokenKind::Else && statement_fits) {
    Diagnostic& error = diagnostics_.report(Diag::StrayElse, found().span);
    if (const std::optional<size_t> semicolon = ended_if())
      error.notes.push_back({tokens_[*semicolon].span, "this ';' is all that the 'if' before it does; leave it out"});
    return true;
  }
  if (const auto comma = comma_of_head(); comma && expected.has(Kind::S_Semicolon)) {
    diagnostics_.report(Diag::ExpectedBefore, tokens_[*comma].span, {"';'", "','"});
    return true;
  }
  if (previous.kind == TokenKind::Sizeof) {
    diagnostics_.report(Diag::SizeOf, previous.span);
    return true;
  }
  if (expected.has(Kind::S_Number) && is_type_word(found(), types_)) {
    diagnostics_.report(Diag::TypeAsValue, found().span, {std::string(found().text)});
    return true;
  }
  if (found().kind == TokenKind::LeftBrace && semicolon_fits_ && previous.kind == TokenKind::RightParen &&
      before(2).kind == TokenKind::LeftParen && before(3).kind == TokenKind::Name) {
    if (!brace_reported_)
      diagnostics_.report(Diag::NestedFunction, before(3).span, {std::string(before(3).text)})
          .notes.push_back(open_brace("this '{' is still open"));
    brace_reported_ = true;
    return true;
  }
  // Two names at the start of a statement: only there a label would fit as well.
  if (found().kind == TokenKind::Name && !found().line_start && semicolon_fits_ &&
      expected.has(Kind::S_Colon)) {
    diagnostics_.report(Diag::UnknownType, previous.span, {std::string(previous.text)});
    return true;
  }
  return false;
}

// The ';' right behind the brackets of the last `if` of this block, if that is what ended it.
std::optional<size_t> TokenFeed::ended_if() const {
  int level = 0;
  for (size_t n = last_; n-- > 1;) {
    const TokenKind kind = tokens_[n].kind;
    if (kind == TokenKind::RightBrace) ++level;
    if (kind == TokenKind::LeftBrace && --level < 0) return std::nullopt;
    if (level != 0 || kind != TokenKind::Semicolon || tokens_[n - 1].kind != TokenKind::RightParen) continue;
    int depth = 0;
    size_t open = n - 1;
    for (; open > 0; --open) {
      if (tokens_[open].kind == TokenKind::RightParen) ++depth;
      if (tokens_[open].kind == TokenKind::LeftParen && --depth == 0) break;
    }
    if (open > 0 && tokens_[open - 1].kind == TokenKind::If) return n;
  }
  return std::nullopt;
}

// The first ',' of `for (a, b, c)`, at whose ')' the error is.
std::optional<size_t> TokenFeed::comma_of_head() const {
  if (found().kind != TokenKind::RightParen || open_.empty() || open_.back().kind != TokenKind::LeftParen) return std::nullopt;
  const size_t open = open_.back().token;
  if (open == 0 || tokens_[open - 1].kind != TokenKind::For) return std::nullopt;
  int level = 0;
  std::optional<size_t> comma;
  for (size_t n = open + 1; n < last_; ++n) {
    const TokenKind kind = tokens_[n].kind;
    if (kind == TokenKind::Semicolon) return std::nullopt;
    if (kind == TokenKind::LeftParen) ++level;
    if (kind == TokenKind::RightParen) --level;
    if (kind == TokenKind::Comma && level == 0 && !comma) comma = n;
  }
  return comma;
}

bool TokenFeed::explain_outside(const Expected& expected) {
  const Token& previous = before(1);
  if (expected.has(Kind::S_Typedef)) {
    if (found().kind == TokenKind::RightBrace) {
      diagnostics_.report(Diag::StrayBrace, found().span);
      return true;
    }
    if (!opens_statement(found().kind)) return false;
    diagnostics_.report(Diag::StatementOutsideFunction, found().span);
    return true;
  }
  if (previous.kind == TokenKind::Typedef) {
    diagnostics_.report(Diag::TypedefOnlyStruct, found().span);
    return true;
  }
  if (expected.only(Kind::S_RightParen) && open_.size() == 1) return explain_parameters();
  if (found().kind == TokenKind::LeftBrace && before(2).kind == TokenKind::Struct) {
    const std::string name(previous.text);
    diagnostics_.report(Diag::StructWithoutTypedef, {before(2).span.begin, previous.span.end}, {name, name});
    return true;
  }
  const bool after_name = expected.only(Kind::S_LeftParen) && previous.kind == TokenKind::Name;
  if (!after_name || found().kind == TokenKind::LeftBrace || found().kind == TokenKind::End) return false;
  if (found().kind == TokenKind::Name)
    diagnostics_.report(Diag::UnknownType, previous.span, {std::string(previous.text)});
  else
    diagnostics_.report(Diag::StatementOutsideFunction, previous.span);
  return true;
}

// Something between the brackets after a name outside of functions: parameters, or a call that is misplaced.
bool TokenFeed::explain_parameters() {
  const size_t opener = open_[0].token;
  size_t behind = opener;
  for (int level = 0; tokens_[behind].kind != TokenKind::End; ++behind) {
    if (tokens_[behind].kind == TokenKind::LeftParen) ++level;
    if (tokens_[behind].kind == TokenKind::RightParen && --level == 0) break;
    if (tokens_[behind].kind == TokenKind::LeftBrace || tokens_[behind].kind == TokenKind::Semicolon)
      return false;
  }
  if (tokens_[behind].kind == TokenKind::End || opener == 0) return false;
  const Token& name = tokens_[opener - 1];
  if (tokens_[behind + 1].kind == TokenKind::LeftBrace || is_type_word(found(), types_))
    diagnostics_.report(Diag::FunctionParameters, {found().span.begin, tokens_[behind - 1].span.end},
                        {std::string(name.text)});
  else
    diagnostics_.report(Diag::StatementOutsideFunction, name.span);
  return true;
}

std::string TokenFeed::expected_words(const Expected& expected) const {
  if (found().kind == TokenKind::End && expected.has(Kind::S_RightBrace)) return "'}'";
  if (expected.has(Kind::S_If)) return "a statement";
  if (expected.has(Kind::S_Number)) return "an expression";
  if (expected.has(Kind::S_Typedef)) return "a declaration or a function";
  if (expected.has(Kind::S_LeftBrace)) return "'{'";

  // After an operand every operator would do: only what ends the expression is worth naming.
  const bool behind_operand = expected.has(Kind::S_EqualEqual);
  struct Row {
    Parser::symbol_kind_type kind;
    std::string_view words;
    bool ends_expression;
  };
  static constexpr Row kRows[] = {
      {Kind::S_Semicolon, "';'", true},      {Kind::S_RightParen, "')'", true},
      {Kind::S_RightBracket, "']'", true},   {Kind::S_Colon, "':'", true},
      {Kind::S_Comma, "','", false},         {Kind::S_While, "'while'", false},
      {Kind::S_Identifier, "a name", false}, {Kind::S_LeftParen, "'('", false},
      {Kind::S_Long, "a type", false},       {Kind::S_RightBrace, "'}'", true},
  };
  std::string words;
  for (const Row& row : kRows) {
    if (!expected.has(row.kind) || (behind_operand && !row.ends_expression)) continue;
    // What is left then is rarely what was meant.
    if (!words.empty() && (row.kind == Kind::S_LeftParen || row.kind == Kind::S_Long)) continue;
    words += words.empty() ? "" : " or ";
    words += row.words;
    if (behind_operand) break;
  }
  assert(!words.empty());  // what else the grammar wants, in directives and after 'typedef', is explained apart
  return words;
}

std::string TokenFeed::found_words() const {
  switch (found().kind) {
    case TokenKind::End: return "the end of the file";
    case TokenKind::Pragma:
    case TokenKind::Declare: return "'#" + std::string(found().text) + "'";
    default: return "'" + std::string(found().text) + "'";
  }
}

}  // namespace ipos::compiler
