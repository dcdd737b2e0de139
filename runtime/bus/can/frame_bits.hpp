// How long a CAN frame is on the wire, in bits: exact with CRC-15 and stuff bits, and the bounds used for
// planning. All lengths count the 3 bits of intermission, as bus load and the rule of _SBusCommDef do.
#pragma once

#include <bitset>
#include <cstdint>

#include "runtime/bus/can/frame.hpp"

namespace ipos::runtime {

inline constexpr uint32_t kIntermissionBits = 3;

// The bits from the start of frame to the end of frame as the sender drives them (acknowledge slot
// recessive).
struct WireBits {
  std::bitset<160> recessive;
  uint32_t count = 0;
};

WireBits wire_bits(const Frame& frame);

// The first recessive bit from there on; bits.count when there is none.
uint32_t next_recessive(const WireBits& bits, uint32_t from);

// What comes before the data of a frame with a standard identifier, the same for all of its identifier and length: the
// register of the CRC behind it, the state of the stuffing, and the stuff bits in it.
struct FrameHead {
  uint16_t crc = 0;
  uint8_t stuffing = 0;
  uint8_t added = 0;
};
FrameHead frame_head(const Frame& frame);

// Exact length with stuff bits; the head is that of the frame.
uint32_t frame_bits(const Frame& frame, const FrameHead& head);
inline uint32_t frame_bits(const Frame& frame) { return frame_bits(frame, frame_head(frame)); }

// Without any stuff bit: 47 + 8 n, extended 67 + 8 n.
constexpr uint32_t unstuffed_bits(uint32_t length, bool extended) {
  return (extended ? 67U : 47U) + 8 * length;
}

// Davis, Burns, Bril, Lukkien 2007: g + 8 n + 13 + (g + 8 n - 1) / 4, g = 34 or 54, which is 55 + 10 n or 80
// + 10 n.
constexpr uint32_t worst_case_bits(uint32_t length, bool extended) {
  return (extended ? 80U : 55U) + 10 * length;
}

}  // namespace ipos::runtime
