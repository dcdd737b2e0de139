// A list of parameters, parameters/NAME.tsv, as rows. The compiler of this program reads the lists that it contains
// (built_lists), so no start reads text; who has another list reads it with the same reader when the program runs.
// Rows name pieces of the list's text by their places: they are data without pointers.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "stdlib/parameters.hpp"

namespace ipos::stdlib {

// A part of the list's text.
struct Piece {
  uint32_t at = 0;
  uint32_t size = 0;

  constexpr std::string_view of(std::string_view text) const { return text.substr(at, size); }
};

struct ListedText {
  int32_t value = 0;
  Piece text;
  bool logodrive_only = false;
  uint8_t from_standard = 0;
  uint8_t from_logodrive = 0;
};

// A line that is neither a comment nor the heading.
struct ListedRow {
  Piece line;
  uint16_t line_number = 0;
  bool good = false;  // else the members below say nothing

  Piece number, name, display, notes;
  Piece texts_of;  // of a list before: number of the row whose texts these are, "=P600"
  ParameterRules rules;
  int64_t default_value = 0;
  uint16_t index = 0;
  bool view = false;
  uint8_t quantity = 0;
  int8_t conversion = 0;
  uint16_t first_range = 0, ranges = 0;  // of those of the list
  uint16_t first_text = 0, texts = 0;
};

struct ParameterList {
  std::string_view name;
  std::string_view text;
  std::span<const ListedRow> rows;
  std::span<const ValueRange> ranges;
  std::span<const ListedText> texts;
};

// The lists that are compiled into the program.
std::span<const ParameterList> built_lists();

// A list that is read when the program runs. Name and text are the caller's.
class ReadList {
 public:
  ReadList(std::string_view name, std::string_view text);

  ParameterList list() const { return {name_, text_, rows_, ranges_, texts_}; }

 private:
  std::string_view name_, text_;
  std::vector<ListedRow> rows_;
  std::vector<ValueRange> ranges_;
  std::vector<ListedText> texts_;
};

}  // namespace ipos::stdlib
