// The statements: which frames they open and close. placing.cpp puts the words into lines.
#include "compiler/format/layout.hpp"

namespace ipos::compiler {
namespace {

constexpr size_t kMaxFrames = 256;  // as the compiler's own limit of nesting

bool may_end_macro_use(TokenKind kind) {
  return kind == TokenKind::Name || kind == TokenKind::Number || kind == TokenKind::RightParen;
}

bool is_word(TokenKind kind) {
  return kind == TokenKind::Name || kind == TokenKind::Number || kind >= TokenKind::Long;
}

std::string_view directive_word(std::string_view line) {
  const size_t begin = line.find_first_not_of(" \t\f\v", line.find('#') + 1);
  if (begin == std::string_view::npos) return {};
  const size_t end = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz", begin);
  return line.substr(begin, end == std::string_view::npos ? end : end - begin);
}

}  // namespace

tl::expected<std::vector<Line>, FormatError> Layout::run() {
  for (at_ = 0; at_ < pieces_.size(); ++at_) {
    const Piece& piece = pieces_[at_];
    switch (piece.kind) {
      case Piece::Kind::LineComment:
      case Piece::Kind::BlockComment: comments_.push_back(&piece); break;
      case Piece::Kind::Directive: directive(piece); break;
      case Piece::Kind::End: place_comments(true, content_indent()); break;
      case Piece::Kind::Token:
        if (piece.token == TokenKind::LeftBrace)
          open_brace(piece);
        else if (piece.token == TokenKind::RightBrace)
          close_brace(piece);
        else if (!token(piece))
          return tl::unexpected(FormatError{piece.line, "a '#' inside of a line"});
        break;
    }
    if (state_.frames.size() > kMaxFrames || conditions_.size() > kMaxFrames)
      return tl::unexpected(FormatError{piece.line, "statements or conditions are nested too deep"});
  }
  return std::move(lines_);
}

// The next word, past comments and preprocessor lines.
TokenKind Layout::next_token() const {
  for (size_t n = at_ + 1; n < pieces_.size(); ++n)
    if (pieces_[n].kind == Piece::Kind::Token) return pieces_[n].token;
  return TokenKind::End;
}

uint32_t Layout::content_indent() const {
  if (state_.frames.empty()) return 0;
  const Frame& top = state_.frames.back();
  switch (top.kind) {
    case Frame::Kind::Braces: return top.indent + (top.labels ? 2 : 1);
    case Frame::Kind::IfDone:
    case Frame::Kind::DoTail: return top.indent;
    default: return top.indent + 1;
  }
}

// Whether the text has a line end between the last word and this one.
bool Layout::fresh(const Piece& piece) const {
  if (piece.newlines != 0) return true;
  for (const Piece* comment : comments_)
    if (comment->newlines != 0) return true;
  return false;
}

void Layout::open_brace(const Piece& piece) {
  uint32_t indent = state_.indent;
  if (state_.start) indent = state_.body ? state_.frames.back().indent : content_indent();
  const bool record = !state_.start && state_.record;
  place(piece, true, indent);
  state_.frames.push_back({Frame::Kind::Braces, indent, false, record});
  state_.brackets = 0;
  state_.start = true;
  state_.body = state_.head = state_.record = false;
}

void Layout::close_brace(const Piece& piece) {
  state_.brackets = 0;
  while (!state_.frames.empty() && state_.frames.back().kind != Frame::Kind::Braces) state_.frames.pop_back();
  if (state_.frames.empty()) {  // one too many
    place(piece, true, 0);
    finish_statement();
    return;
  }
  const Frame frame = state_.frames.back();
  place_comments(true, content_indent());
  state_.frames.pop_back();
  place(piece, true, frame.indent);
  if (frame.record) {
    state_.indent = frame.indent;
    state_.start = state_.body = state_.head = false;
  } else {
    finish_statement();
  }
}

bool Layout::token(const Piece& piece) {
  if (piece.token == TokenKind::Hash) return false;
  // Two operands in two lines without an operator between them: a macro stood for a whole statement.
  if (!state_.start && fresh(piece) && state_.brackets == 0 && !state_.head && !state_.label &&
      may_end_macro_use(last_.kind) && is_word(piece.token))
    finish_statement();
  if (state_.start) {
    statement_start(piece);
    return true;
  }
  // The name after the brace of a structure stays there, except after a preprocessor line.
  const bool behind_brace = last_.kind == TokenKind::RightBrace && !lines_.back().verbatim;
  place(piece, fresh(piece) && !behind_brace, state_.indent + 1);
  behind(piece);
  return true;
}

void Layout::statement_start(const Piece& piece) {
  const bool has_top = !state_.frames.empty();
  const Frame::Kind top = has_top ? state_.frames.back().kind : Frame::Kind::Braces;
  bool new_line = true;
  uint32_t indent = content_indent();
  if (state_.body) {
    new_line = fresh(piece);
    if (!new_line) indent = state_.frames.back().indent;
  } else if (piece.token == TokenKind::Semicolon && last_.kind == TokenKind::RightBrace && !fresh(piece)) {
    new_line = false;
  }
  const bool label = piece.token == TokenKind::Case || piece.token == TokenKind::Default;
  if (label && has_top && top == Frame::Kind::Braces) {
    state_.frames.back().labels = true;
    indent = state_.frames.back().indent + 1;
  }
  state_.indent = indent;
  place(piece, new_line, indent);
  state_.body = false;
  state_.label = label;
  state_.questions = 0;
  state_.record = piece.token == TokenKind::Typedef;

  const auto open = [&](Frame::Kind kind) { state_.frames.push_back({kind, indent}); };
  switch (piece.token) {
    case TokenKind::Else:
      if (top == Frame::Kind::IfDone) state_.frames.pop_back();
      open(Frame::Kind::Plain);
      state_.body = true;
      return;
    case TokenKind::Do:
      open(Frame::Kind::Do);
      state_.body = true;
      return;
    case TokenKind::While:
      if (top != Frame::Kind::DoTail) open(Frame::Kind::Plain);
      state_.head = top != Frame::Kind::DoTail;
      break;
    case TokenKind::If: open(Frame::Kind::If); break;
    case TokenKind::For: open(Frame::Kind::For); break;
    case TokenKind::Switch: open(Frame::Kind::Plain); break;
    default: break;
  }
  if (piece.token == TokenKind::If || piece.token == TokenKind::For || piece.token == TokenKind::Switch)
    state_.head = true;
  behind(piece);
}

// What a word of a statement that is placed changes.
void Layout::behind(const Piece& piece) {
  state_.start = false;
  switch (piece.token) {
    case TokenKind::LeftParen:
    case TokenKind::LeftBracket: ++state_.brackets; break;
    case TokenKind::RightParen:
    case TokenKind::RightBracket:
      if (state_.brackets != 0) --state_.brackets;
      if (state_.brackets == 0 && state_.head) {
        state_.head = false;
        state_.start = state_.body = true;
      }
      break;
    case TokenKind::Question: ++state_.questions; break;
    case TokenKind::Colon:
      if (state_.questions != 0) {
        --state_.questions;
      } else if (state_.label) {
        state_.label = false;
        state_.start = true;
      }
      break;
    case TokenKind::Semicolon: {
      const bool in_for = state_.head && state_.brackets != 0 && !state_.frames.empty() &&
                          state_.frames.back().kind == Frame::Kind::For;
      if (!in_for) finish_statement();
      break;
    }
    default: break;
  }
}

// Closes the heads whose body this was.
void Layout::finish_statement() {
  state_.brackets = 0;
  state_.start = true;
  state_.body = state_.head = state_.label = state_.record = false;
  const TokenKind next = next_token();
  while (!state_.frames.empty() && state_.frames.back().kind != Frame::Kind::Braces) {
    Frame& top = state_.frames.back();
    if (top.kind == Frame::Kind::If && next == TokenKind::Else) {
      top.kind = Frame::Kind::IfDone;
      return;
    }
    if (top.kind == Frame::Kind::Do && next == TokenKind::While) {
      top.kind = Frame::Kind::DoTail;
      return;
    }
    state_.frames.pop_back();
  }
}

// The line itself stays; every branch of a condition begins with what was open in front of it.
void Layout::directive(const Piece& piece) {
  place_comments(true, state_.start ? content_indent() : state_.indent + 1);
  start_line(0, std::string(piece.text), piece, state_.start);
  lines_.back().verbatim = true;
  const std::string_view word = directive_word(piece.text);
  if (word == "if" || word == "ifdef" || word == "ifndef") {
    conditions_.push_back({state_, last_});
  } else if ((word == "elif" || word == "else") && !conditions_.empty()) {
    state_ = conditions_.back().state;
    last_ = conditions_.back().last;
  } else if (word == "endif" && !conditions_.empty()) {
    conditions_.pop_back();
  }
}

}  // namespace ipos::compiler
