// The value of a number as written: decimal (leading zeros too, IPOSplus p. 190), 0x or 0b.
#pragma once

#include <cstdint>
#include <string_view>

namespace ipos::compiler {

enum class NumberForm : uint8_t { Good, Bad, Fraction, TooLarge };

struct ParsedNumber {
  NumberForm form = NumberForm::Bad;
  uint32_t value = 0;    // of the 32 bits; 0xFFFFFFFF reads as -1
  bool pattern = false;  // written as hexadecimal or binary
};

// Value of a digit, or a number no base has.
uint32_t digit_value(char c);

// A decimal number may be up to 2147483647, or one more after a minus sign.
ParsedNumber parse_number(std::string_view text, bool behind_minus);

}  // namespace ipos::compiler
