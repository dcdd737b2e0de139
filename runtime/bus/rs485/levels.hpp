// What is on the wire: the transmissions of all stations, bit by bit, and the character a receiver makes of
// it. read_character() and next_start() are the one place where collisions, rates and faults become
// characters.
//
// Several senders at once: a 0 overrules a 1 (ours; real drivers fight, and the result is open). So a
// receiver sees the AND of all bits, with the parity and framing errors that follow.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/bus/line/node_id.hpp"
#include "runtime/bus/rs485/character.hpp"

namespace ipos::runtime {

struct Transmission {
  NodeId sender = kNoNode;
  Tick begin = 0;
  uint32_t bit_ticks = 1;
  std::vector<bool> bits;  // levels, one each bit time

  Tick end() const { return begin + bits.size() * bit_ticks; }
  bool covers(Tick tick) const { return tick >= begin && tick < end(); }
};

// Bits of characters that follow each other without a gap, in the memory of others that are over.
std::vector<bool> wire_bits(std::span<const uint8_t> bytes, std::vector<bool> memory = {});

// A receiver: its rate, the station whose own transmissions it does not hear (kNoNode: it hears all), and whether its A and B
// are interchanged.
struct Ear {
  uint32_t bit_ticks = 1;
  NodeId deaf_to = kNoNode;
  bool swapped = false;
};

// The level an ear sees in a tick; ticks after all transmissions are 1, for a swapped ear 0.
bool level_at(std::span<const Transmission> line, const Ear& ear, Tick tick);

// First tick in `from` .. `until` - 1 where the level falls: the begin of a start bit.
std::optional<Tick> next_start(std::span<const Transmission> line, const Ear& ear, Tick from, Tick until);

struct Reading {
  std::optional<Character> character;  // nothing: the start bit was only a spike
  Tick resume = 0;                     // the receiver looks for the next start bit from here on
};

// The character whose start bit begins at `start`, each bit taken in its middle. After its stop bit has been
// seen a receiver is ready for the next start bit.
Reading read_character(std::span<const Transmission> line, const Ear& ear, Tick start);

// Ticks from the start of a character to its end.
constexpr Tick character_ticks(const Ear& ear) { return Tick{kCharacterBits} * ear.bit_ticks; }

}  // namespace ipos::runtime
