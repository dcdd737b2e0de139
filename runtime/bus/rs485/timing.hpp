// The times of RS-485 (1053 1610 p. 19-27; MDX60B/61B p. 18-20) and the clock of the simulated line: ticks of
// one bit at 57.6 kbaud, so that a bit of 9.6 kbaud is six of them and stations of both rates share one line.
// The milliseconds are the same at both rates (MDX60B/61B prints no others).
#pragma once

#include <array>
#include <cstdint>

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

inline constexpr Time kStartPause = 3'440 * kMicrosecond;    // at least, before SD1 and before SD2
inline constexpr Time kCharacterGap = 3'430 * kMicrosecond;  // at most, within a telegram (MDX60B/61B p. 18)
inline constexpr Time kAbortPause = 2 * kStartPause;         // after a request that was broken off (p. 19)
inline constexpr Time kBroadcastPause = 25 * kMillisecond;   // after a request to 255 (p. 22)
inline constexpr Time kResponseDelay = 50 * kMillisecond;    // at most, from BCC to SD2 (p. 27)

inline constexpr std::array<uint32_t, 2> kSerialBaudRates = {9'600, 57'600};
inline constexpr uint32_t kCharacterBits = 11;

using Tick = uint64_t;
inline constexpr uint32_t kTicksPerSecond = 57'600;

constexpr uint32_t ticks_per_bit(uint32_t baud) { return kTicksPerSecond / baud; }

// When a tick begins, in whole nanoseconds rounded down.
constexpr Time time_of(Tick tick) {
  return static_cast<Time>(tick / kTicksPerSecond) * kSecond +
         static_cast<Time>(tick % kTicksPerSecond) * kSecond / kTicksPerSecond;
}

// The first tick that does not begin before `time`.
constexpr Tick tick_from(Time time) {
  const Time part = time % kSecond * kTicksPerSecond;
  return static_cast<Tick>(time / kSecond) * kTicksPerSecond +
         static_cast<Tick>((part + kSecond - 1) / kSecond);
}

constexpr Time character_time(uint32_t baud) { return time_of(Tick{kCharacterBits} * ticks_per_bit(baud)); }

}  // namespace ipos::runtime
