// The receiver of a UART (1053 1610 p. 26), on recorded levels.
#include "runtime/bus/rs485/levels.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace ipos::runtime {
namespace {

// The first tick after `tick` that may have another level: a bit or a transmission begins or ends there.
Tick next_edge(std::span<const Transmission> line, Tick tick) {
  Tick next = std::numeric_limits<Tick>::max();
  for (const Transmission& transmission : line) {
    if (tick < transmission.begin)
      next = std::min(next, transmission.begin);
    else if (tick < transmission.end())
      next = std::min(next,
                      tick + transmission.bit_ticks - (tick - transmission.begin) % transmission.bit_ticks);
  }
  return next;
}

}  // namespace

std::vector<bool> wire_bits(std::span<const uint8_t> bytes, std::vector<bool> memory) {
  std::vector<bool> bits = std::move(memory);
  bits.clear();
  bits.reserve(bytes.size() * kCharacterBits);
  for (const uint8_t byte : bytes)
    for (uint32_t n = 0; n < kCharacterBits; ++n) bits.push_back((wire_character(byte) >> n & 1) != 0);
  return bits;
}

// While a station sends, its receiver is off (half duplex), unless it has an echo.
bool level_at(std::span<const Transmission> line, const Ear& ear, Tick tick) {
  bool level = true;
  for (const Transmission& transmission : line) {
    if (!transmission.covers(tick)) continue;
    if (transmission.sender == ear.deaf_to && ear.deaf_to != kNoNode) return true;
    level = level && transmission.bits[static_cast<size_t>((tick - transmission.begin) / transmission.bit_ticks)];
  }
  return level != ear.swapped;
}

std::optional<Tick> next_start(std::span<const Transmission> line, const Ear& ear, Tick from, Tick until) {
  bool before = from == 0 || level_at(line, ear, from - 1);
  for (Tick tick = from; tick < until; tick = next_edge(line, tick)) {
    const bool level = level_at(line, ear, tick);
    if (before && !level) return tick;
    before = level;
  }
  return std::nullopt;
}

Reading read_character(std::span<const Transmission> line, const Ear& ear, Tick start) {
  const Tick middle = start + ear.bit_ticks / 2;
  if (level_at(line, ear, middle)) return {std::nullopt, middle};
  uint16_t bits = 0;
  for (uint32_t n = 1; n < kCharacterBits; ++n)
    if (level_at(line, ear, middle + Tick{n} * ear.bit_ticks)) bits = static_cast<uint16_t>(bits | 1U << n);
  Character character = read_wire(bits);
  character.start = time_of(start);
  character.end = time_of(start + character_ticks(ear));
  return {character, middle + Tick{kCharacterBits - 1} * ear.bit_ticks + 1};
}

}  // namespace ipos::runtime
