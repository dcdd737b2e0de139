// URIs and positions. Bytes that are no UTF-8 count as one character each, as editors show them.
#include "tools/lsp_base/positions.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace ipos::tools::lsp {
namespace {

constexpr std::string_view kFileScheme = "file://";
constexpr std::string_view kLineEnds = "\r\n";  // LF, CR LF, or CR alone (LSP 3.17, text documents)

bool is_line_end(char c) { return c == '\n' || c == '\r'; }  // asked of each character of a text

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool is_drive(std::string_view path) {
  return path.size() > 2 && path[0] == '/' && path[2] == ':' &&
         ((path[1] >= 'a' && path[1] <= 'z') || (path[1] >= 'A' && path[1] <= 'Z'));
}

// Bytes of the character at the beginning, at least 1.
size_t character_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 1;
  if (length > text.size()) return 1;
  for (size_t n = 1; n < length; ++n)
    if ((static_cast<unsigned char>(text[n]) & 0xC0U) != 0x80U) return 1;
  return length;
}

size_t units(size_t character, Encoding encoding) {
  if (encoding == Encoding::Utf8) return character;
  return character == 4 ? 2 : 1;
}

}  // namespace

std::string path_of(std::string_view uri) {
  const bool file = uri.size() >= kFileScheme.size() &&
                    std::equal(kFileScheme.begin(), kFileScheme.end(), uri.begin(), [](char a, char b) {
                      return a == std::tolower(static_cast<unsigned char>(b));
                    });
  if (!file) return std::string(uri);
  uri.remove_prefix(kFileScheme.size());
  uri.remove_prefix(std::min(uri.find('/'), uri.size()));  // a host
  std::string path;
  for (size_t n = 0; n < uri.size(); ++n) {
    if (uri[n] == '%' && n + 2 < uri.size() && hex_digit(uri[n + 1]) >= 0 && hex_digit(uri[n + 2]) >= 0) {
      path += static_cast<char>(hex_digit(uri[n + 1]) * 16 + hex_digit(uri[n + 2]));
      n += 2;
    } else {
      path += uri[n];
    }
  }
  return is_drive(path) ? path.substr(1) : path;
}

std::string uri_of(std::string_view path) {
  const bool drive = is_drive("/" + std::string(path));
  if (!path.starts_with('/') && !drive)
    return path.find(':') != std::string_view::npos ? std::string(path)
                                                    : std::string(kHeaderScheme) + std::string(path);
  std::string uri(kFileScheme);
  if (drive) uri += '/';
  for (const char c : path) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       std::string_view("-_.~/").find(c) != std::string_view::npos;
    if (plain) {
      uri += c;
    } else if (drive && c == '\\') {
      uri += '/';
    } else {
      constexpr std::string_view kDigits = "0123456789ABCDEF";
      uri += '%';
      uri += kDigits[static_cast<unsigned char>(c) >> 4U];
      uri += kDigits[static_cast<unsigned char>(c) & 15U];
    }
  }
  return uri;
}

std::string tidy(const std::string& path) {
  const size_t scheme = path.find("://");
  const size_t root = scheme == std::string::npos ? 0 : std::min(path.find('/', scheme + 3), path.size());
  return path.substr(0, root) + std::filesystem::path(path.substr(root)).lexically_normal().generic_string();
}

uint32_t offset_of(std::string_view text, const Json& position, Encoding encoding) {
  const auto number = [&](const char* name) {
    const auto found = position.find(name);
    if (found == position.end() || !found->is_number())
      throw RequestError(ErrorCode::InvalidParams, "no position");
    return static_cast<size_t>(std::clamp<int64_t>(found->get<int64_t>(), 0, INT32_MAX));
  };
  if (!position.is_object()) throw RequestError(ErrorCode::InvalidParams, "no position");
  size_t at = 0;
  for (size_t line = number("line"); line != 0; --line) {
    size_t end = at;
    while (end < text.size() && !is_line_end(text[end])) ++end;
    if (end == text.size()) return static_cast<uint32_t>(end);
    at = end + (text.substr(end).starts_with("\r\n") ? 2 : 1);
  }
  for (size_t left = number("character"); at < text.size() && !is_line_end(text[at]) && left != 0;) {
    const size_t length = character_length(text.substr(at));
    left -= std::min(left, units(length, encoding));
    at += length;
  }
  return static_cast<uint32_t>(at);
}

Json position_of(std::string_view text, uint32_t offset, Encoding encoding) {
  // Within CR LF is in front of it.
  if (offset != 0 && offset < text.size() && text.substr(offset - 1).starts_with("\r\n")) --offset;
  const std::string_view before = text.substr(0, offset);
  int64_t line = 0;
  for (size_t n = 0; n < before.size(); ++n)
    line += before[n] == '\n' || (before[n] == '\r' && !text.substr(n).starts_with("\r\n"));
  const size_t start = before.find_last_of(kLineEnds) + 1;  // npos + 1 is 0
  size_t character = 0;
  for (std::string_view rest = before.substr(start); !rest.empty();) {
    const size_t length = character_length(rest);
    character += units(length, encoding);
    rest.remove_prefix(length);
  }
  return {{"line", line}, {"character", character}};
}

Json range_of(std::string_view text, uint32_t begin, uint32_t end, Encoding encoding) {
  return {{"start", position_of(text, begin, encoding)}, {"end", position_of(text, end, encoding)}};
}

}  // namespace ipos::tools::lsp
