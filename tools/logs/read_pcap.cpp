// Reads classic pcap of either byte order, with times in microseconds or nanoseconds: a head, then packets of one interface.
#include <fmt/format.h>

#include "tools/logs/packets.hpp"

namespace ipos::tools {
namespace {

constexpr uint32_t kMicroseconds = 0xA1B2C3D4, kNanoseconds = 0xA1B23C4D;
constexpr size_t kFileHead = 24, kPacketHead = 16;

}  // namespace

void read_pcap(std::string_view bytes, const LogReader& reader) {
  const auto wrong = [&](size_t at, const char* message) { reader.wrong({0, at}, message); };
  if (bytes.size() < kFileHead) return wrong(0, "the file ends within its head");
  const uint32_t order = Bytes(bytes).u32(0);
  const bool big_endian = order != kMicroseconds && order != kNanoseconds;
  const Bytes all(bytes, big_endian);
  const bool nanoseconds = all.u32(0) == kNanoseconds;
  const uint32_t link = all.u32(20) & 0xFFFF;  // above: what Ethernet adds to its frames
  const std::string bus = interface_name({}, 0);
  size_t at = kFileHead;
  while (at < all.size()) {
    if (!all.has(at, kPacketHead)) return wrong(at, "the file ends within a packet");
    const uint64_t part = all.u32(at + 4);
    const uint32_t captured = all.u32(at + 8), original = all.u32(at + 12);
    const size_t data = at + kPacketHead;
    if (!all.has(data, captured)) return wrong(at, "the file ends within a packet");
    const auto time = capture_time(all.u32(at), nanoseconds ? part : part * runtime::kMicrosecond);
    if (!time) return wrong(at, "a time later than this project knows");
    read_packet({link, bus, *time, all.text(data, captured), original, {}, at, big_endian}, reader);
    at = data + captured;
  }
}

}  // namespace ipos::tools
