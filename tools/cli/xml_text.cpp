// Escapes of XML 1.0.
#include "tools/cli/xml_text.hpp"

#include "compiler/diag/places.hpp"

namespace ipos::tools {

std::string utf8(std::string_view text) {
  std::string out;
  while (true) {
    const size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (end != std::string_view::npos && line.ends_with('\r')) line.remove_suffix(1);
    out += compiler::printable(line);
    if (end == std::string_view::npos) return out;
    out += '\n';
    text.remove_prefix(end + 1);
  }
}

std::string xml_text(std::string_view text) {
  std::string out;
  std::string characters = utf8(text);
  // U+FFFE and U+FFFF are no characters of XML.
  for (const std::string_view none : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})
    for (size_t at = 0; (at = characters.find(none, at)) != std::string::npos;)
      characters.replace(at, none.size(), "\xEF\xBF\xBD");
  for (const char c : characters) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string xml_attribute(std::string_view text) {
  std::string out;
  for (const char c : xml_text(text)) out += c == '\n' ? "&#10;" : std::string(1, c);
  return out;
}

}  // namespace ipos::tools
