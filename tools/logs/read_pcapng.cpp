// Reads pcapng of either byte order, also such as Wireshark has captured: blocks and options that say nothing
// about frames are passed over, and so are error frames.
#include "tools/logs/pcapng.hpp"

#include <fmt/format.h>

#include "runtime/bus/log/log_name.hpp"
#include "tools/logs/bytes.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

using pcapng::LinkType;
using runtime::Time;

struct Interface {
  uint16_t link = 0;
  std::string name;
  uint64_t units = 1'000'000;  // of the time in a second
};

std::optional<runtime::SerialError> serial_error(std::string_view text) {
  for (size_t n = 0; n < runtime::kSerialErrors; ++n)
    if (serial_error_text(static_cast<runtime::SerialError>(n)) == text)
      return static_cast<runtime::SerialError>(n);
  return std::nullopt;
}

class PcapngReader {
 public:
  PcapngReader(std::string_view bytes, const LogReader& reader) : text_(bytes), reader_(reader) {}

  void read() {
    while (at_ < text_.size())
      if (!block()) return;
  }

 private:
  bool wrong(size_t at, const std::string& message) {
    reader_.wrong({0, at}, message);
    return false;
  }

  bool block() {
    const auto size_of_rest = text_.size() - at_;
    if (size_of_rest < 12) return wrong(at_, "the file ends within a block");
    if (Bytes(text_).u32(at_) == pcapng::kSection && !section()) return false;
    const Bytes all(text_, big_endian_);
    const uint32_t type = all.u32(at_);
    const uint32_t size = all.u32(at_ + 4);
    if (size < 12 || size % 4 != 0) return wrong(at_ + 4, fmt::format("a block of {} bytes", size));
    if (size > size_of_rest) return wrong(at_, "the file ends within a block");
    if (all.u32(at_ + size - 4) != size) return wrong(at_ + size - 4, "the two sizes of the block differ");
    const Bytes body = all.part(at_ + 8, size - 12);
    const bool good = type == pcapng::kInterface      ? interface(body)
                      : type == pcapng::kPacket       ? packet(body)
                      : type == pcapng::kSimplePacket ? wrong(at_, "a packet without time")
                                                      : true;
    at_ += size;
    return good;
  }

  bool section() {
    const uint32_t order = Bytes(text_).u32(at_ + 8);
    big_endian_ = order != pcapng::kByteOrder;
    if (big_endian_ && Bytes(text_, true).u32(at_ + 8) != pcapng::kByteOrder)
      return wrong(at_ + 8, "no byte order of pcapng");
    interfaces_.clear();
    return true;
  }

  // False where the options are damaged, with the error told.
  template <typename Take>
  bool options(const Bytes& body, size_t from, Take take) {
    while (body.has(from, 4)) {
      const uint16_t code = body.u16(from), length = body.u16(from + 2);
      if (code == pcapng::kEndOfOptions) return true;
      if (!body.has(from + 4, length)) return wrong(at_ + 8 + from, "an option is longer than its block");
      take(code, body.part(from + 4, length));
      from += 4 + (size_t{length} + 3) / 4 * 4;
    }
    return true;
  }

  bool interface(const Bytes& body) {
    if (body.size() < 8) return wrong(at_, "an interface without link type");
    Interface made;
    made.link = body.u16(0);
    made.name = fmt::format("can{}", interfaces_.size());
    bool good = true;
    if (!options(body, 8, [&](uint16_t code, const Bytes& value) {
          if (code == pcapng::kName && value.size() != 0) made.name = value.text(0, value.size());
          if (code != pcapng::kResolution || value.size() != 1) return;
          const unsigned power = value.u8(0) & 0x7F;
          const bool binary = (value.u8(0) & 0x80) != 0;
          good = binary ? power <= 32 : power <= 9;  // to the nanosecond
          made.units = 1;
          for (unsigned n = 0; good && n < power; ++n) made.units *= binary ? 2 : 10;
        }))
      return false;
    if (!good) return wrong(at_, "times finer than a nanosecond");
    made.name = runtime::log_name(std::move(made.name));
    interfaces_.push_back(std::move(made));
    return true;
  }

