// The story of a plant: what stands at the head of its file.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace ipos::tools {

// Its first sentences. Comments of one line each are a text; a full stop before a space ends a sentence.
inline std::string head_story(std::string_view text, size_t sentences = SIZE_MAX) {
  std::string story;
  while (text.starts_with("#")) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(1, end - 1);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (line.starts_with(' ')) line.remove_prefix(1);
    if (line.empty() && !story.empty()) break;
    if (!story.empty()) story += ' ';
    story += line;
  }
  size_t end = 0;
  for (size_t n = 0; n < sentences && end != std::string::npos; ++n) end = story.find(". ", end == 0 ? 0 : end + 1);
  return end == std::string::npos ? story : story.substr(0, end + 1);
}

}  // namespace ipos::tools
