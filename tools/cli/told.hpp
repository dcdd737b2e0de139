// What readers and the compiler say of a place in a file, for those who show it themselves in place of standard error.
#pragma once

#include <cstdint>
#include <string>

namespace ipos::tools {

struct Told {
  std::string severity;  // error or warning
  std::string file;      // empty: of no file
  uint32_t line = 0;     // 0: of the whole file
  uint32_t column = 0;   // from 1
  std::string text;
  std::string code{};  // of the compiler
  bool operator==(const Told&) const = default;
};

}  // namespace ipos::tools
