// A scanner that knows texts and comments of TOML, and what stands in front of a text or of a }.
#include "runtime/plant_file/toml_text.hpp"

namespace ipos::runtime {
namespace {

// Of a key without quotes.
bool is_key_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

std::optional<TomlMistake> toml_mistake(std::string_view text) {
  FilePlace place{1, 0};
  char before =
      '\n';  // the last character that is neither blank nor comment; a list goes on over the ends of lines
  std::string_view quote;  // of the text we are in
  bool comment = false;
  bool header = false;  // [ or [[ at the begin of a line, which names a table
  for (size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; at < text.size(); ++at) {
    ++place.column;
    const char c = text[at];
    if (c == '\n') {
      place = {place.line + 1, 0};
      comment = header = false;
      if (before != '[' && before != ',') before = '\n';
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
      if (std::string_view("\n=[{,.").find(before) == std::string_view::npos)
        return TomlMistake{place, "a text in quotes cannot begin here"};
      before = c;
      const std::string_view rest = text.substr(at);
      quote = rest.substr(0, rest.starts_with("\"\"\"") || rest.starts_with("'''") ? 3 : 1);
      at += quote.size() - 1;
      place.column += static_cast<uint32_t>(quote.size() - 1);
    } else if (c == '#') {
      comment = true;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      return TomlMistake{place, "this character may only stand in a text or a comment"};
    } else if (c == '}' && (before == '[' || before == ',')) {
      return TomlMistake{place, "a value is missing in front of this }"};
    } else if (header && before == '[' && c != '[' && c != ']' && !is_key_character(c) && !is_blank(c)) {
      return TomlMistake{place, "a key begins with a letter, a digit, _, - or a quote"};
    } else if (!is_blank(c)) {
      header = header || (before == '\n' && c == '[');
      before = c;
    }
  }
  return std::nullopt;
}

}  // namespace ipos::runtime
