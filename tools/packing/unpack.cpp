// By zlib.
#include "tools/packing/unpack.hpp"

#include <zlib.h>

#include <array>

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

bool has_zlib() { return true; }

Unpacked unpack(std::string_view packed, Packing packing, const std::function<bool(std::string_view)>& take) {
  Inflate unpacking(packing);
  if (!unpacking.ready()) return Unpacked::Damaged;
  z_stream& stream = unpacking.stream();
  // zlib does not write to its input; files are at most kLogLimit long.
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

}  // namespace ipos::tools
