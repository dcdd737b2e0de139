// Plants and tests as lines, for a cursor and for marks: also of a text that no reader takes.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ipos::tools::lsp {

std::string_view trimmed(std::string_view text);
std::vector<std::string_view> lines_of(std::string_view text);

// "station.parameters" of "[station.parameters]" and "[[station.parameters]]"; else empty.
std::string_view table_of(std::string_view row);
// What stands before '='; empty without one.
std::string_view key_of(std::string_view row);
// The first text after '=', without its quotes.
std::string_view value_of(std::string_view row);

// The texts in quotes of a row, each with the key it stands after (also in inline tables and lists).
struct TextInRow {
  std::string_view key;
  std::string_view text;  // without quotes, a piece of the row
};
std::vector<TextInRow> texts_in(std::string_view row);

// A table with its rows: from its head to the next head.
struct TomlTable {
  std::string_view name;
  size_t first = 0;  // row of the head
  size_t end = 0;    // after the last row
};
// The rows before the first head are a table without name.
std::vector<TomlTable> tables_of(const std::vector<std::string_view>& lines);

// Where a piece of a text stands in it.
inline uint32_t offset_in(std::string_view text, std::string_view piece) {
  return static_cast<uint32_t>(piece.data() - text.data());
}

}  // namespace ipos::tools::lsp
