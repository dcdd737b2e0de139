// What a word is meant to be is told by its neighbours, without a grammar: two operands never stand side by
// side, a call is never followed by a statement.
#include "compiler/parse/foreign_words.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <unordered_set>

#include "compiler/preprocess/word_filter.hpp"
#include "stdlib/spelling.hpp"

namespace ipos::compiler {
namespace {

using stdlib::equal_but_for_case;

struct Keyword {
  std::string_view spelling;
  TokenKind kind;
};
constexpr Keyword kKeywords[] = {
#define FOREIGN_TYPE(kind, spelling)
#define FOREIGN_QUALIFIER(kind, spelling)
#define KEYWORD(kind, spelling) {spelling, TokenKind::kind},
#include "compiler/preprocess/tokens.def"
};

struct Infix {
  std::string_view word;
  TokenKind kind;
  std::string_view advice;
};
constexpr Infix kInfix[] = {{"and", TokenKind::AndAnd, "write '&&', or '&' for bits"},
                            {"or", TokenKind::OrOr, "write '||', or '|' for bits"},
                            {"xor", TokenKind::Xor, "write '^'"},
                            {"mod", TokenKind::Percent, "write '%'"},
                            {"div", TokenKind::Slash, "write '/'"}};
constexpr std::string_view kBlockEnds[] = {"end_if",     "end_while",    "end_for",            "end_case",   "endif",
                                           "end_repeat", "end_function", "end_function_block", "end_program"};
constexpr std::string_view kElseIfs[] = {"elseif", "elsif", "elif"};

// Words that mean something in another spelling.
constexpr WordFilter kSpellings = [] {
  WordFilter words;
  for (const Keyword& row : kKeywords) words.add(row.spelling);
  for (const Infix& row : kInfix) words.add(row.word);
  for (const std::string_view word : kBlockEnds) words.add(word);
  for (const std::string_view word : kElseIfs) words.add(word);
  for (const std::string_view word : {"not", "then", "begin", "end"}) words.add(word);
  return words;
}();

constexpr size_t kLongestHead = 500;  // tokens in the brackets of a misspelt head

bool is_keyword(TokenKind kind) {
  return std::any_of(std::begin(kKeywords), std::end(kKeywords),
                     [kind](const Keyword& k) { return k.kind == kind; });
}

bool is_operand_end(TokenKind kind) {
  return kind == TokenKind::Name || kind == TokenKind::Number || kind == TokenKind::RightParen ||
         kind == TokenKind::RightBracket;
}

bool is_word_or_number(TokenKind kind) { return kind == TokenKind::Name || kind == TokenKind::Number; }

bool ends_statement(TokenKind kind) {
  return kind == TokenKind::Semicolon || kind == TokenKind::LeftBrace || kind == TokenKind::RightBrace ||
         kind == TokenKind::Colon;
}

class Translator {
 public:
  Translator(std::span<const Token> tokens, Diagnostics& diagnostics)
      : tokens_(tokens), diagnostics_(diagnostics) {
    for (size_t i = 1; i + 1 < tokens.size(); ++i)
      if (kind(i) == TokenKind::Name && kind(i - 1) == TokenKind::RightBrace &&
          kind(i + 1) == TokenKind::Semicolon)
        types_.insert(tokens[i].text);
  }

  std::span<const Token> run(std::vector<Token>& changed) {
    while (at_ < tokens_.size()) {
      const Token& token = tokens_[at_];
      if (token.kind == TokenKind::Pragma || token.kind == TokenKind::Declare) directive_ = true;
      if (token.kind == TokenKind::DirectiveEnd) directive_ = false;
      if (token.kind == TokenKind::LeftBrace) ++depth_;
      if (token.kind == TokenKind::RightBrace) --depth_;
      const bool translated = !directive_ && (token.kind == TokenKind::Name ? word(token) : sign(token));
      if (!translated) take(token.kind);
    }
    if (same_) return tokens_;
    changed = std::move(out_);
    return changed;
  }

 private:
  TokenKind kind(size_t i) const { return i < tokens_.size() ? tokens_[i].kind : TokenKind::End; }
  TokenKind next(size_t distance = 1) const { return kind(at_ + distance); }
  TokenKind before() const {
    if (same_) return at_ == 0 ? TokenKind::Semicolon : tokens_[at_ - 1].kind;
    return out_.empty() ? TokenKind::Semicolon : out_.back().kind;
  }

  void take(TokenKind as, size_t count = 1) {
    if (same_) {
      if (as == tokens_[at_].kind && count == 1) {
        ++at_;
        return;
      }
      begin_change();
    }
    out_.push_back(tokens_[at_]);
    out_.back().kind = as;
    out_.back().span.end = tokens_[at_ + count - 1].span.end;
    at_ += count;
  }
  // Most programs have nothing foreign, so that their tokens need no copy.
  void begin_change() {
    same_ = false;
    out_.reserve(tokens_.size());
    out_.assign(tokens_.begin(), tokens_.begin() + static_cast<std::ptrdiff_t>(at_));
  }

