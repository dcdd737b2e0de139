// Numbers in the blocks of a `.ipos-trace`: seven bits a byte, the lowest first, the highest bit set where more follow (as
// LEB128); numbers with a sign are turned so that small ones stay small (0, -1, 1, -2 are 0, 1, 2, 3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace ipos::tools {

inline constexpr size_t kMostNumberBytes = 10;

constexpr uint64_t folded(uint64_t value) { return value << 1 ^ (value >> 63 != 0 ? ~uint64_t{0} : 0); }
constexpr uint64_t unfolded(uint64_t value) { return value >> 1 ^ ((value & 1) != 0 ? ~uint64_t{0} : 0); }

// Where it ends; there must be room for kMostNumberBytes.
inline char* put_number(char* at, uint64_t value) {
  for (; value >= 0x80; value >>= 7) *at++ = static_cast<char>(value | 0x80);
  *at++ = static_cast<char>(value);
  return at;
}
inline void add_number(std::string& out, uint64_t value) {
  char bytes[kMostNumberBytes];
  out.append(bytes, put_number(bytes, value));
}

// Reads what is there; behind the end, and where a number is longer than 64 bits, all that follows is 0 and good() is false.
class NumberReader {
 public:
  explicit NumberReader(std::string_view bytes) : bytes_(bytes) {}

  uint64_t number() {
    uint64_t value = 0;
    for (unsigned shift = 0; at_ < bytes_.size() && shift < 64; shift += 7) {
      const auto byte = static_cast<uint8_t>(bytes_[at_++]);
      if (shift == 63 && byte > 1) break;
      value |= uint64_t{byte & 0x7FU} << shift;
      if (byte < 0x80) return value;
    }
    return fail();
  }
  uint8_t byte() { return at_ < bytes_.size() ? static_cast<uint8_t>(bytes_[at_++]) : static_cast<uint8_t>(fail()); }
  // As many bytes as the number before them says.
  std::string_view text() {
    const uint64_t length = number();
    if (length > bytes_.size() - at_) fail();
    const std::string_view text = bytes_.substr(at_, static_cast<size_t>(good_ ? length : 0));
    at_ += text.size();
    return text;
  }
  bool good() const { return good_; }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  uint64_t fail() {
    good_ = false;
    at_ = bytes_.size();
    return 0;
  }
  std::string_view bytes_;
  size_t at_ = 0;
  bool good_ = true;
};

}  // namespace ipos::tools
