// Loop bodies of random programs: IPOS text in which the words K and L stand for numbers.
#pragma once

#include <cctype>
#include <cstdlib>
#include <string>
#include <utility>

namespace ipos::tests {

inline std::string numbered(std::string text, int k, int l) {
  const auto in_name = [&](size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
  };
  for (const auto& [letter, value] : {std::pair{'K', k}, std::pair{'L', l}})
    for (size_t at = 0; (at = text.find(letter, at)) != std::string::npos; ++at)
      if ((at == 0 || !in_name(at - 1)) && !in_name(at + 1)) text.replace(at, 1, std::to_string(value));
  return text;
}

// Wherever it stands by itself.
inline void replace_word(std::string& text, const std::string& word, const std::string& by) {
  const auto letter = [&](size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
  };
  for (size_t at = 0; (at = text.find(word, at)) != std::string::npos;)
    if ((at != 0 && letter(at - 1)) || letter(at + word.size()))
      ++at;
    else
      text.replace(at, word.size(), by), at += by.size();
}

// How many random plants a test tries: its own number, or that of the variable IPOS_PLANTS for a longer run. Those before
// IPOS_FIRST_PLANT are left out, so that a long run can be shared out, and one seed be looked at.
inline uint64_t number_of_environment(const char* name, uint64_t usual) {
  const char* const wanted = std::getenv(name);
  return wanted == nullptr ? usual : std::strtoull(wanted, nullptr, 10);
}
inline uint64_t plant_count(uint64_t usual) { return number_of_environment("IPOS_PLANTS", usual); }
inline uint64_t first_plant() { return number_of_environment("IPOS_FIRST_PLANT", 1); }

}  // namespace ipos::tests
