// Reads pcapng of either byte order, also such as Wireshark has captured: sections, interfaces with the unit of their times,
// packets. Blocks and options that say nothing about frames are passed over.
#include "tools/logs/writing/pcapng.hpp"

#include <fmt/format.h>

#include "runtime/bus/log/unique_names.hpp"
#include "tools/logs/packets.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

__extension__ using Wide = unsigned __int128;

constexpr uint64_t kBillion = 1'000'000'000;

struct Interface {
  uint16_t link = 0;
  std::string name;
  // Of its times: parts of a second, as a power of ten or of two, and what is to be added.
  unsigned power = 6;
  bool binary = false;
  int64_t offset = 0;  // s
};

// The nanoseconds of a stamp; parts beyond them are cut off.
Wide nanoseconds_of(uint64_t stamp, const Interface& on) {
  constexpr unsigned kNano = 9, kNothingLeft = 64;
  Wide time = stamp;
  if (on.binary) return on.power >= 2 * kNothingLeft ? 0 : time * kBillion >> on.power;
  for (unsigned n = on.power; n < kNano; ++n) time *= 10;
  for (unsigned n = on.power; n > kNano && time != 0; --n) time /= 10;
  return time;
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
                      : type == pcapng::kPacket       ? packet(body, false)
                      : type == pcapng::kOldPacket    ? packet(body, true)
                      : type == pcapng::kSimplePacket ? untimed()
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
    std::string_view name;
    if (!options(body, 8, [&](uint16_t code, const Bytes& value) {
          if (code == pcapng::kName) name = value.text(0, value.size());
          if (code == pcapng::kTimeOffset && value.size() == 8)
            made.offset = static_cast<int64_t>(value.u64(0));
          if (code != pcapng::kResolution || value.size() != 1) return;
          made.power = value.u8(0) & 0x7FU;
          made.binary = (value.u8(0) & 0x80U) != 0;
        }))
      return false;
    const std::string word = interface_name(name, interfaces_.size());
    made.name = names_.of(name.empty() ? word : std::string(name), word);
    interfaces_.push_back(std::move(made));
    return true;
  }

  bool untimed() {
    reader_.left_out(LeftOut::UntimedPacket);
    return true;
  }

  // The old kind of block has a number of 16 bits, and how many packets were lost before it.
  bool packet(const Bytes& body, bool old) {
    if (body.size() < 20) return wrong(at_, "a packet without head");
    const uint32_t number = old ? body.u16(0) : body.u32(0);
    if (number >= interfaces_.size()) return wrong(at_ + 8, fmt::format("there is no interface {}", number));
    const Interface& on = interfaces_[number];
    const uint32_t captured = body.u32(12), original = body.u32(16);
    if (!body.has(20, captured)) return wrong(at_ + 20, "a packet longer than its block");
    const auto time = time_of(uint64_t{body.u32(4)} << 32 | body.u32(8), on);
    if (!time) return wrong(at_ + 12, "a time later than this project knows");
    std::string_view comment;
    if (!options(body, 20 + (size_t{captured} + 3) / 4 * 4, [&](uint16_t code, const Bytes& value) {
          if (code == pcapng::kComment) comment = value.text(0, value.size());
        }))
      return false;
    read_packet({on.link, on.name, *time, body.text(20, captured), original, comment, at_, big_endian_},
                reader_);
    return true;
  }

  static std::optional<Time> time_of(uint64_t stamp, const Interface& on) {
    const Wide nanoseconds = nanoseconds_of(stamp, on);
    constexpr int64_t kLatest = 100'000'000'000;  // s; capture_time() wants less
    if (nanoseconds / kBillion > kLatest || on.offset > kLatest) return std::nullopt;
    const auto seconds = static_cast<int64_t>(nanoseconds / kBillion);
    if (seconds + on.offset < 0) return std::nullopt;
    return capture_time(static_cast<uint64_t>(seconds + on.offset),
                        static_cast<uint64_t>(nanoseconds % kBillion));
  }

  std::string_view text_;
  const LogReader& reader_;
  size_t at_ = 0;
  bool big_endian_ = false;
  std::vector<Interface> interfaces_;
  runtime::UniqueNames names_{std::string::npos};  // two names that become one word stay two lines
};

}  // namespace

void read_pcapng(std::string_view bytes, const LogReader& reader) { PcapngReader(bytes, reader).read(); }

}  // namespace ipos::tools
