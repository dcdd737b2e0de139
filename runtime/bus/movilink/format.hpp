// Format element of MOVLNK, equal to the TYP codes of RS-485: 0 param + 1PD, 1 1PD, 2 param + 2PD, 3 2PD,
// 4 param + 3PD, 5 3PD, 6 param; + 128 = acyclic (1053 1610 p. 23-24, 47).
#pragma once

#include <cstdint>
#include <optional>

namespace ipos::runtime {

struct TelegramFormat {
  bool parameter = false;
  uint8_t words = 0;  // process data words
  bool acyclic = false;

  friend bool operator==(const TelegramFormat&, const TelegramFormat&) = default;
};

constexpr std::optional<TelegramFormat> telegram_format(int32_t code) {
  const bool acyclic = code >= 128;
  const int32_t base = acyclic ? code - 128 : code;
  if (base < 0 || base > 6) return std::nullopt;
  if (base == 6) return TelegramFormat{true, 0, acyclic};
  return TelegramFormat{base % 2 == 0, static_cast<uint8_t>(base / 2 + 1), acyclic};
}

constexpr uint8_t format_code(TelegramFormat format) {
  const int base = format.words == 0 ? 6 : 2 * (format.words - 1) + (format.parameter ? 0 : 1);
  return static_cast<uint8_t>(base + (format.acyclic ? 128 : 0));
}

}  // namespace ipos::runtime
