// A set of words by their first letters and lengths: most names of a program are told from all words of a set at once, before
// one of them is compared or looked up.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ipos::compiler {

class WordFilter {
 public:
  constexpr void add(std::string_view word) { lengths_[letter(word)] |= length(word); }

  // False: no such word has been added, in capitals or not.
  constexpr bool may_have(std::string_view word) const { return (lengths_[letter(word)] & length(word)) != 0; }

 private:
  static constexpr size_t letter(std::string_view word) { return word.empty() ? 0 : static_cast<size_t>(word[0]) & 31U; }  // a and A are one
  static constexpr uint32_t length(std::string_view word) { return 1U << (word.size() & 31U); }

  std::array<uint32_t, 32> lengths_{};
};

}  // namespace ipos::compiler
