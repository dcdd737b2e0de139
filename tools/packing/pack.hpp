// Packs pieces of bytes one after the other as zlib streams (RFC 1950), quickly rather than small: what a run writes while it
// runs. Where the build has no zlib nothing is packed.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace ipos::tools {

class Packer {
 public:
  Packer();
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  // The stream of the piece, valid until the next one; empty where packing makes it no smaller.
  std::string_view pack(std::string_view bytes);

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
  std::string packed_;
};

}  // namespace ipos::tools
