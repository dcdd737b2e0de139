// By zlib.
#include "tools/packing/pack.hpp"

#include <zlib.h>

#include <limits>

namespace ipos::tools {

struct Packer::Stream {
  // The columns of a trace are small numbers with short repetitions, which level 1 finds at a third of the price of level 6.
  Stream() { ready = deflateInit(&zlib, Z_BEST_SPEED) == Z_OK; }
  ~Stream() { deflateEnd(&zlib); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  z_stream zlib{};
  bool ready = false;
};

Packer::Packer() : stream_(std::make_unique<Stream>()) {}
Packer::~Packer() = default;

std::string_view Packer::pack(std::string_view bytes) {
  z_stream& zlib = stream_->zlib;
  if (!stream_->ready || bytes.empty() || bytes.size() > std::numeric_limits<uInt>::max() || deflateReset(&zlib) != Z_OK) return {};
  if (packed_.size() < bytes.size()) packed_.resize(bytes.size());
  // zlib does not write to its input.
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  zlib.avail_in = static_cast<uInt>(bytes.size());
  zlib.next_out = reinterpret_cast<Bytef*>(packed_.data());
  zlib.avail_out = static_cast<uInt>(bytes.size() - 1);
  if (deflate(&zlib, Z_FINISH) != Z_STREAM_END) return {};
  return std::string_view(packed_).substr(0, zlib.total_out);
}

}  // namespace ipos::tools
