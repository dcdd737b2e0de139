// Control and status words in words, as a bus monitor shows them (MOVITRAC 07 chapter 9.1).
#pragma once

#include <cstdint>
#include <string>

#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

// "enable, reset". `number` is 1 or 2. Bits that are 1 though they are reserved are named as such.
std::string control_word_text(const stdlib::UnitType& unit, int number, uint16_t word);

// "ready, output stage on, PO data on; state 4 enable", "fault; F47 SBus timeout". `number` is 1, 2 or 3; the
// high byte is explained for the words that have a printed one.
std::string status_word_text(const stdlib::UnitType& unit, int number, uint16_t word);

// The text of a process data word whose assignment is a control or status word; empty for all others.
std::string unit_word_text(const stdlib::UnitType& unit, bool input, uint8_t code, uint16_t word);

}  // namespace ipos::runtime
