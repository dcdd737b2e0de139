// Vector's binary form: a head, then containers of compressed objects, of which one may begin in a container and end in the
// next. Classic CAN messages are taken, also from the objects of CAN FD hardware, whose flags tell the kind of the frame; the
// other objects are left out.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "tools/logs/bytes.hpp"
#include "tools/logs/fields.hpp"
#include "tools/logs/log_forms.hpp"
#include "tools/packing/unpack.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr size_t kHead = 16;                             // of an object: signature, sizes, type
constexpr size_t kLargestContainer = size_t{64} << 20U;  // unpacked (ours); Vector's have 128 KiB
constexpr size_t kLargestObject = size_t{1} << 20U;      // a message has less than 200 bytes (ours)
constexpr uint32_t kMessage = 1, kError = 2, kContainer = 10, kErrorExt = 73, kMessage2 = 86,
                   kFdMessage = 100, kFdMessage64 = 101, kFdError64 = 104;
constexpr uint16_t kPlain = 0, kDeflated = 2;

// SYSTEMTIME: year, month, day of the week, day, hour, minute, second, millisecond; UTC is taken (ours).
std::optional<Time> system_time(const Bytes& head) {
  const auto word = [&](size_t n) { return head.u16(40 + 2 * n); };
  const std::chrono::year_month_day date(std::chrono::year(word(0)), std::chrono::month(word(1)),
                                         std::chrono::day(word(3)));
  if (!date.ok() || word(0) < 1970 || word(0) > 2150 || word(4) > 23 || word(5) > 59 || word(6) > 60 ||
      word(7) > 999)
    return std::nullopt;
  const int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + word(4)) * 60 + word(5)) * 60 * runtime::kSecond + word(6) * runtime::kSecond +
         word(7) * runtime::kMillisecond - runtime::kCandumpEpoch;
}

class BlfReader {
 public:
  BlfReader(std::string_view bytes, const LogReader& reader) : bytes_(bytes), reader_(reader) {}

  void read() {
    if (!bytes_.has(0, 72)) return wrong(0, "the file ends within its head");
    begin_ = system_time(bytes_).value_or(0);
    size_t at = bytes_.u32(4);
    if (at < 72) return wrong(4, "a head that is too short");
    while (at < bytes_.size()) {
      if (!find(bytes_, at)) {
        if (bytes_.size() - at < 4) break;  // filled up
        return wrong(at, "an object expected");
      }
      if (!bytes_.has(at, kHead)) return wrong(at, "the file ends within an object");
      const uint32_t size = bytes_.u32(at + 8);
      if (size < kHead) return wrong(at + 8, fmt::format("an object of {} bytes", size));
      if (!bytes_.has(at, size)) return wrong(at, "the file ends within an object");
      if (bytes_.u32(at + 12) == kContainer) {
        if (!container(at, size)) return;
      } else if (!object(bytes_.part(at, size), at)) {
        return;
      }
      at += size;
    }
    // Zeros fill up.
    if (rest_.find_first_not_of('\0') != std::string::npos)
      wrong(bytes_.size(), "the file ends within an object");
  }

 private:
  void wrong(size_t at, const std::string& message) { reader_.wrong({0, at}, message); }

  // Up to a few bytes fill the gap before an object.
  static bool find(const Bytes& bytes, size_t& at) {
    for (size_t n = 0; n < 8; ++n)
      if (bytes.has(at + n, 4) && bytes.text(at + n, 4) == "LOBJ") {
        at += n;
        return true;
      }
    return false;
  }

  bool container(size_t at, uint32_t size) {
    const size_t data = at + kHead + 16;
    if (size < kHead + 16) return wrong(at, "a container without head"), false;
    const uint16_t method = bytes_.u16(at + kHead);
    const uint32_t length = bytes_.u32(at + kHead + 8);
    const std::string_view packed = bytes_.text(data, at + size - data);
    if (length > kLargestContainer)
      return wrong(at + kHead + 8, fmt::format("a container of {} bytes", length)), false;
    if (method != kDeflated && method != kPlain)
      return wrong(at + kHead, fmt::format("packed by method {}, which is not known", method)), false;
    bool good = true;
    size_t given = 0;
    const auto take = [&](std::string_view piece) {
      rest_ += piece;
      given += piece.size();
      return given <= length && (good = objects(at));
    };
    if (method == kPlain) return take(packed), good;
    const Unpacked end = unpack(packed, Packing::Zlib, take);
    if (good && (end != Unpacked::Whole || given != length)) return wrong(data, "a container that cannot be unpacked"), false;
    return good;
  }

