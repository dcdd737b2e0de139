// Numbers in the bytes of a binary log, read only where they are all there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ipos::tools {

class Bytes {
 public:
  explicit Bytes(std::string_view bytes, bool big_endian = false) : bytes_(bytes), big_endian_(big_endian) {}

  size_t size() const { return bytes_.size(); }
  bool has(size_t at, size_t count) const { return at <= size() && count <= size() - at; }
  Bytes part(size_t at, size_t count) const { return Bytes(bytes_.substr(at, count), big_endian_); }
  std::string_view text(size_t at, size_t count) const { return bytes_.substr(at, count); }

  // The caller has asked has().
  uint8_t u8(size_t at) const { return static_cast<uint8_t>(bytes_[at]); }
  uint16_t u16(size_t at) const { return static_cast<uint16_t>(number(at, 2)); }
  uint32_t u32(size_t at) const { return static_cast<uint32_t>(number(at, 4)); }
  uint64_t u64(size_t at) const { return number(at, 8); }

 private:
  uint64_t number(size_t at, size_t count) const {
    uint64_t value = 0;
    for (size_t n = 0; n < count; ++n) value = value << 8 | u8(at + (big_endian_ ? n : count - 1 - n));
    return value;
  }

  std::string_view bytes_;
  bool big_endian_;
};

}  // namespace ipos::tools
