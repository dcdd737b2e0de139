// Process data words in words and units.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

struct ProcessWordScale {
  bool input;
  uint8_t code;
  bool is_signed;
  int32_t numerator;
  int32_t denominator;  // 0: hexadecimal
  std::string_view unit;
};

// P870..P872 or P873..P875 of a unit.
using WordAssignment = std::array<uint8_t, 3>;

// The scale of an assignment; a plain number with sign for codes without one.
ProcessWordScale process_word_scale(bool input, uint8_t code);

// "SPEED", by the unit's own list or, where it has none, that of MOVIDRIVE; empty for a code that is not in it.
std::string_view process_word_name(const stdlib::UnitType& unit, bool input, uint8_t code);

// "1000.0 rpm", "0006h", "25.00 %"
std::string process_word_text(bool input, uint8_t code, uint16_t word);

}  // namespace ipos::runtime
