// Reads the operands out of the text form of a command (opcodes.def) at compile time, for both tables that
// are made of it.
#pragma once

#include <string_view>

#include "vm/isa/coding.hpp"

namespace ipos::vm {

// use(kind, keyword_set) for each operand in order; the set is empty for what is no keyword.
template <class Use>
constexpr void for_each_operand(std::string_view text, Use use) {
  for (size_t at = text.find('{'); at != std::string_view::npos; at = text.find('{', at + 1)) {
    const std::string_view name = text.substr(at + 1, text.find('}', at) - at - 1);
    if (name == "v")
      use(OperandKind::Variable, std::string_view{});
    else if (name == "b")
      use(OperandKind::Bit, std::string_view{});
    else if (name == "n")
      use(OperandKind::Count, std::string_view{});
    else if (name == "k")
      use(OperandKind::Constant, std::string_view{});
    else if (name == "m")
      use(OperandKind::Label, std::string_view{});
    else
      use(OperandKind::Keyword, name);
  }
}

// Operands that share packed words, and those with a word of their own.
constexpr bool is_small(OperandKind kind) {
  return kind == OperandKind::Variable || kind == OperandKind::Bit || kind == OperandKind::Count ||
         kind == OperandKind::Keyword;
}
constexpr bool is_word(OperandKind kind) {
  return kind == OperandKind::Constant || kind == OperandKind::Label;
}

// The length of the command in code words, 1..4.
constexpr uint8_t words_of(std::string_view text) {
  int small = 0;
  uint8_t words = 1;
  for_each_operand(text, [&](OperandKind kind, std::string_view) {
    if (is_word(kind) || (is_small(kind) && ++small == 3)) ++words;  // the third one begins an extension word
  });
  return words;
}

}  // namespace ipos::vm
