// pcapng, the form of Wireshark (draft-ietf-opsawg-pcapng): an interface a bus, times in nanoseconds. CAN has
// the link type of SocketCAN, which Wireshark takes apart. Telegrams of RS-485 and frames of PROFIBUS are
// their plain bytes under link types for private use; the dissector of this project (docs/guide/bus-tools.md)
// knows them. What was no telegram carries the reason as a comment.
#pragma once

#include <cstdint>

namespace ipos::tools::pcapng {

// Cooked: of a capture of all interfaces, with a head that says what a packet is.
enum class LinkType : uint32_t {
  Cooked = 113,
  User0Serial = 147,
  User1Dp = 148,
  SocketCan = 227,
  Cooked2 = 276
};

inline constexpr uint32_t kSection = 0x0A0D0D0A, kByteOrder = 0x1A2B3C4D;
inline constexpr uint32_t kInterface = 1, kOldPacket = 2, kSimplePacket = 3, kPacket = 6;
inline constexpr uint16_t kEndOfOptions = 0, kComment = 1, kName = 2, kResolution = 9, kTimeOffset = 14;
inline constexpr uint32_t kExtended = 1U << 31, kRemote = 1U << 30, kError = 1U << 29;
inline constexpr uint8_t kFdFlags = 0x07;  // bit rate switch, error state, FD format
inline constexpr uint16_t kProtocolCan = 0x0C, kProtocolCanFd = 0x0D, kProtocolCanXl = 0x0E;
inline constexpr const char* kVoid = "void: ";

}  // namespace ipos::tools::pcapng
