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

bool unpack(std::string_view packed, Packing packing, const std::function<bool(std::string_view)>& take) {
  Inflate unpacking(packing);
  if (!unpacking.ready()) return false;
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
    if (size != 0 && !take(std::string_view(piece.data(), size))) return true;
    // gzip files may be joined.
    if (status == Z_STREAM_END && packing == Packing::Gzip && stream.avail_in != 0 &&
        inflateReset(&stream) == Z_OK)
      continue;
    if (status == Z_STREAM_END) return true;
    if (status != Z_OK) return false;  // also where the bytes end too early: Z_BUF_ERROR
  }
}

tl::expected<std::string, std::string> unpacked_log(std::string_view packed) {
  // Logs become 5 to 20 times smaller; a short one may be all the same (ours).
  constexpr size_t kMostTimes = 32, kAlwaysGood = size_t{1} << 20U;
  const size_t limit = std::min(std::max(packed.size() * kMostTimes, kAlwaysGood), kLogLimit);
  std::string out;
  const bool good = unpack(packed, Packing::Gzip, [&](std::string_view piece) {
    out += piece;
    return out.size() <= limit;
  });
  if (out.size() > limit)
    return tl::unexpected(fmt::format("unpacks to more than {} bytes, which no log does", limit));
  if (!good) return tl::unexpected(std::string("the packed file is damaged or ends too early"));
  return out;
}

}  // namespace ipos::tools
