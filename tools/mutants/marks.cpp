// A mark is a comment of a line.
#include "tools/mutants/marks.hpp"

#include "tools/cli/text_lines.hpp"

namespace ipos::tools::mutants {

std::map<uint32_t, Mark> marks_of(std::string_view text) {
  constexpr std::string_view kWord = "equivalent:";
  std::map<uint32_t, Mark> marks;
  uint32_t number = 0;
  for (const std::string& line : text_lines(text)) {
    ++number;
    for (size_t comment = line.find("//"); comment != std::string::npos; comment = line.find("//", comment + 2)) {
      const size_t word = line.find_first_not_of(" \t", comment + 2);
      if (word == std::string::npos || line.compare(word, kWord.size(), kWord) != 0) continue;
      const size_t reason = line.find_first_not_of(" \t", word + kWord.size());
      const size_t end = line.find_last_not_of(" \t") + 1;
      marks[number] = {static_cast<uint32_t>(comment + 1), reason == std::string::npos ? "" : line.substr(reason, end - reason)};
      break;
    }
  }
  return marks;
}

}  // namespace ipos::tools::mutants
