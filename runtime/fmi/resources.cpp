// URIs of files (RFC 8089).
#include "runtime/fmi/resources.hpp"

#include <charconv>

namespace ipos::fmi {
namespace {

std::string decoded(std::string_view text) {
  std::string out;
  for (size_t n = 0; n < text.size(); ++n) {
    unsigned byte = 0;
    if (text[n] == '%' && n + 2 < text.size() &&
        std::from_chars(text.data() + n + 1, text.data() + n + 3, byte, 16).ptr == text.data() + n + 3) {
      out += static_cast<char>(byte);
      n += 2;
    } else {
      out += text[n];
    }
  }
  return out;
}

// "/C:/a"
bool has_drive(std::string_view path) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return path.size() > 2 && path[0] == '/' && is_letter(path[1]) && path[2] == ':';
}

}  // namespace

std::string folder_of_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "file:", kHere = "localhost";
  if (!uri.starts_with(kScheme)) return uri.find("://") == std::string_view::npos ? std::string(uri) : std::string();
  uri.remove_prefix(kScheme.size());
  if (uri.starts_with("//")) {
    uri.remove_prefix(2);
    if (uri.starts_with(kHere)) uri.remove_prefix(kHere.size());
    if (!uri.starts_with('/')) return "";
  }
  if (has_drive(uri)) uri.remove_prefix(1);
  return decoded(uri);
}

}  // namespace ipos::fmi
