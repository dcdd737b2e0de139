// What monitors of all kinds need: bytes that a person has written, and names that do not grow old.
#include "tools/serve/host/line_monitor.hpp"

#include <fmt/format.h>

namespace ipos::tools::serve {
namespace {

constexpr auto kNamesAge = std::chrono::seconds(2);

}  // namespace

std::string hex_digits(std::span<const uint8_t> bytes) { return fmt::format("{:02X}", fmt::join(bytes, "")); }

std::vector<uint8_t> bytes_of(const std::string& text, size_t most) {
  std::vector<uint8_t> bytes;
  int high = -1;
  for (const char c : text) {
    if (c == ' ') continue;
    const int digit = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                             : -1;
    if (digit < 0) throw Mistake(fmt::format("'{}' is no byte in hexadecimal", text));
    if (high < 0) {
      high = digit;
      continue;
    }
    bytes.push_back(static_cast<uint8_t>(high * 16 + digit));
    high = -1;
  }
  if (high >= 0) throw Mistake("the last byte has one digit only");
  if (bytes.size() > most) throw Mistake(fmt::format("a telegram has at most {} bytes here", most));
  return bytes;
}

bool NamesAge::is_over() {
  const auto now = clock_.now();
  if (known_ && now - *known_ < kNamesAge) return false;
  known_ = now;
  return true;
}

}  // namespace ipos::tools::serve
