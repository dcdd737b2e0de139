// The clock of a PROFIBUS line: bit times of its own rate since time 0, turned into nanoseconds once per event,
// so that nothing adds up; and the rates with their times in bits.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

using runtime::Time;

using Bits = uint64_t;
inline constexpr Bits kCharacterBits = 11;
inline constexpr Bits kSynBits = 33;  // of idle before a request or a token

struct BaudRate {
  uint32_t baud;
  std::string_view keyword;  // of the GSD file
  uint16_t max_tsdr;
  uint16_t slot;
  uint8_t fms_min_tsdr;
  uint16_t metres;  // longest segment of cable type A
};
inline constexpr BaudRate kBaudRates[] = {
// from the highest down
#define DP_BAUD(baud, keyword, max_tsdr, slot, fms_min_tsdr, metres) \
  {baud, keyword, max_tsdr, slot, fms_min_tsdr, metres},
#include "runtime/bus/profibus/baud_rates.def"
};

// nullptr: no rate of this line.
constexpr const BaudRate* find_baud_rate(uint32_t baud) {
  for (const BaudRate& rate : kBaudRates)
    if (rate.baud == baud) return &rate;
  return nullptr;
}

// When a bit begins, in whole nanoseconds rounded down.
constexpr Time time_of(Bits bit, uint32_t baud) {
  return static_cast<Time>(bit / baud) * runtime::kSecond +
         static_cast<Time>(bit % baud * static_cast<Bits>(runtime::kSecond) / baud);
}

// The first bit that does not begin before `time`.
constexpr Bits bit_from(Time time, uint32_t baud) {
  const Bits part = static_cast<Bits>(time % runtime::kSecond) * baud;
  return static_cast<Bits>(time / runtime::kSecond) * baud +
         (part + static_cast<Bits>(runtime::kSecond) - 1) / static_cast<Bits>(runtime::kSecond);
}

}  // namespace ipos::profibus
