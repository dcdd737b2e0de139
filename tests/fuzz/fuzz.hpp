// What all fuzz targets share: the entry that libFuzzer or the replay program calls, the way to report a
// broken promise, and a reader that makes numbers of the input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace ipos::tests {

// Ends the program with `promise` on stderr; a fuzzer counts that as a crash.
[[noreturn]] void broken(const char* promise);
inline void require(bool kept, const char* promise) {
  if (!kept) broken(promise);
}

inline std::string_view text_of(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Room for events of a queue: it grows, but making a large one is a tenth of the time of a run.
inline constexpr size_t kEvents = 30;

// Behind the end all numbers are 0.
class Input {
 public:
  Input(const uint8_t* data, size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }
  size_t left() const { return left_; }

  // The next `size` bytes, or what is left of them, as an input of their own.
  Input part(size_t size) {
    const Input out(data_, size < left_ ? size : left_);
    data_ += out.left_;
    left_ -= out.left_;
    return out;
  }
  const uint8_t* rest() const { return data_; }

  uint8_t u8() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  uint16_t u16() {
    const uint8_t low = u8();
    return static_cast<uint16_t>(low | u8() << 8);
  }
  uint32_t u32() {
    const uint32_t low = u16();
    return low | static_cast<uint32_t>(u16()) << 16;
  }
  int32_t i32() { return static_cast<int32_t>(u32()); }
  uint32_t below(uint32_t limit) { return u16() % limit; }

 private:
  const uint8_t* data_;
  size_t left_;
};

}  // namespace ipos::tests
