// Cutting: tokens come from the scanner, comments from the gaps between them.
#include "compiler/format/pieces.hpp"

#include <algorithm>

#include "compiler/preprocess/scanner.hpp"

namespace ipos::compiler {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v' || c == '\r'; }

std::string_view without_end_blanks(std::string_view text) {
  while (!text.empty() && (is_blank(text.back()) || text.back() == '\x1A')) text.remove_suffix(1);
  return text;
}

class Cutter {
 public:
  explicit Cutter(const SourceFile& file) : file_(file), scanner_(file, diagnostics_) {
    if (file.text.starts_with("\xEF\xBB\xBF")) position_ = 3;
  }

  tl::expected<std::vector<Piece>, FormatError> run() {
    while (true) {
      const Token token = scanner_.next();
      comments_until(offset(token.span.begin));
      if (diagnostics_.has_errors()) return unfinished_comment();
      position_ = offset(token.span.end);
      if (token.kind == TokenKind::End) {
        add(Piece::Kind::End, token.kind, static_cast<uint32_t>(file_.text.size()), {});
        return std::move(pieces_);
      }
      if (token.kind == TokenKind::Newline)
        ++newlines_;
      else if (token.kind == TokenKind::Hash && token.line_start)
        directive(offset(token.span.begin));
      else
        add(Piece::Kind::Token, token.kind == TokenKind::Name ? keyword_kind(token.text) : token.kind,
            offset(token.span.begin), token.text);
    }
  }

 private:
  uint32_t offset(Location at) const { return at.value - file_.base; }

  uint32_t line_of(uint32_t at) const {
    const auto next = std::upper_bound(file_.line_starts.begin(), file_.line_starts.end(), at);
    return static_cast<uint32_t>(next - file_.line_starts.begin());
  }

  void add(Piece::Kind kind, TokenKind token, uint32_t begin, std::string_view text) {
    const uint32_t line = line_of(begin);
    const uint32_t start = file_.line_starts[line - 1];
    pieces_.push_back({kind, token, without_end_blanks(text), newlines_, line,
                       blank_width(std::string_view(file_.text).substr(start, begin - start))});
    newlines_ = 0;
  }

  // The text between two tokens: blanks, comments, and lines joined by a backslash, which count as blanks.
  void comments_until(uint32_t end) {
    const std::string_view text = file_.text;
    uint32_t at = position_;
    while (at + 1 < end) {
      if (text[at] != '/' || (text[at + 1] != '/' && text[at + 1] != '*')) {
        ++at;
        continue;
      }
      const bool block = text[at + 1] == '*';
      size_t stop = block ? text.find("*/", at + 2) : text.find('\n', at);
      stop = std::min<size_t>(stop == std::string_view::npos ? end : stop + (block ? 2 : 0), end);
      add(block ? Piece::Kind::BlockComment : Piece::Kind::LineComment, TokenKind::End, at,
          text.substr(at, stop - at));
      at = static_cast<uint32_t>(stop);
    }
  }

  // From the # to the end of its line, comments and joined lines included; blanks before the # belong to it.
  void directive(uint32_t hash) {
    Token token = scanner_.next();
    const bool include = token.text == "include";
    if (include) token = scanner_.header_name();
    while (token.kind != TokenKind::Newline && token.kind != TokenKind::End) token = scanner_.next();
    const uint32_t end = offset(token.span.begin);
    const uint32_t start = file_.line_starts[line_of(hash) - 1];
    const std::string_view before = std::string_view(file_.text).substr(start, hash - start);
    const bool alone = std::all_of(before.begin(), before.end(), is_blank);
    const uint32_t begin = alone ? start : hash;
    add(Piece::Kind::Directive, TokenKind::Hash, begin,
        std::string_view(file_.text).substr(begin, end - begin));
    position_ = offset(token.span.end);
    newlines_ = token.kind == TokenKind::Newline ? 1 : 0;
  }

  tl::expected<std::vector<Piece>, FormatError> unfinished_comment() const {
    const uint32_t at = offset(diagnostics_.all().back().span.begin);
    return tl::unexpected(FormatError{line_of(at), diagnostics_.all().back().text});
  }

  const SourceFile& file_;
  Diagnostics diagnostics_;
  Scanner scanner_;
  std::vector<Piece> pieces_;
  uint32_t position_ = 0;
  uint32_t newlines_ = 0;
};

// Two block comments may differ in the blanks at the ends of their lines.
bool same_comment(std::string_view a, std::string_view b) {
  const auto take_line = [](std::string_view& text) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = without_end_blanks(text.substr(0, end));
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
  };
  while (!a.empty() || !b.empty())
    if (take_line(a) != take_line(b)) return false;
  return true;
}

}  // namespace

uint32_t blank_width(std::string_view line) {
  uint32_t width = 0;
  for (const char c : line) {
    if (!is_blank(c)) break;
    width = c == '\t' ? (width / kTabWidth + 1) * kTabWidth : width + 1;
  }
  return width;
}

tl::expected<std::vector<Piece>, FormatError> cut(const SourceFile& file) { return Cutter(file).run(); }

uint32_t difference(const std::vector<Piece>& a, const std::vector<Piece>& b) {
  const auto same = [](const Piece& x, const Piece& y) {
    if (x.kind != y.kind || x.token != y.token) return false;
    return x.text == y.text || (x.kind == Piece::Kind::BlockComment && same_comment(x.text, y.text));
  };
  const auto [left, right] = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), same);
  if (left == a.end() && right == b.end()) return 0;
  return left == a.end() ? a.back().line : left->line;
}

}  // namespace ipos::compiler
