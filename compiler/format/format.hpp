// The formatter: one layout for every program (ours). It moves blanks and line ends only: words, comments and
// preprocessor lines stay as they are and in their order, so the image of the program stays the same.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace ipos::compiler {

struct FormatError {
  uint32_t line = 1;  // from 1
  std::string text;
};

// The text in the layout of docs/guide/editor.md. Works without includes and macros, so it takes parts of programs
// and headers, too. An error when the text cannot be cut into words for certain.
tl::expected<std::string, FormatError> format_source(std::string_view text);

// The first word that shows a text to be in another language, such as C++, whose words another layout could tear
// apart; nothing when there is none. For headers: their names do not tell.
std::optional<FormatError> foreign_word(std::string_view text);

}  // namespace ipos::compiler
