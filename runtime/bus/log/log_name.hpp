// Names of buses in logs of lines, where a blank ends a word.
#pragma once

#include <algorithm>
#include <string>

namespace ipos::runtime {

// The name as one word: blanks, and what would be seen by nobody, become `_`.
inline std::string log_name(std::string name) {
  const auto is_hidden = [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == 0x7F; };
  std::replace_if(name.begin(), name.end(), is_hidden, '_');
  return name;
}

}  // namespace ipos::runtime
