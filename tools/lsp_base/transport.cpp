// Framing of messages.
#include "tools/lsp_base/transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include "stdlib/plain_text.hpp"

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

constexpr std::string_view kReplacement = "\\uFFFD";

// The number of a \u at the beginning of the text.
std::optional<uint32_t> unit_at(std::string_view text) {
  if (!text.starts_with("\\u") || text.size() < 6) return std::nullopt;
  uint32_t unit = 0;
  const auto [end, status] = std::from_chars(text.data() + 2, text.data() + 6, unit, 16);
  return status == std::errc() && end == text.data() + 6 ? std::optional(unit) : std::nullopt;
}

std::string with_characters_only(std::string_view body) {
  const auto is_high = [](std::optional<uint32_t> unit) { return unit && *unit >= 0xD800 && *unit < 0xDC00; };
  const auto is_low = [](std::optional<uint32_t> unit) { return unit && *unit >= 0xDC00 && *unit < 0xE000; };
  std::string out;
  while (!body.empty()) {
    size_t length = stdlib::utf8_length(body);
    const auto unit = unit_at(body);
    const bool pair = is_high(unit) && is_low(unit_at(body.substr(6)));
    if (unit) length = pair ? 12 : 6;
    if (body[0] == '\\' && !unit) length = std::min<size_t>(2, body.size());
    if (length == 0 || (!pair && (is_high(unit) || is_low(unit)))) {
      out += kReplacement;
      body.remove_prefix(std::max<size_t>(length, 1));
    } else {
      out += body.substr(0, length);
      body.remove_prefix(length);
    }
  }
  return out;
}

}  // namespace

std::optional<std::string> MessageReader::next() {
  while (!broken_) {
    const size_t end = buffer_.find("\r\n\r\n");
    const bool has_ended = end != std::string::npos;  // else a part of its end may be there
    broken_ = has_ended ? end > kMaxHeader : buffer_.size() > kMaxHeader + 3;
    if (broken_ || !has_ended) return std::nullopt;
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
    const size_t size = end + 4 + *length;
    std::string rest = buffer_.substr(size);
    buffer_.resize(size);
    buffer_.erase(0, end + 4);
    return std::exchange(buffer_, std::move(rest));  // a large one is not there twice
  }
  return std::nullopt;
}

nlohmann::json parsed(std::string_view body) {
  nlohmann::json message = nlohmann::json::parse(body, nullptr, false);
  if (message.is_discarded()) message = nlohmann::json::parse(with_characters_only(body), nullptr, false);
  return message;
}

std::string framed(std::string_view body) {
  return fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
}

}  // namespace ipos::tools::lsp
