// A character of 11 bits: start bit 0, eight data bits from the least significant up, a parity bit that makes
// the number of ones even, stop bit 1 (1053 1610 p. 26). The line rests at 1.
#pragma once

#include <bit>
#include <cstdint>

#include "runtime/bus/rs485/timing.hpp"

namespace ipos::runtime {

// A character as a receiver hands it over, at `end`. A real port without exact times gives the moment of
// arrival.
struct Character {
  Time start = 0;  // of the start bit
  Time end = 0;    // of the stop bit
  uint8_t data = 0;
  bool parity_error = false;
  bool framing_error = false;  // stop bit 0

  friend bool operator==(const Character&, const Character&) = default;
};

constexpr bool parity_bit(uint8_t data) { return std::popcount(data) % 2 == 1; }

// The 11 bits in order of sending, bit 0 of the number first.
constexpr uint16_t wire_character(uint8_t data) {
  return static_cast<uint16_t>(data << 1 | (parity_bit(data) ? 1 << 9 : 0) | 1 << 10);
}

// Data and errors of 11 received bits; start and end are left to the caller.
constexpr Character read_wire(uint16_t bits) {
  Character character;
  character.data = static_cast<uint8_t>(bits >> 1 & 0xFF);
  character.parity_error = (bits >> 9 & 1) != (parity_bit(character.data) ? 1 : 0);
  character.framing_error = (bits >> 10 & 1) == 0;
  return character;
}

}  // namespace ipos::runtime