  bool packet(const Bytes& body) {
    if (body.size() < 20) return wrong(at_, "a packet without head");
    const uint32_t number = body.u32(0);
    if (number >= interfaces_.size()) return wrong(at_ + 8, fmt::format("there is no interface {}", number));
    const Interface& on = interfaces_[number];
    const uint64_t stamp = uint64_t{body.u32(4)} << 32 | body.u32(8);
    const uint64_t seconds = stamp / on.units;
    if (seconds > 9'000'000'000) return wrong(at_ + 12, "a time later than this project knows");
    const Time time =
        static_cast<Time>(seconds) * runtime::kSecond +
        static_cast<Time>(stamp % on.units * static_cast<uint64_t>(runtime::kSecond) / on.units) -
        runtime::kCandumpEpoch;
    const uint32_t captured = body.u32(12);
    if (!body.has(20, captured)) return wrong(at_ + 20, "a packet longer than its block");
    const Bytes data = Bytes(text_, true).part(at_ + 28, captured);
    std::string comment;
    if (!options(body, 20 + (size_t{captured} + 3) / 4 * 4, [&](uint16_t code, const Bytes& value) {
          if (code == pcapng::kComment) comment = value.text(0, value.size());
        }))
      return false;
    switch (static_cast<LinkType>(on.link)) {
      case LinkType::SocketCan: return can(on, time, data);
      case LinkType::User0Serial: return serial(on, time, data, comment);
      case LinkType::User1Dp: return dp(on, time, data, comment);
    }
    return wrong(at_, fmt::format("link type {} is no CAN of SocketCAN, RS-485 or PROFIBUS", on.link));
  }

  bool can(const Interface& on, Time time, const Bytes& data) {
    if (data.size() < 8) return wrong(at_ + 28, "a CAN frame without head");
    const uint32_t word = data.u32(0);
    if ((word & pcapng::kError) != 0) return true;
    runtime::Frame frame;
    frame.extended = (word & pcapng::kExtended) != 0;
    frame.remote = (word & pcapng::kRemote) != 0;
    frame.id = word & ~(pcapng::kExtended | pcapng::kRemote);
    frame.length = data.u8(4);
    if (!is_valid(frame)) return wrong(at_ + 28, "no frame of classic CAN");
    if (!frame.remote && !data.has(8, frame.length))
      return wrong(at_ + 28, "a CAN frame without all its data");
    for (uint8_t n = 0; n < frame.length && !frame.remote; ++n) frame.data[n] = data.u8(8U + n);
    reader_.can({time, on.name, frame}, {0, at_});
    return true;
  }

  bool serial(const Interface& on, Time time, const Bytes& data, std::string_view comment) {
    if (data.size() > runtime::SerialBytes::kLongest)
      return wrong(at_ + 28,
                   fmt::format("more than {} bytes, the longest telegram", runtime::SerialBytes::kLongest));
    runtime::SerialEntry entry;
    entry.time = time;
    entry.line = on.name;
    entry.reception.start = entry.reception.end = time;
    for (size_t n = 0; n < data.size(); ++n) entry.reception.bytes.push(data.u8(n));
    entry.reception.telegram = runtime::decode_serial(entry.reception.bytes.span());
    if (comment.starts_with(pcapng::kVoid))
      if (const auto error = serial_error(comment.substr(std::string_view(pcapng::kVoid).size())))
        entry.reception.telegram = tl::unexpected(*error);
    reader_.serial(entry, {0, at_});
    return true;
  }

  bool dp(const Interface& on, Time time, const Bytes& data, std::string_view comment) {
    profibus::Octets octets;
    for (size_t n = 0; n < data.size(); ++n) octets.push_back(data.u8(n));
    std::optional<profibus::FrameError> error;
    if (comment.starts_with(pcapng::kVoid))
      error = profibus::frame_error(comment.substr(std::string_view(pcapng::kVoid).size()));
    reader_.dp({on.name, runtime::reception_of(std::move(octets), time, time, error)}, {0, at_});
    return true;
  }

  std::string_view text_;
  const LogReader& reader_;
  size_t at_ = 0;
  bool big_endian_ = false;
  std::vector<Interface> interfaces_;
};

}  // namespace

void read_pcapng(std::string_view bytes, const LogReader& reader) { PcapngReader(bytes, reader).read(); }

}  // namespace ipos::tools
