// Return codes of the parameter channel as data: error class, error code, additional code (1053 1610 p.
// 65-66).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace ipos::stdlib {

struct ReturnCode {
  uint8_t error_class = 0;
  uint8_t code = 0;
  uint16_t additional = 0;

  // As in bytes 4..7 of the telegram and in MOVLNK's Result.
  constexpr uint32_t packed() const {
    return (uint32_t{error_class} << 24) | (uint32_t{code} << 16) | uint32_t{additional};
  }
  static constexpr ReturnCode unpack(uint32_t packed) {
    return {static_cast<uint8_t>(packed >> 24), static_cast<uint8_t>(packed >> 16),
            static_cast<uint16_t>(packed)};
  }
  friend bool operator==(const ReturnCode&, const ReturnCode&) = default;
};

namespace return_codes {
#define RETURN_CODE(name, error_class, code, additional, meaning) \
  inline constexpr ReturnCode k##name{error_class, code, additional};
#include "stdlib/return_codes.def"
}  // namespace return_codes

struct ReturnCodeRow {
  ReturnCode code;
  std::string_view meaning;
};

std::span<const ReturnCodeRow> return_code_table();

// Empty for a code or class that no manual lists.
std::string_view return_code_meaning(ReturnCode code);
std::string_view return_class_meaning(uint8_t error_class);

}  // namespace ipos::stdlib
