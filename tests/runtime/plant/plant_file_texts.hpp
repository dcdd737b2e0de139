// A plant file as a text with marks: each ^ stands in front of a place where one mistake has to be told, and nothing
// else may be told. The text of the mistake need only be a part of the message.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::tests {

struct MarkedText {
  std::string text;
  std::vector<runtime::FilePlace> marks;
};

inline MarkedText without_marks(const std::string& marked) {
  MarkedText out;
  uint32_t line = 1, column = 1;
  for (const char c : marked) {
    if (c == '^') {
      out.marks.push_back({line, column});
      continue;
    }
    out.text += c;
    column = c == '\n' ? 1 : column + 1;
    line += c == '\n' ? 1 : 0;
  }
  return out;
}

struct MarkedMistake {
  std::string text;
  std::string message;
};

inline void expect_mistakes(const std::string& begin, std::initializer_list<MarkedMistake> rows,
                            const std::string& end = "") {
  for (const MarkedMistake& row : rows) {
    const MarkedText marked = without_marks(begin + row.text + end);
    const runtime::PlantFileResult result = runtime::read_plant_file(marked.text);
    std::string told;
    for (const auto& error : result.errors)
      told += std::to_string(error.place.line) + ':' + std::to_string(error.place.column) + ": " +
              error.text + '\n';
    EXPECT_EQ(result.errors.size(), marked.marks.size()) << row.text << "\ntells\n" << told;
    for (size_t n = 0; n < std::min(result.errors.size(), marked.marks.size()); ++n) {
      const runtime::FilePlace place = result.errors[n].place;
      EXPECT_EQ(std::pair(place.line, place.column), std::pair(marked.marks[n].line, marked.marks[n].column))
          << row.text << "\ntells\n"
          << told;
      EXPECT_NE(result.errors[n].text.find(row.message), std::string::npos) << row.text << "\ntells\n"
                                                                            << told;
    }
  }
}

// The plant of a text without mistakes.
inline runtime::PlantFile read_plant(const std::string& text) {
  runtime::PlantFileResult result = runtime::read_plant_file(text);
  for (const auto& error : result.errors)
    ADD_FAILURE() << text << error.place.line << ':' << error.place.column << ": " << error.text;
  return std::move(result.plant);
}

}  // namespace ipos::tests
