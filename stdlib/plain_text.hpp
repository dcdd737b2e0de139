// Which texts of others may stand in a line: no character of theirs moves a cursor, ends a line or begins an escape
// sequence. Readers of names refuse what is not plain, writers of messages replace it (compiler/diag/places.hpp).
#pragma once

#include <cstddef>
#include <string_view>

namespace ipos::stdlib {

// Length of the UTF-8 character at the start of the text, 0 when there is none.
size_t utf8_length(std::string_view text);

// Of a character, or of a byte that begins none: C0, DEL and C1. A tab is one, too.
bool is_control(std::string_view character);

// One line without control characters. Bytes that are no UTF-8 count as Latin-1.
bool is_plain(std::string_view text);

}  // namespace ipos::stdlib
