// Debian has no zlib for browsers: what is packed cannot be read there, and what is written stays as it is.
#include "tools/packing/pack.hpp"
#include "tools/packing/unpack.hpp"

namespace ipos::tools {

bool has_zlib() { return false; }

Unpacked unpack(std::string_view, Packing, const std::function<bool(std::string_view)>&) { return Unpacked::Damaged; }

struct Packer::Stream {};
Packer::Packer() = default;
Packer::~Packer() = default;
std::string_view Packer::pack(std::string_view) { return {}; }

}  // namespace ipos::tools
