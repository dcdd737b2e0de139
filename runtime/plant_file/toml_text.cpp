// A scanner that knows texts and comments of TOML, nothing else.
#include "runtime/plant_file/toml_text.hpp"

namespace ipos::runtime {

std::optional<FilePlace> stray_character(std::string_view text) {
  FilePlace place{1, 0};
  std::string_view quote;  // of the text we are in
  bool comment = false;
  for (size_t at = 0; at < text.size(); ++at) {
    ++place.column;
    const char c = text[at];
    if (c == '\n') {
      place = {place.line + 1, 0};
      comment = false;
      if (quote.size() == 1) quote = {};  // such a text ends with its line; the parser reports it
    } else if (comment) {
      continue;
    } else if (!quote.empty()) {
      if (c == '\\' && quote[0] == '"' && at + 1 < text.size() && text[at + 1] != '\n') {
        ++at, ++place.column;
      } else if (text.substr(at).starts_with(quote)) {
        at += quote.size() - 1;
        place.column += static_cast<uint32_t>(quote.size() - 1);
        quote = {};
      }
    } else if (c == '"' || c == '\'') {
      const std::string_view rest = text.substr(at);
      quote = rest.substr(0, rest.starts_with("\"\"\"") || rest.starts_with("'''") ? 3 : 1);
      at += quote.size() - 1;
      place.column += static_cast<uint32_t>(quote.size() - 1);
    } else if (c == '#') {
      comment = true;
    } else if (static_cast<unsigned char>(c) >= 0x80 && !(at < 3 && text.starts_with("\xEF\xBB\xBF"))) {
      return place;
    }
  }
  return std::nullopt;
}

}  // namespace ipos::runtime
