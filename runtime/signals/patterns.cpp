// Patterns of names.
#include "runtime/signals/find.hpp"

namespace ipos::signals {

bool is_pattern(std::string_view name) { return name.find_first_of("*?") != std::string_view::npos; }

// Where a letter does not fit, the last '*' takes one more.
bool matches(std::string_view pattern, std::string_view text) {
  size_t at = 0, star = std::string_view::npos, taken = 0;
  for (size_t n = 0; n < text.size();) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      taken = n;
    } else if (at < pattern.size() && (pattern[at] == '?' || pattern[at] == text[n])) {
      ++at;
      ++n;
    } else if (star != std::string_view::npos) {
      at = star + 1;
      n = ++taken;
    } else {
      return false;
    }
  }
  while (at < pattern.size() && pattern[at] == '*') ++at;
  return at == pattern.size();
}

}  // namespace ipos::signals
