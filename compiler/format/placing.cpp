// Words and comments into lines: blanks between words, comments after, between and above code.
#include <algorithm>

#include "compiler/format/layout.hpp"

namespace ipos::compiler {
namespace {

// What a prefix operator may follow: anything that cannot end an operand.
bool ends_operand(TokenKind kind, bool prefix) {
  switch (kind) {
    case TokenKind::Name:
    case TokenKind::Number:
    case TokenKind::String:
    case TokenKind::Character:
    case TokenKind::BadName:
    case TokenKind::RightParen:
    case TokenKind::RightBracket: return true;
    case TokenKind::Increment:
    case TokenKind::Decrement: return !prefix;
    default: return false;
  }
}

bool may_be_prefix(TokenKind kind) {
  switch (kind) {
    case TokenKind::Plus:
    case TokenKind::Minus:
    case TokenKind::Star:
    case TokenKind::And:
    case TokenKind::Not:
    case TokenKind::BitNot:
    case TokenKind::Increment:
    case TokenKind::Decrement: return true;
    default: return false;
  }
}

bool is_name_like(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

// Whether two words without a blank would be read as something else.
bool would_join(std::string_view left, std::string_view right) {
  if (left.empty() || right.empty()) return false;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool number = digit(left[0]) || (left[0] == '.' && left.size() > 1);
  if (number && (is_name_like(right[0]) || right[0] == '.')) return true;
  if (is_name_like(left.back()) && is_name_like(right[0])) return true;
  if (left == "." && digit(right[0])) return true;
  if (left == "/" && (right[0] == '/' || right[0] == '*')) return true;
  const std::string both = std::string(left) + right[0];
  return punctuator_kind(both).has_value();
}

// The lines of a comment keep their places to each other when its first line moves.
std::string moved(const Piece& comment, uint32_t indent) {
  const std::string_view text = comment.text;
  const int64_t shift = int64_t{indent} * kTabWidth - comment.column;
  std::string out;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r'))
      line.remove_suffix(1);
    if (begin != 0) {
      out += '\n';
      if (shift != 0 && !line.empty()) {
        const int64_t width = blank_width(line) + shift;
        line.remove_prefix(std::min(line.find_first_not_of(" \t\f\v\r"), line.size()));
        if (width > 0 && !line.empty()) out.append(static_cast<size_t>(width), ' ');
      }
    }
    out += line;
    begin = end + 1;
  }
  return out;
}

std::string unmoved(const Piece& comment) {
  Piece still = comment;
  still.column = 0;
  return moved(still, 0);
}

}  // namespace

void Layout::start_line(uint32_t indent, std::string code, const Piece& piece, bool blank_allowed) {
  const bool opened = lines_.empty() || (lines_.back().code == "{" && !lines_.back().verbatim);
  lines_.push_back({indent, std::move(code), {}, blank_allowed && piece.newlines > 1 && !opened, false});
}

// The comments in front of a word that begins a new line or does not; only then do they have line ends of
// their own (see fresh()).
void Layout::place_comments(bool new_line, uint32_t indent) {
  size_t n = 0;
  if (!lines_.empty()) {
    Line& line = lines_.back();
    std::string& target = new_line ? line.comment : line.code;
    for (; n < comments_.size() && comments_[n]->newlines == 0; ++n)
      target += (target.empty() ? "" : " ") + unmoved(*comments_[n]);
  }
  for (size_t first = n; n < comments_.size(); ++n) {
    const Piece& comment = *comments_[n];
    if (n != first && comment.newlines == 0)
      lines_.back().code += " " + unmoved(comment);
    else
      start_line(indent, moved(comment, indent), comment, state_.start);
  }
  comments_.clear();
}

void Layout::place(const Piece& piece, bool new_line, uint32_t indent) {
  const bool prefix = may_be_prefix(piece.token) && (state_.start || !ends_operand(last_.kind, last_.prefix));
  const bool brace = piece.token == TokenKind::LeftBrace || piece.token == TokenKind::RightBrace;
  const bool commented = !comments_.empty();
  // A comment that begins the line of this word stays in front of it.
  const bool led =
      commented && piece.newlines == 0 && fresh(piece) && !brace && piece.token != TokenKind::Else;
  place_comments(new_line, indent);
  if (led) {
    lines_.back().code += ' ';
    lines_.back().code += piece.text;
  } else if (new_line || lines_.empty()) {
    const bool blank_allowed = state_.start && !state_.body && !brace && piece.token != TokenKind::Else;
    start_line(indent, std::string(piece.text), piece, blank_allowed);
  } else {
    if (commented || spaced(piece, prefix)) lines_.back().code += ' ';
    lines_.back().code += piece.text;
  }
  last_ = {piece.token, piece.text, prefix};
}

bool Layout::spaced(const Piece& piece, bool prefix) const {
  if (would_join(last_.text, piece.text)) return true;
  switch (last_.kind) {
    case TokenKind::LeftParen:
    case TokenKind::LeftBracket:
    case TokenKind::Dot:
    case TokenKind::Arrow: return false;
    default: break;
  }
  if (last_.prefix && may_be_prefix(last_.kind)) return false;
  switch (piece.token) {
    case TokenKind::Comma:
    case TokenKind::RightParen:
    case TokenKind::RightBracket:
    case TokenKind::Dot:
    case TokenKind::Arrow:
    case TokenKind::LeftBracket: return false;
    case TokenKind::Semicolon: return false;
    case TokenKind::Colon: return !(state_.label && state_.questions == 0);
    case TokenKind::LeftParen:
      // A call, numof(x) and x[i](...) have none, keywords and operators do.
      return !(ends_operand(last_.kind, last_.prefix) || last_.kind == TokenKind::Numof ||
               last_.kind == TokenKind::Sizeof) ||
             state_.body;
    case TokenKind::Increment:
    case TokenKind::Decrement: return prefix;
    default: return true;
  }
}

}  // namespace ipos::compiler
