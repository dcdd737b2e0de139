// Variable telegrams: up to two IPOS variables in a plain CAN frame (1053 1610 p. 51, 54-61).
// The frame carries the low-order `length` bytes of the 64-bit value (DPointer + 1 : DPointer), highest first
// in MOTOROLA and lowest first in INTEL format; for 4 and 8 bytes this is the manual's table, for the rest
// ours.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "runtime/bus/can/frame.hpp"

namespace ipos::runtime {

enum class VariableLayout : uint8_t { Motorola, Intel };

struct VariableFormat {
  uint8_t length = 0;  // bytes, 0..8
  VariableLayout layout = VariableLayout::Motorola;

  // Variables the telegram touches: the second one only with more than 4 bytes.
  constexpr uint8_t variables() const { return length == 0 ? 0 : length <= 4 ? 1 : 2; }
  friend bool operator==(const VariableFormat&, const VariableFormat&) = default;
};

// The length element (Len or Format): 0..8 and 100h..108h are permitted.
constexpr std::optional<VariableFormat> variable_format(int32_t word) {
  if (word >= 0 && word <= 8) return VariableFormat{static_cast<uint8_t>(word), VariableLayout::Motorola};
  if (word >= 0x100 && word <= 0x108)
    return VariableFormat{static_cast<uint8_t>(word - 0x100), VariableLayout::Intel};
  return std::nullopt;
}

struct VariablePair {
  int32_t low = 0;   // variable DPointer
  int32_t high = 0;  // variable DPointer + 1

  friend bool operator==(const VariablePair&, const VariablePair&) = default;
};

namespace detail {

// The number that stands in memory as this one does in a telegram of eight bytes.
inline uint64_t in_order(uint64_t value, VariableLayout layout) {
  const bool low_first = layout == VariableLayout::Intel;
  return low_first == (std::endian::native == std::endian::little) ? value : __builtin_bswap64(value);
}

// Bits of the eight bytes that a telegram does not carry.
inline unsigned missing_bits(const VariableFormat& format) { return 64U - 8U * format.length; }

}  // namespace detail

inline Frame variable_frame(uint32_t id, const VariableFormat& format, const VariablePair& variables) {
  const uint64_t value =
      uint64_t{static_cast<uint32_t>(variables.high)} << 32 | static_cast<uint32_t>(variables.low);
  const unsigned missing = detail::missing_bits(format);
  const bool low_first = format.layout == VariableLayout::Intel;
  uint64_t bytes = 0;
  if (format.length != 0)
    bytes = detail::in_order(low_first ? value << missing >> missing : value << missing, format.layout);
  return {id, format.length, std::bit_cast<std::array<uint8_t, 8>>(bytes)};
}

// Bytes a short telegram does not carry are 0; only format.variables() of the pair count. Nothing when the
// frame's length differs from the object's or the frame is extended or remote: then the object is to be left
// alone.
inline bool fits(const Frame& frame, VariableFormat format) {
  return is_plain(frame) && frame.length == format.length;
}
std::optional<VariablePair> frame_variables(const Frame& frame, VariableFormat format);

}  // namespace ipos::runtime
