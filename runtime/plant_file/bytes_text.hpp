// "02 01 85 00 06 bcc": the bytes of a telegram as a person writes them, the check at its end worked out on demand.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace ipos::runtime {

// A word that stands for the check over the bytes before it.
struct CheckWord {
  std::string_view word;
  uint8_t (*check)(std::span<const uint8_t> bytes) = nullptr;
  size_t behind = 0;  // so many bytes follow it
};

inline std::optional<std::vector<uint8_t>> parse_bytes(std::string_view text, const CheckWord& check = {}) {
  std::vector<uint8_t> bytes;
  std::optional<size_t> checked;
  while (!text.empty()) {
    if (text.front() == ' ') {
      text.remove_prefix(1);
      continue;
    }
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(word.size());
    uint8_t byte = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), byte, 16);
    if (word == check.word && !checked) {
      checked = bytes.size();
      byte = check.check(bytes);
    } else if (status != std::errc() || end != word.data() + word.size() || word.size() != 2) {
      return std::nullopt;
    }
    bytes.push_back(byte);
  }
  if (bytes.empty() || (checked && *checked + 1 + check.behind != bytes.size())) return std::nullopt;
  return bytes;
}

}  // namespace ipos::runtime
