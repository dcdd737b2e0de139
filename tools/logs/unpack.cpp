// zlib, and logs packed with gzip, as python-can and logrotate write them.
#include "tools/logs/unpack.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>

#include "tools/cli/files.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

class Inflate {
 public:
  explicit Inflate(Packing packing) {
    constexpr int kGzip = 16;
    ready_ = inflateInit2(&stream_, MAX_WBITS + (packing == Packing::Gzip ? kGzip : 0)) == Z_OK;
  }
  ~Inflate() { inflateEnd(&stream_); }
  Inflate(const Inflate&) = delete;
  Inflate& operator=(const Inflate&) = delete;
  bool ready() const { return ready_; }
  z_stream& stream() { return stream_; }

 private:
  z_stream stream_{};
  bool ready_ = false;
};

}  // namespace

Unpacked unpack(std::string_view packed, Packing packing, const std::function<bool(std::string_view)>& take) {
  Inflate unpacking(packing);
  if (!unpacking.ready()) return Unpacked::Damaged;
  z_stream& stream = unpacking.stream();
  // zlib does not write to its input; a log is at most kLogLimit long.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::array<char, 65536> piece{};
  for (;;) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    const size_t size = piece.size() - stream.avail_out;
    if (size != 0 && !take(std::string_view(piece.data(), size))) return Unpacked::Whole;
    // gzip files may be joined.
    if (status == Z_STREAM_END && packing == Packing::Gzip && stream.avail_in != 0 &&
        inflateReset(&stream) == Z_OK)
      continue;
    if (status == Z_STREAM_END) return Unpacked::Whole;
    if (status != Z_OK) return status == Z_BUF_ERROR ? Unpacked::EndsEarly : Unpacked::Damaged;
  }
}

tl::expected<UnpackedLog, std::string> unpacked_log(std::string_view packed) {
  // Logs become 5 to 20 times smaller; a short one may be all the same (ours).
  constexpr size_t kMostTimes = 32, kAlwaysGood = size_t{1} << 20U;
  const size_t limit = std::min(std::max(packed.size() * kMostTimes, kAlwaysGood), kLogLimit);
  UnpackedLog log;
  std::string& out = log.bytes;
  const Unpacked end = unpack(packed, Packing::Gzip, [&](std::string_view piece) {
    out += piece;
    return out.size() <= limit;
  });
  if (out.size() > limit)
    return tl::unexpected(fmt::format("unpacks to more than {} bytes, which no log does", limit));
  if (end == Unpacked::Damaged) return tl::unexpected(std::string("packed with gzip, and damaged"));
  log.whole = end == Unpacked::Whole;
  // Half a line may look like a whole one.
  const LogForm form = log_form(out);
  if (!log.whole && (form == LogForm::Lines || form == LogForm::Asc || form == LogForm::Trc))
    out.resize(out.rfind('\n') + 1);  // to nothing where there is no line
  return log;
}

}  // namespace ipos::tools
