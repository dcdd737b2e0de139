// Framing of messages.
#include "tools/lsp/transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace ipos::tools::lsp {
namespace {

std::optional<size_t> content_length(std::string_view header) {
  constexpr std::string_view kName = "content-length:";
  while (!header.empty()) {
    std::string_view line = header.substr(0, header.find("\r\n"));
    header.remove_prefix(std::min(line.size() + 2, header.size()));
    const bool match = line.size() > kName.size() &&
                       std::equal(kName.begin(), kName.end(), line.begin(), [](char a, char b) {
                         return a == std::tolower(static_cast<unsigned char>(b));
                       });
    if (!match) continue;
    line.remove_prefix(kName.size());
    while (line.starts_with(' ')) line.remove_prefix(1);
    size_t length = 0;
    if (std::from_chars(line.data(), line.data() + line.size(), length).ec == std::errc{}) return length;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> MessageReader::next() {
  while (!broken_) {
    const size_t end = buffer_.find("\r\n\r\n");
    if (end == std::string::npos) {
      broken_ = buffer_.size() > kMaxHeader;
      return std::nullopt;
    }
    const auto length = content_length(std::string_view(buffer_).substr(0, end + 2));
    if (!length) {
      buffer_.erase(0, end + 4);
      continue;
    }
    if (*length > kMaxMessage) {
      broken_ = true;
      return std::nullopt;
    }
    if (buffer_.size() < end + 4 + *length) return std::nullopt;
    std::string body = buffer_.substr(end + 4, *length);
    buffer_.erase(0, end + 4 + *length);
    return body;
  }
  return std::nullopt;
}

std::string framed(std::string_view body) {
  return fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
}

}  // namespace ipos::tools::lsp
