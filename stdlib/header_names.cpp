// Reads the #define lines of the headers once.
#include "stdlib/header_names.hpp"

#include <vector>

#include "stdlib/headers.hpp"

namespace ipos::stdlib {
namespace {

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
  line.remove_prefix(word.size());
  return word;
}

std::vector<HeaderName> read_headers() {
  std::vector<HeaderName> names;
  for (const EmbeddedFile& header : headers::embedded_files()) {
    for (std::string_view rest = header.text; !rest.empty();) {
      const size_t end = std::min(rest.find('\n'), rest.size() - 1);
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end + 1);
      if (take_word(line) != "#define") continue;
      const std::string_view name = take_word(line);
      line = line.substr(0, line.find("//"));
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
      if (!line.empty()) names.push_back({name, line, header.name});  // else a guard
    }
  }
  return names;
}

}  // namespace

std::span<const HeaderName> header_names() {
  static const std::vector<HeaderName> kNames = read_headers();
  return kNames;
}

const HeaderName* find_header_name(std::string_view name, bool b_headers) {
  const HeaderName* found = nullptr;
  for (const HeaderName& row : header_names())
    if (row.name == name && (found == nullptr || row.header.ends_with("b.h") == b_headers)) found = &row;
  return found;
}

}  // namespace ipos::stdlib
