// Lines of words below each other: each column as wide as its widest word, the last one open.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace ipos::tools {

inline std::string columns(const std::vector<std::vector<std::string>>& lines) {
  const auto width = [](const std::string& word) {  // continuation bytes of UTF-8 take no room
    return static_cast<size_t>(std::count_if(
        word.begin(), word.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
  };
  std::vector<size_t> widths;
  for (const auto& line : lines) {
    widths.resize(std::max(widths.size(), line.size()));
    for (size_t n = 0; n < line.size(); ++n) widths[n] = std::max(widths[n], width(line[n]));
  }
  std::string text;
  for (const auto& line : lines) {
    std::string out;
    for (size_t n = 0; n < line.size(); ++n)
      out += line[n] + std::string(widths[n] - width(line[n]) + 2, ' ');
    out.erase(out.find_last_not_of(' ') + 1);
    text += out + "\n";
  }
  return text;
}

}  // namespace ipos::tools
