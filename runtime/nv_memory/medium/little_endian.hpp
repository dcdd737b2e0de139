// Numbers in the memory file, least significant byte first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ipos::runtime {

inline void put(std::vector<uint8_t>& out, uint32_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<uint8_t>(number >> (8 * i)));
}

// Reads one number after the other; after the end `good` is false and numbers are 0.
struct LittleEndianReader {
  std::span<const uint8_t> rest;
  bool good = true;

  uint32_t take(size_t bytes) {
    if (rest.size() < bytes) {
      good = false;
      return 0;
    }
    uint32_t number = 0;
    int shift = 0;
    for (const uint8_t byte : rest.first(bytes)) {
      number |= uint32_t{byte} << shift;
      shift += 8;
    }
    rest = rest.subspan(bytes);
    return number;
  }
};

}  // namespace ipos::runtime
