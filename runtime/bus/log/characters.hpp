// Characters of a line of a log, for its readers.
#pragma once

#include <string_view>

namespace ipos::runtime {

inline constexpr std::string_view kBlanks = " \t\r";

constexpr bool is_blank(char c) { return kBlanks.find(c) != std::string_view::npos; }

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Value of a hexadecimal digit; -1 when it is none.
constexpr int hex_digit(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace ipos::runtime
