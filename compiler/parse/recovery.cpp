// Where to go on after a syntax error. The aim: the rest is parsed as if the mistake had not been made, so
// that each message is a mistake of its own. Brackets tell which construct the error is in.
#include <algorithm>

#include "compiler/parse/token_feed.hpp"

namespace ipos::compiler {
namespace {

bool is_head(TokenKind kind) {
  return kind == TokenKind::If || kind == TokenKind::For || kind == TokenKind::While ||
         kind == TokenKind::Switch;
}

bool is_limit(TokenKind kind) {
  return kind == TokenKind::End || kind == TokenKind::Pragma || kind == TokenKind::Declare;
}

bool ends_operand(TokenKind kind) {
  return kind == TokenKind::Name || kind == TokenKind::Number || kind == TokenKind::RightParen ||
         kind == TokenKind::RightBracket || kind == TokenKind::Increment || kind == TokenKind::Decrement;
}

}  // namespace

Symbol TokenFeed::resume() {
  resuming_ = false;
  // A third error at the same token: leave it behind, or there would be no end. At the second one it stays: a '}' fits as
  // soon as the statement that is missing before it is taken as there.
  const size_t at = repeated_ > 1 && found().kind != TokenKind::End ? last_ + 1 : last_;
  if (directive_) {
    directive_.reset();
    return sync(behind_directive(at));
  }
  // What is open inside the innermost braces goes; the head of an if, for, while or switch decides.
  while (!open_.empty() && (open_.back().kind != TokenKind::LeftBrace || open_.back().values)) {
    size_t head = open_.size();
    for (size_t i = open_.size(); i > 0 && open_[i - 1].kind != TokenKind::LeftBrace; --i)
      if (is_head(open_[i - 1].kind)) {
        head = i - 1;
        break;
      }
    if (head < open_.size()) {
      const size_t stop = behind_head(at, head);
      open_.resize(head);
      return sync(stop);
    }
    if (open_.size() == 1 && open_.back().kind == TokenKind::LeftParen) break;  // of a function's head
    open_.pop_back();
  }
  if (inside_braces()) return sync(behind_statement(at));
  Place place = Place::Next;
  const size_t stop = behind_declaration(at, place);
  open_.clear();
  fresh_ = place == Place::Next;
  if (place == Place::Body) open_.push_back({TokenKind::LeftBrace, stop, false});
  return sync(stop, place);
}

Symbol TokenFeed::sync(size_t at, Place place) {
  next_ = at;
  last_ = SIZE_MAX;
  const Span span{tokens_[at].span.begin, tokens_[at].span.begin};
  switch (place) {
    case Place::Block: return {Parser::token::SyncBlock, span, {}};
    case Place::Body: return {Parser::token::SyncBody, span, {}};
    case Place::Next: break;
  }
  return {Parser::token::Sync, span, {}};
}

size_t TokenFeed::behind_directive(size_t at) const {
  while (tokens_[at].kind != TokenKind::DirectiveEnd && tokens_[at].kind != TokenKind::End) ++at;
  return tokens_[at].kind == TokenKind::End ? at : at + 1;
}

// After the ')' of the head, or where its statement seems to begin without one.
size_t TokenFeed::behind_head(size_t at, size_t head) const {
  auto level = std::count_if(open_.begin() + static_cast<std::ptrdiff_t>(head), open_.end(),
                             [](const Open& open) { return open.kind == TokenKind::LeftParen; });
  for (size_t i = at;; ++i) {
    const TokenKind kind = tokens_[i].kind;
    if (kind == TokenKind::LeftParen) ++level;
    if (kind == TokenKind::RightParen && --level <= 0) return i + 1;
    const bool semicolon = kind == TokenKind::Semicolon && open_[head].kind != TokenKind::For;
    if (semicolon || kind == TokenKind::LeftBrace || kind == TokenKind::RightBrace || is_limit(kind) ||
        begins_statement(i))
      return i;
  }
}

size_t TokenFeed::behind_statement(size_t at) {
  if (continues_here(at)) return at;
  int level = 0;
  for (size_t i = at;; ++i) {
    const TokenKind kind = tokens_[i].kind;
    if (kind == TokenKind::Semicolon) return i + 1;
    if (kind == TokenKind::RightBrace || is_limit(kind) || begins_statement(i)) return i;
    if (kind == TokenKind::LeftParen) ++level;
    if (kind == TokenKind::RightParen) --level;
    if (kind == TokenKind::LeftBrace) {
      const size_t behind = behind_group(i);
      if (behind == i || tokens_[behind].line_start) return behind;
      i = behind - 1;
    }
    // Two operands with a line end between them: the ';' is missing there.
    if (i > at && level <= 0 && kind == TokenKind::Name && tokens_[i].line_start &&
        ends_operand(tokens_[i - 1].kind))
      return i;
  }
}

// At the next declaration, or at the body of a function whose head is wrong.
size_t TokenFeed::behind_declaration(size_t at, Place& place) {
  if (at == last_ && brace_fits_ && before(1).kind == TokenKind::RightParen &&
      (begins_statement(at) || tokens_[at + 1].kind != TokenKind::LeftParen)) {
    place = Place::Body;
    return at;
  }
  if (continues_here(at) && tokens_[at].kind != TokenKind::LeftBrace) return at;
  auto level = static_cast<int>(open_.size());
  size_t start = std::min(declaration_, at);
  for (size_t i = at;; ++i) {
    const TokenKind kind = tokens_[i].kind;
    const bool aliased = i > 0 && tokens_[i - 1].kind == TokenKind::Typedef;
    if (is_limit(kind) || (level <= 0 && !aliased && begins_declaration(i))) return i;
    if (kind == TokenKind::LeftParen) ++level;
    if (kind == TokenKind::RightParen) --level;
    if (kind == TokenKind::Semicolon) {
      level = 0;
      start = i + 1;
    }
    if (kind == TokenKind::LeftBrace) {
      if (is_function_head(start, i)) {
        place = Place::Block;
        return i;
      }
      const size_t behind = behind_group(i);
      if (behind != i) i = behind - 1;
      start = i + 1;
    }
  }
}

// A lone name, or a name with a bracket and no word of a statement.
bool TokenFeed::is_function_head(size_t begin, size_t end) const {
  if (begin >= end) return false;
  bool bracket = end - begin == 1 && tokens_[begin].kind == TokenKind::Name;
  for (size_t i = begin; i < end; ++i) {
    if (begins_statement(i)) return false;
    if (i > begin && tokens_[i].kind == TokenKind::LeftParen && tokens_[i - 1].kind == TokenKind::Name)
      bracket = true;
  }
  return bracket;
}

// After the matching '}', or the '{' itself when there is none.
size_t TokenFeed::behind_group(size_t brace) {
  if (behind_groups_.empty()) {
    std::vector<size_t> open;
    for (size_t i = 0; i < tokens_.size(); ++i) {
      if (tokens_[i].kind == TokenKind::LeftBrace) {
        open.push_back(i);
      } else if (tokens_[i].kind == TokenKind::RightBrace && !open.empty()) {
        behind_groups_.emplace(open.back(), i + 1);
        open.pop_back();
      }
    }
    for (const size_t i : open) behind_groups_.emplace(i, i);
  }
  return behind_groups_.at(brace);
}

// Only a ';' is missing before the token.
bool TokenFeed::continues_here(size_t at) const {
  if (!semicolon_fits_ || at != last_) return false;
  const bool body =
      tokens_[at].kind == TokenKind::LeftBrace && at > 0 && tokens_[at - 1].kind == TokenKind::RightParen;
  return body || tokens_[at].line_start || begins_statement(at);
}

bool TokenFeed::begins_statement(size_t at) const {
  switch (tokens_[at].kind) {
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
    case TokenKind::Goto: return true;
    case TokenKind::Long:
    case TokenKind::Initial:
    case TokenKind::Typedef: return tokens_[at].line_start;
    default: return false;
  }
}

bool TokenFeed::begins_declaration(size_t at) const {
  const Token& token = tokens_[at];
  switch (token.kind) {
    case TokenKind::Long:
    case TokenKind::Initial:
    case TokenKind::Typedef:
#define FOREIGN_TYPE(kind, spelling) case TokenKind::kind:
#define FOREIGN_QUALIFIER(kind, spelling) case TokenKind::kind:
#define KEYWORD(kind, spelling)
#include "compiler/preprocess/tokens.def"
      return true;
    case TokenKind::Name: break;
    default: return false;
  }
  const bool starts = token.line_start || (at > 0 && tokens_[at - 1].kind == TokenKind::Semicolon);
  if (!starts || tokens_[at + 1].kind == TokenKind::End) return false;
  const bool function = tokens_[at + 1].kind == TokenKind::LeftParen &&
                        tokens_[at + 2].kind == TokenKind::RightParen &&
                        tokens_[at + 3].kind == TokenKind::LeftBrace;
  return function || types_.contains(token.text) || tokens_[at + 1].kind == TokenKind::Name;
}

}  // namespace ipos::compiler
