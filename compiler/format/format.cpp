// From text to text: cut, lay out, print, and make certain that nothing but the layout changed.
#include "compiler/format/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compiler/diag/places.hpp"
#include "compiler/format/layout.hpp"
#include "compiler/format/pieces.hpp"
#include "compiler/preprocess/preprocess.hpp"

namespace ipos::compiler {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool aligned(const Line& line) {
  return !line.comment.empty() && !line.verbatim && line.code != "{" &&
         line.code.find('\n') == std::string::npos;
}

// Comments after the code of neighbouring lines of one depth stand in one column.
size_t run_end(const std::vector<Line>& lines, size_t begin) {
  size_t end = begin + 1;
  while (end < lines.size() && aligned(lines[end]) && !lines[end].blank_before &&
         lines[end].indent == lines[begin].indent)
    ++end;
  return end;
}

std::string print(const std::vector<Line>& lines) {
  std::string out;
  size_t end_of_run = 0;
  size_t column = 0;
  for (size_t n = 0; n < lines.size(); ++n) {
    const Line& line = lines[n];
    if (n >= end_of_run && aligned(line)) {
      end_of_run = run_end(lines, n);
      column = 0;
      for (size_t k = n; k < end_of_run; ++k) column = std::max(column, characters(lines[k].code) + 2);
    }
    if (line.blank_before) out += '\n';
    if (!line.verbatim) out.append(size_t{line.indent} * kTabWidth, ' ');
    out += line.code;
    if (!line.comment.empty()) {
      out.append(n < end_of_run ? column - characters(line.code) : 2, ' ');
      out += line.comment;
    }
    out += '\n';
  }
  return out;
}

std::string with_line_ends(const std::string& text, std::string_view line_end) {
  std::string out;
  for (const char c : text)
    if (c == '\n')
      out += line_end;
    else
      out += c;
  return out;
}

// Words of C and C++ that the scanner cuts into several of ours: blanks between those would change them.
constexpr std::string_view kForeignWords[] = {"::", "...", ".*", "->*", "<=>", "<:", ":>", "<%", "%>", "%:"};

bool is_foreign(const Piece& piece, std::string_view text) {
  if (piece.kind != Piece::Kind::Token) return false;
  switch (piece.token) {
    case TokenKind::String:
    case TokenKind::Character:
    case TokenKind::OpenQuote:
    case TokenKind::Stray: return true;
    case TokenKind::Number: return piece.text.find('.') != std::string_view::npos;
    default: break;
  }
  const std::string_view rest = text.substr(static_cast<size_t>(piece.text.data() - text.data()));
  return std::any_of(std::begin(kForeignWords), std::end(kForeignWords),
                     [rest](std::string_view word) { return rest.starts_with(word); });
}

}  // namespace

std::optional<FormatError> foreign_word(std::string_view text) {
  SourceMap sources;
  const SourceFile& file = sources.add("", "", std::string(text));
  const auto pieces = cut(file);
  if (!pieces) return pieces.error();
  for (const Piece& piece : *pieces)
    if (piece.token != TokenKind::Stray && is_foreign(piece, file.text))
      return FormatError{piece.line, fmt::format("'{}' is no word of an IPOS program", piece.text)};
  // A character of no word is kept as it is; it tells nothing where a condition leaves it out.
  Diagnostics ignored;
  for (const Token& token : preprocess(sources, file, {}, ignored).tokens)
    if (token.kind == TokenKind::Stray)
      return FormatError{sources.position(token.span.begin).line,
                         fmt::format("'{}' is no word of an IPOS program", token.text)};
  return std::nullopt;
}

tl::expected<std::string, FormatError> format_source(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    return tl::unexpected(FormatError{1, "the text is UTF-16"});
  const size_t first_end = text.find('\n');
  const bool dos = first_end != std::string_view::npos && first_end > 0 && text[first_end - 1] == '\r';
  std::string plain;
  for (size_t n = 0; n < text.size(); ++n)
    if (text[n] != '\r' || n + 1 == text.size() || text[n + 1] != '\n') plain += text[n];

  SourceMap sources;
  const SourceFile& before = sources.add("", "", std::move(plain));
  const auto pieces = cut(before);
  if (!pieces) return tl::unexpected(pieces.error());
  const auto lines = Layout(*pieces).run();
  if (!lines) return tl::unexpected(lines.error());
  std::string out = print(*lines);
  if (text.starts_with(kByteOrderMark)) out.insert(0, kByteOrderMark);

  const SourceFile& after = sources.add("", "", out);
  const auto again = cut(after);
  const uint32_t line = again ? difference(*pieces, *again) : again.error().line;
  if (line != 0)
    return tl::unexpected(FormatError{line, "another layout would change the meaning of this line"});
  return dos ? with_line_ends(out, "\r\n") : out;
}

}  // namespace ipos::compiler
