// Control and status words in words, as a bus monitor shows them (MOVITRAC 07 chapter 9.1).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

// "enable, reset". `number` is 1 or 2. Bits that are 1 though they are reserved are named as such.
std::string control_word_text(const stdlib::UnitType& unit, int number, uint16_t word);

// "ready, output stage on, PO data on; state 4 enable", "fault; F47 SBus timeout". `number` is 1, 2 or 3; the
// high byte is explained for the words that have a printed one.
std::string status_word_text(const stdlib::UnitType& unit, int number, uint16_t word);

// The text of a process data word whose assignment is a control or status word; empty for all others.
std::string unit_word_text(const stdlib::UnitType& unit, bool input, uint8_t code, uint16_t word);

// A bit of such a word that has a meaning of its own; `off` and `on` where both levels have a name.
struct WordBit {
  unsigned bit;
  std::string text;
  std::string off{}, on{};
};
// Empty for all other words.
std::vector<WordBit> unit_word_bits(const stdlib::UnitType& unit, bool input, uint8_t code);

// What the high byte of status word 1 says while there is no fault; empty for all other words.
std::vector<std::pair<int, std::string>> unit_state_texts(uint8_t code);

}  // namespace ipos::runtime