  bool foreign(TokenKind as, std::string_view text, std::string_view advice, size_t count = 1) {
    diagnostics_.report(Diag::ForeignWord, {tokens_[at_].span.begin, tokens_[at_ + count - 1].span.end},
                        {std::string(text), std::string(advice)});
    if (same_) begin_change();
    take(as, count);
    return true;
  }

  // A sign that does not stand there, at the place of the token that comes next.
  void insert(TokenKind kind) {
    if (same_) begin_change();
    out_.push_back(tokens_[std::min(at_, tokens_.size() - 1)]);
    out_.back().kind = kind;
  }

  // CASE a OF 1: ... END_CASE
  bool case_of(const Token& token) {
    if (depth_ <= 0 || !equal_but_for_case(token.text, "case") || !is_word_or_number(next()) || next(2) != TokenKind::Name ||
        !equal_but_for_case(tokens_[at_ + 2].text, "of"))
      return false;
    foreign(TokenKind::Switch, token.text, "write 'switch (" + std::string(tokens_[at_ + 1].text) + ") { case 1: ... break; }'");
    insert(TokenKind::LeftParen);
    take(kind(at_));
    insert(TokenKind::RightParen);
    take(TokenKind::LeftBrace);  // in place of OF
    ++depth_;
    ++cases_;
    return true;
  }
  bool case_label() {
    if (cases_ == 0 || !ends_statement(before()) || next() != TokenKind::Colon) return false;
    insert(TokenKind::Case);
    take(TokenKind::Number);
    return true;
  }

  // The name of the command in whose brackets the next token stands, or nothing.
  bool in_command() const {
    int level = 0;
    for (size_t n = at_; n-- > 1;) {
      if (kind(n) == TokenKind::RightParen) ++level;
      if (kind(n) == TokenKind::Semicolon || kind(n) == TokenKind::LeftBrace) return false;
      if (kind(n) == TokenKind::LeftParen && --level < 0) return kind(n - 1) == TokenKind::Name && tokens_[n - 1].text.starts_with('_');
    }
    return false;
  }
  // _MoviLink(&m)
  bool address() {
    if ((before() != TokenKind::LeftParen && before() != TokenKind::Comma) || next() != TokenKind::Name || !in_command()) return false;
    const std::string name(tokens_[at_ + 1].text);
    foreign(TokenKind::And, "&" + name, "statements take the name alone: write '" + name + "'");
    out_.pop_back();
    return true;
  }

  // `:=` and `<>`, written together.
  bool sign(const Token& token) {
    if (token.kind == TokenKind::And) return address();
    if (token.kind == TokenKind::Number) return case_label();
    if (token.kind != TokenKind::Colon && token.kind != TokenKind::Less) return false;
    if (at_ + 1 >= tokens_.size() || tokens_[at_ + 1].spaced || tokens_[at_ + 1].line_start) return false;
    if (token.kind == TokenKind::Colon && next() == TokenKind::Assign)
      return foreign(TokenKind::Assign, ":=", "'=' assigns", 2);
    if (token.kind == TokenKind::Less && next() == TokenKind::Greater)
      return foreign(TokenKind::NotEqual, "<>", "'!=' compares", 2);
    return false;
  }

  bool word(const Token& token) {
    if (before() == TokenKind::Dot || types_.contains(token.text)) return false;
    const bool known = kSpellings.may_have(token.text);
    return (known && (case_of(token) || plc_word(token))) || keyword(token, known);
  }

  // A bracket with something in it: no call of a function of the program has that.
  bool filled_bracket(size_t i) const {
    return kind(i) == TokenKind::LeftParen && kind(i + 1) != TokenKind::RightParen;
  }
  // What a statement or an operand begins with, and nothing goes on with.
  bool statement_at(size_t i) const {
    const TokenKind found = kind(i);
    return is_word_or_number(found) || found == TokenKind::LeftBrace ||
           (is_keyword(found) && found != TokenKind::Else);
  }

