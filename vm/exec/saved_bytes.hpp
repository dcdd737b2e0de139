// Numbers as little endian bytes, in three directions with one description of what is saved: counting,
// writing, reading. A function that visits the members of a structure serves all three.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace ipos::vm {

class ByteCounter {
 public:
  template <class T>
  constexpr void operator()(const T&) {
    size_ += sizeof(T);
  }
  constexpr size_t size() const { return size_; }

 private:
  size_t size_ = 0;
};

class ByteWriter {
 public:
  explicit ByteWriter(uint8_t* at) : at_(at) {}
  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_integral_v<T> || std::is_enum_v<T>);
    auto rest = static_cast<uint64_t>(value);
    uint8_t bytes[sizeof(T)];
    for (size_t n = 0; n < sizeof(T); ++n, rest >>= 8) bytes[n] = static_cast<uint8_t>(rest);
    std::memcpy(at_, bytes, sizeof(T));  // one store
    at_ += sizeof(T);
  }
  uint8_t* at() const { return at_; }

 private:
  uint8_t* at_;
};

// The caller knows that there are enough bytes. A bool that is not 0 or 1 and an enum beyond its values come
// out as they are, ok() is false for such a bool.
class ByteReader {
 public:
  explicit ByteReader(const uint8_t* at) : at_(at) {}
  template <class T>
  void operator()(T& value) {
    uint8_t bytes[sizeof(T)];
    std::memcpy(bytes, at_, sizeof(T));  // one load
    at_ += sizeof(T);
    uint64_t all = 0;
    for (size_t n = 0; n < sizeof(T); ++n) all |= uint64_t{bytes[n]} << (8 * n);
    if constexpr (std::is_same_v<T, bool>) {
      ok_ = ok_ && all <= 1;
      value = (all & 1) != 0;
    } else {
      value = static_cast<T>(all);
    }
  }
  const uint8_t* at() const { return at_; }
  bool ok() const { return ok_; }

 private:
  const uint8_t* at_;
  bool ok_ = true;
};

}  // namespace ipos::vm
