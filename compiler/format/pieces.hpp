// What the formatter moves about: words, comments and whole preprocessor lines, each with the line ends in
// front of it. Made by the scanner of the compiler, so both agree on what a word is.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "compiler/format/format.hpp"
#include "compiler/preprocess/token.hpp"
#include "compiler/source/source.hpp"

namespace ipos::compiler {

struct Piece {
  enum class Kind : uint8_t { Token, LineComment, BlockComment, Directive, End };
  Kind kind = Kind::End;
  TokenKind token = TokenKind::End;  // of a Token; words of the language are told from names
  std::string_view text;             // in the file, without blanks at the end
  uint32_t newlines = 0;             // line ends since the piece before
  uint32_t line = 1;                 // from 1
  uint32_t column = 0;               // width of the blanks in front, for a piece that begins its line
};

inline constexpr uint32_t kTabWidth = 4;  // also what a level is indented by

// Width of the blanks at the beginning of a line, tabs to multiples of kTabWidth.
uint32_t blank_width(std::string_view line);

// The last piece is End. `file` has LF line ends only.
tl::expected<std::vector<Piece>, FormatError> cut(const SourceFile& file);

// Whether both texts mean the same: equal words, comments and preprocessor lines. 0, or the line in `a` of
// the first difference.
uint32_t difference(const std::vector<Piece>& a, const std::vector<Piece>& b);

}  // namespace ipos::compiler