  bool plc_word(const Token& token) {
    const bool operand = is_word_or_number(next()) || filled_bracket(at_ + 1) || next() == TokenKind::Numof;
    const bool negated =
        next() == TokenKind::Not || next() == TokenKind::Minus || next() == TokenKind::BitNot;
    for (const Infix& infix : kInfix)
      if (equal_but_for_case(token.text, infix.word) && is_operand_end(before()) && (operand || negated))
        return foreign(infix.kind, token.text, infix.advice);
    if (equal_but_for_case(token.text, "not") && !is_operand_end(before()) && operand)
      return foreign(TokenKind::Not, token.text, "write '!', or '~' for bits");
    const bool else_if = std::any_of(std::begin(kElseIfs), std::end(kElseIfs),
                                     [&](std::string_view each) { return equal_but_for_case(token.text, each); });
    if (else_if && ends_statement(before()) && operand) {
      foreign(TokenKind::Else, token.text, "write 'else if'");
      insert(TokenKind::If);
      return true;
    }
    if (equal_but_for_case(token.text, "then") && is_operand_end(before()) && statement_at(at_ + 1)) {
      foreign(token.kind, token.text, "leave it out");
      out_.pop_back();
      return true;
    }
    const bool block =
        before() == TokenKind::RightParen || before() == TokenKind::Else || before() == TokenKind::Do;
    if (equal_but_for_case(token.text, "begin") && block && statement_at(at_ + 1)) {
      ++begun_;
      ++depth_;
      return foreign(TokenKind::LeftBrace, token.text, "a block begins with '{'");
    }
    if (begun_ > 0 && equal_but_for_case(token.text, "end") && ends_statement(before())) {
      --begun_;
      --depth_;
      foreign(TokenKind::RightBrace, token.text, "a block ends with '}'");
      if (kind(at_) == TokenKind::Semicolon) ++at_;
      return true;
    }
    const bool block_end =
        std::any_of(std::begin(kBlockEnds), std::end(kBlockEnds),
                    [&](std::string_view end) { return equal_but_for_case(token.text, end); });
    const bool semicolon = next() == TokenKind::Semicolon;
    const bool last = semicolon || next() == TokenKind::RightBrace || next() == TokenKind::End || statement_at(at_ + 1);
    if (!block_end || !last || !(ends_statement(before()) || before() == TokenKind::End)) return false;
    const bool closes = cases_ > 0 && equal_but_for_case(token.text, "end_case");
    foreign(closes ? TokenKind::RightBrace : token.kind, token.text, "a block ends with '}'", semicolon ? 2 : 1);
    if (!closes) out_.pop_back();
    if (closes) --cases_, --depth_;
    return true;
  }

  // `known`: one of them may have this spelling.
  bool keyword(const Token& token, bool known) {
    for (const Keyword& row : known ? std::span(kKeywords) : std::span<const Keyword>())
      if (equal_but_for_case(token.text, row.spelling) && stands_for(row.kind)) return meant(row);
    if (depth_ > 0 && ends_statement(before()) && is_word_or_number(next()) && kind(at_ + 2) == TokenKind::Colon &&
        stdlib::nearest(token.text, std::array<std::string_view, 1>{"case"}) == "case")
      return meant({"case", TokenKind::Case});
    // Misspelt heads of statements have something in their brackets and a statement after them.
    if (depth_ <= 0 || !filled_bracket(at_ + 1) || !statement_at(behind_bracket(at_ + 1))) return false;
    static constexpr std::string_view kHeads[] = {"if", "while", "for", "switch"};
    const std::string_view best = stdlib::nearest(token.text, kHeads);
    for (const Keyword& row : kKeywords)
      if (!best.empty() && row.spelling == best) return meant(row);
    return false;
  }

  bool meant(const Keyword& row) {
    diagnostics_.report(Diag::KeywordSpelling, tokens_[at_].span,
                        {std::string(tokens_[at_].text), std::string(row.spelling)});
    take(row.kind);
    return true;
  }

  // Whether the word can be nothing else than the keyword here.
  bool stands_for(TokenKind wanted) const {
    const bool inside = depth_ > 0;
    const bool first =
        ends_statement(before()) || before() == TokenKind::RightParen || before() == TokenKind::Else;
    switch (wanted) {
      case TokenKind::If:
      case TokenKind::While:
      case TokenKind::For:
      case TokenKind::Switch:
        // IF a THEN; with brackets it is found as a misspelt head is.
        return inside && is_word_or_number(next()) && ends_statement(before());
      case TokenKind::Long: return next() == TokenKind::Name && !is_operand_end(before());
      case TokenKind::Initial:
        return next() == TokenKind::Long || (next() == TokenKind::Name && kind(at_ + 2) == TokenKind::Name);
      case TokenKind::Typedef: return next() == TokenKind::Struct;
      case TokenKind::Struct: return before() == TokenKind::Typedef;
      case TokenKind::Numof: return filled_bracket(at_ + 1);
      case TokenKind::Else:
      case TokenKind::Do: return inside && first && statement_at(at_ + 1);
      case TokenKind::Case: return inside && first && is_word_or_number(next());
      case TokenKind::Default: return inside && first && next() == TokenKind::Colon;
      default: return false;
    }
  }

  size_t behind_bracket(size_t open) const {
    int level = 0;
    const size_t last = std::min(open + kLongestHead, tokens_.size());
    for (size_t i = open; i < last; ++i) {
      if (tokens_[i].kind == TokenKind::LeftParen) ++level;
      if (tokens_[i].kind == TokenKind::RightParen && --level == 0) return i + 1;
      if (tokens_[i].kind == TokenKind::LeftBrace) break;
    }
    return tokens_.size();
  }

  std::span<const Token> tokens_;
  Diagnostics& diagnostics_;
  std::vector<Token> out_;
  std::unordered_set<std::string_view> types_;  // names after a '}': of structure types
  bool same_ = true;  // nothing is changed so far, and out_ is empty
  size_t at_ = 0;
  int depth_ = 0;
  int begun_ = 0;  // BEGIN without END so far
  int cases_ = 0;  // CASE ... OF without END_CASE so far
  bool directive_ = false;
};

}  // namespace

std::span<const Token> without_foreign_words(std::span<const Token> tokens, std::vector<Token>& changed,
                                             Diagnostics& diagnostics) {
  return Translator(tokens, diagnostics).run(changed);
}

}  // namespace ipos::compiler
