// Link types, each with its reader.
#include "tools/logs/packets.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/log/log_name.hpp"
#include "tools/logs/writing/pcapng.hpp"

namespace ipos::tools {
namespace {

using pcapng::LinkType;

constexpr size_t kCanHead = 8;      // identifier, length, flags of FD, two bytes
constexpr size_t kClassicCan = 16;  // with all its data: the largest packet of a classic frame

std::optional<runtime::SerialError> serial_error(std::string_view text) {
  for (size_t n = 0; n < runtime::kSerialErrors; ++n)
    if (serial_error_text(static_cast<runtime::SerialError>(n)) == text)
      return static_cast<runtime::SerialError>(n);
  return std::nullopt;
}

class PacketReader {
 public:
  PacketReader(const Packet& packet, const LogReader& reader) : packet_(packet), reader_(reader) {}

  void read() {
    switch (static_cast<LinkType>(packet_.link)) {
      case LinkType::SocketCan:
        if (packet_.data.size() < kCanHead) return too_short("a CAN frame without head");
        return can(packet_.data, packet_.original, Bytes(packet_.data, true).u32(0));
      case LinkType::Cooked: return cooked(14, 16);
      case LinkType::Cooked2: return cooked(0, 20);
      case LinkType::User0Serial: return is_whole() ? serial() : reader_.left_out(LeftOut::CutPacket);
      case LinkType::User1Dp: return is_whole() ? dp() : reader_.left_out(LeftOut::CutPacket);
    }
    reader_.left_out(LeftOut::OtherPacket);
  }

 private:
  bool is_whole() const { return packet_.data.size() >= packet_.original; }
  // A packet of which too little is there.
  void too_short(const char* message) {
    if (is_whole())
      reader_.wrong({0, packet_.at}, message);
    else
      reader_.left_out(LeftOut::CutPacket);
  }

  // Of "any": the protocol tells whether it is CAN (LINKTYPE_LINUX_SLL, _SLL2). The identifier has the byte order of the
  // machine that captured, as Wireshark reads it, except from programs that write it as in a capture of one interface.
  void cooked(size_t protocol, size_t head) {
    const Bytes bytes(packet_.data, true);
    if (!bytes.has(0, head)) return too_short("a packet without its head");
    const uint16_t kind = bytes.u16(protocol);
    if (kind == pcapng::kProtocolCanFd || kind == pcapng::kProtocolCanXl)
      return reader_.left_out(LeftOut::FdFrame);
    if (kind != pcapng::kProtocolCan) return reader_.left_out(LeftOut::OtherPacket);
    const std::string_view data = packet_.data.substr(head);
    if (data.size() < kCanHead) return too_short("a CAN frame without head");
    const uint32_t host = Bytes(data, packet_.big_endian).u32(0), network = Bytes(data, true).u32(0);
    can(data, packet_.original - std::min(head, packet_.original),
        !is_classic(host) && is_classic(network) ? network : host);
  }

  // Whether it can be the identifier of a classic frame, with its flags.
  static bool is_classic(uint32_t word) {
    return (word & pcapng::kError) == 0 && is_valid(with_identifier(word));
  }
  static runtime::Frame with_identifier(uint32_t word) {
    return {word & ~(pcapng::kExtended | pcapng::kRemote),
            0,
            {},
            (word & pcapng::kExtended) != 0,
            (word & pcapng::kRemote) != 0};
  }

  void can(std::string_view data, size_t original, uint32_t word) {
    const Bytes bytes(data);
    if ((word & pcapng::kError) != 0) return reader_.left_out(LeftOut::ErrorFrame);
    runtime::Frame frame = with_identifier(word);
    frame.length = bytes.u8(4);
    // Older captures have no flag for FD; their packets are longer than one of a classic frame.
    if ((bytes.u8(5) & pcapng::kFdFlags) != 0 || frame.length > 8 || original > kClassicCan)
      return reader_.left_out(LeftOut::FdFrame);
    if (!is_valid(frame)) return reader_.wrong({0, packet_.at}, "no frame of classic CAN");
    if (!frame.remote && !bytes.has(kCanHead, frame.length))
      return too_short("a CAN frame without all its data");
    for (uint8_t n = 0; n < frame.length && !frame.remote; ++n) frame.data[n] = bytes.u8(kCanHead + n);
    reader_.can({packet_.time, packet_.bus, frame}, {0, packet_.at});
  }

  void serial() {
    if (packet_.data.size() > runtime::SerialBytes::kLongest)
      return reader_.wrong({0, packet_.at}, fmt::format("more than {} bytes, the longest telegram",
                                                        runtime::SerialBytes::kLongest));
    runtime::SerialEntry entry;
    entry.time = packet_.time;
    entry.line = packet_.bus;
    entry.reception.start = entry.reception.end = packet_.time;
    for (const char byte : packet_.data) entry.reception.bytes.push(static_cast<uint8_t>(byte));
    entry.reception.telegram = runtime::decode_serial(entry.reception.bytes.span());
    if (packet_.comment.starts_with(pcapng::kVoid))
      if (const auto error = serial_error(packet_.comment.substr(std::string_view(pcapng::kVoid).size())))
        entry.reception.telegram = tl::unexpected(*error);
    reader_.serial(entry, {0, packet_.at});
  }

  void dp() {
    profibus::Octets octets;
    for (const char byte : packet_.data) octets.push_back(static_cast<uint8_t>(byte));
    std::optional<profibus::FrameError> error;
    if (packet_.comment.starts_with(pcapng::kVoid))
      error = profibus::frame_error(packet_.comment.substr(std::string_view(pcapng::kVoid).size()));
    reader_.dp({packet_.bus, runtime::reception_of(std::move(octets), packet_.time, packet_.time, error)},
               {0, packet_.at});
  }

  const Packet& packet_;
  const LogReader& reader_;
};

}  // namespace

void read_packet(const Packet& packet, const LogReader& reader) { PacketReader(packet, reader).read(); }

std::string interface_name(std::string_view name, size_t number) {
  constexpr size_t kLongest = 64;  // of Linux: 15 letters (the bound is ours)
  if (name.empty()) return fmt::format("can{}", number);
  std::string made = runtime::log_name(std::string(name.substr(0, kLongest)));
  return name.size() <= kLongest ? made : fmt::format("{}~{}", made, number);
}

std::optional<runtime::Time> capture_time(uint64_t seconds, uint64_t nanoseconds) {
  constexpr uint64_t kLatest = 9'000'000'000;  // fits into nanoseconds of 64 bits
  if (seconds > kLatest) return std::nullopt;
  return static_cast<runtime::Time>(seconds) * runtime::kSecond + static_cast<runtime::Time>(nanoseconds) -
         runtime::kCandumpEpoch;
}

}  // namespace ipos::tools