  // All that are complete; messages have the place of their container.
  bool objects(size_t place) {
    const Bytes inner(rest_);
    size_t at = 0;
    while (at < inner.size()) {
      size_t found = at;
      if (!find(inner, found)) {
        if (inner.size() - at < kHead) break;
        return wrong(place, "an object expected in this container"), false;
      }
      if (!inner.has(found, kHead)) break;
      const uint32_t size = inner.u32(found + 8);
      if (size < kHead || size > kLargestObject)
        return wrong(place, fmt::format("an object of {} bytes in this container", size)), false;
      if (!inner.has(found, size)) break;
      if (!object(inner.part(found, size), place)) return false;
      at = found + size;
    }
    rest_.erase(0, at);
    return true;
  }

  // Where the parts of a message stand after the head of its object, and which flag is that of a remote frame.
  struct Layout {
    size_t dlc, data;
    uint32_t remote;
  };

  bool object(const Bytes& bytes, size_t place) {
    const size_t head = bytes.u16(4);
    const auto is_there = [&](size_t size) { return head >= 32 && bytes.has(head, size); };
    switch (bytes.u32(12)) {
      case kMessage:
      case kMessage2:
        if (!is_there(8)) break;
        return message(bytes, place, {3, 8, 0x80}, bytes.u16(head), bytes.u8(head + 2));
      case kFdMessage:
        if (!is_there(20)) break;
        if ((bytes.u8(head + 13) & 1U) != 0) return leave_out(LeftOut::FdFrame);
        return message(bytes, place, {3, 20, 0x80}, bytes.u16(head), bytes.u8(head + 2));
      case kFdMessage64: {
        if (!is_there(40)) break;
        const uint32_t flags = bytes.u32(head + 12);
        if ((flags & 0x1000U) != 0) return leave_out(LeftOut::FdFrame);
        if ((flags & 0x80U) != 0) return leave_out(LeftOut::TransmitRequest);
        return message(bytes, place, {1, 40, 0x10}, bytes.u8(head), flags);
      }
      case kError:
      case kErrorExt:
      case kFdError64: return leave_out(LeftOut::ErrorFrame);
      default: return leave_out(LeftOut::Record);
    }
    return wrong(place, "a CAN message that is too short"), false;
  }

  bool leave_out(LeftOut what) {
    reader_.left_out(what);
    return true;
  }

  bool message(const Bytes& bytes, size_t place, const Layout& layout, unsigned channel, uint32_t flags) {
    const size_t head = bytes.u16(4);
    const uint64_t units = bytes.u64(24);
    const uint64_t unit = bytes.u32(16) == 1 ? 10'000 : 1;  // 10 us, or ns
    if (units > static_cast<uint64_t>(kLongestLog) / unit)
      return wrong(place, "a time later than this project knows"), false;
    runtime::Frame frame;
    const uint32_t id = bytes.u32(head + 4);
    frame.extended = (id & 0x8000'0000U) != 0;
    frame.id = id & 0x7FFF'FFFFU;
    frame.remote = (flags & layout.remote) != 0;
    const uint8_t dlc = bytes.u8(head + layout.dlc);
    frame.length = classic_length(dlc);
    if (dlc > kLargestDlc || !is_valid(frame))
      return wrong(place, "a CAN message that is none of classic CAN"), false;
    if (!frame.remote && !bytes.has(head + layout.data, frame.length))
      return wrong(place, "a CAN message without all its data"), false;
    for (uint8_t n = 0; n < frame.length && !frame.remote; ++n)
      frame.data[n] = bytes.u8(head + layout.data + n);
    reader_.can({begin_ + static_cast<Time>(units * unit), fmt::format("can{}", channel), frame}, {0, place});
    return true;
  }

  Bytes bytes_;
  const LogReader& reader_;
  Time begin_ = 0;
  std::string rest_;  // of the containers so far: an object that is not complete
};

}  // namespace

void read_blf(std::string_view bytes, const LogReader& reader) { BlfReader(bytes, reader).read(); }

}  // namespace ipos::tools
