// What the non-volatile memory of a unit holds, and its coding as the payload of a slot. Everything is named
// by its index of the parameter channel: parameters, IPOS variables (11000 + n), curve points (20000 + n).
// Layout: docs/inside/nv-memory.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace ipos::runtime {

// A program that was changed through indices 16000 + n.
struct NvProgram {
  uint32_t origin = 0;  // CRC-32 of the program it was changed from; it replaces only that one
  std::vector<uint32_t> words;
  bool operator==(const NvProgram&) const = default;
};

struct NvContent {
  std::vector<std::pair<uint16_t, int32_t>> values;   // by index, in rising order
  std::vector<std::pair<uint16_t, uint32_t>> writes;  // how often each was stored in the life of the unit
  std::optional<NvProgram> program;
  bool operator==(const NvContent&) const = default;
};

std::vector<uint8_t> encode(const NvContent& content);

// Nothing when the bytes are no payload. Each content has exactly one coding.
std::optional<NvContent> decode_content(std::span<const uint8_t> bytes);

}  // namespace ipos::runtime
