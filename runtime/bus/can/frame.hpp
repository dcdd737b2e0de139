// A CAN frame of the classic format (ISO 11898-1): what a controller hands over or takes.
// SBus MOVILINK uses 11-bit identifiers only (1053 1610 p. 37); the line carries both.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace ipos::runtime {

inline constexpr uint32_t kStandardIdLimit = 1U << 11;
inline constexpr uint32_t kExtendedIdLimit = 1U << 29;

struct Frame {
  constexpr Frame() = default;
  constexpr Frame(uint32_t its_id, uint8_t its_length, const std::array<uint8_t, 8>& its_data = {},
                  bool is_extended = false, bool is_remote = false)
      : id(its_id), length(its_length), extended(is_extended), remote(is_remote), data(its_data) {}

  uint32_t id = 0;
  uint8_t length = 0;     // 0..8; of a remote frame: the length asked for
  bool extended = false;  // 29-bit identifier
  bool remote = false;    // no data field
  uint8_t unused = 0;     // leaves no gap in the first word
  // A machine word of its own, as both halves are copied and compared by words.
  alignas(uint64_t) std::array<uint8_t, 8> data{};

  friend bool operator==(const Frame&, const Frame&) = default;
};

constexpr bool is_valid(const Frame& frame) {
  return frame.length <= 8 && frame.id < (frame.extended ? kExtendedIdLimit : kStandardIdLimit);
}

// Its data with every byte that does not go out set to 0.
constexpr std::array<uint8_t, 8> canonical_data(const Frame& frame) {
  const unsigned length = frame.remote ? 0 : frame.length;
  if (length >= 8) return frame.data;
  const unsigned bits = 8 * length;
  const uint64_t kept =
      std::endian::native == std::endian::little ? (uint64_t{1} << bits) - 1 : ~(UINT64_MAX >> bits);
  return std::bit_cast<std::array<uint8_t, 8>>(std::bit_cast<uint64_t>(frame.data) & kept);
}

// The same frame with these: equal on the wire is then equal as a value.
constexpr Frame canonical(const Frame& frame) {
  Frame same = frame;
  same.data = canonical_data(frame);
  return same;
}

// A plain data frame with an 11-bit identifier, as all SBus telegrams are.
constexpr bool is_plain(const Frame& frame) { return !frame.extended && !frame.remote; }

// The arbitration field as one number: the lower one wins. Identifier bits 28..18, RTR or SRR, IDE,
// identifier bits 17..0, RTR: so a data frame beats the remote frame and a standard frame the extended one of
// equal bits.
constexpr uint32_t arbitration_key(const Frame& frame) {
  const uint32_t remote = frame.remote ? 1U : 0U;
  if (!frame.extended) return (frame.id << 21) | (remote << 20);
  return ((frame.id >> 18) << 21) | (1U << 20) | (1U << 19) | ((frame.id & 0x3FFFF) << 1) | remote;
}

}  // namespace ipos::runtime
