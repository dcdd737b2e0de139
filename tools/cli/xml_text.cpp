// Escapes of XML 1.0.
#include "tools/cli/xml_text.hpp"

#include "compiler/diag/places.hpp"

namespace ipos::tools {

std::string utf8(std::string_view text) {
  std::string out;
  while (true) {
    const size_t end = text.find('\n');
    out += compiler::printable(text.substr(0, end));
    if (end == std::string_view::npos) return out;
    out += '\n';
    text.remove_prefix(end + 1);
  }
}

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : utf8(text)) {
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
