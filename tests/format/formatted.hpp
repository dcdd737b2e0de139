// What the formatter makes of a text, or why it refuses it, for the tests of the formatter.
#pragma once

#include <string>

#include "compiler/format/format.hpp"

namespace ipos::tests {

inline std::string formatted(const std::string& text) {
  const auto result = compiler::format_source(text);
  return result ? *result : "line " + std::to_string(result.error().line) + ": " + result.error().text;
}

}  // namespace ipos::tests
