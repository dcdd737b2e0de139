// Process data words in a CAN frame: always three on SBus, word 1 first, high byte first (1053 1610 p. 39).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/bus/can/frame.hpp"

namespace ipos::runtime {

inline constexpr uint8_t kSbusProcessWords = 3;
using ProcessWords = std::array<uint16_t, kSbusProcessWords>;

constexpr Frame process_frame(uint32_t id, const ProcessWords& words) {
  Frame frame;
  frame.id = id;
  frame.length = 2 * kSbusProcessWords;
  for (size_t i = 0; i < words.size(); ++i) {
    frame.data[2 * i] = static_cast<uint8_t>(words[i] >> 8);
    frame.data[2 * i + 1] = static_cast<uint8_t>(words[i] & 0xFF);
  }
  return frame;
}

// Nothing when the frame does not have exactly three words.
constexpr std::optional<ProcessWords> process_words(const Frame& frame) {
  if (!is_plain(frame) || frame.length != 2 * kSbusProcessWords) return std::nullopt;
  ProcessWords words{};
  for (size_t i = 0; i < words.size(); ++i)
    words[i] = static_cast<uint16_t>((frame.data[2 * i] << 8) | frame.data[2 * i + 1]);
  return words;
}

}  // namespace ipos::runtime
