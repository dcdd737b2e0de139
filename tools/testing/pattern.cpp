// Shell patterns as fnmatch(3) reads them; Windows has no fnmatch.
#include "tools/testing/pattern.hpp"

#include <string_view>

namespace ipos::tools::testing {
namespace {

unsigned char byte(char letter) { return static_cast<unsigned char>(letter); }

// One element of a pattern, all but '*': how long it is, and whether it means the letter.
struct Element {
  size_t length;
  bool fits;
};

// `[..]` at `at`; without its end the bracket is a letter. A `]` right after the opening stands for itself.
Element bracket(std::string_view pattern, size_t at, char letter) {
  size_t n = at + 1;
  const bool inverted = n < pattern.size() && (pattern[n] == '!' || pattern[n] == '^');
  if (inverted) ++n;
  bool found = false;
  for (const size_t first = n; n < pattern.size() && (pattern[n] != ']' || n == first);) {
    const auto bound = [&] {
      if (pattern[n] == '\\' && n + 1 < pattern.size()) ++n;
      return byte(pattern[n++]);
    };
    const unsigned char least = bound();
    const bool is_range = n + 1 < pattern.size() && pattern[n] == '-' && pattern[n + 1] != ']';
    if (is_range) ++n;
    const unsigned char most = is_range ? bound() : least;
    found = found || (least <= byte(letter) && byte(letter) <= most);
  }
  if (n >= pattern.size()) return {1, letter == '['};
  return {n + 1 - at, found != inverted};
}

Element element(std::string_view pattern, size_t at, char letter) {
  switch (pattern[at]) {
    case '?': return {1, true};
    case '[': return bracket(pattern, at, letter);
    case '\\':
      if (at + 1 < pattern.size()) return {2, pattern[at + 1] == letter};
      return {1, false};
    default: return {1, pattern[at] == letter};
  }
}

}  // namespace

// Where a letter does not fit, the last '*' takes one more.
bool matches(std::string_view pattern, std::string_view text) {
  size_t at = 0, behind_star = std::string_view::npos, taken = 0;
  for (size_t n = 0; n < text.size();) {
    if (at < pattern.size() && pattern[at] == '*') {
      behind_star = ++at;
      taken = n;
      continue;
    }
    const Element next = at < pattern.size() ? element(pattern, at, text[n]) : Element{0, false};
    if (next.fits) {
      at += next.length;
      ++n;
    } else if (behind_star != std::string_view::npos) {
      at = behind_star;
      n = ++taken;
    } else {
      return false;
    }
  }
  while (at < pattern.size() && pattern[at] == '*') ++at;
  return at == pattern.size();
}

bool is_chosen(std::string_view filter, std::string_view name) {
  return filter.find_first_of("*?[") == std::string_view::npos ? name.find(filter) != std::string_view::npos
                                                               : matches(filter, name);
}

}  // namespace ipos::tools::testing
