// What becomes of a CAN frame that a station at another rate hears or sends, bit by bit of the line (ISO 11898-1, error
// signalling): where each side notices, how long the flags are together, and who sees a dominant bit behind its own flag.
// All that is taken together here is ours: bits are sampled in their middle, and no station resynchronises.
#pragma once

#include <cstdint>

#include "runtime/bus/can/frame_bits.hpp"

namespace ipos::runtime {

// A bit of the station is line / station bits of the line.
struct TwoRates {
  uint32_t line;
  uint32_t station;
};

struct Clash {
  uint32_t end = 0;            // bits from the start of frame to the end of the last error flag
  bool station_waits = false;  // it sees a dominant bit behind its own flag: 8 more in its counter
  bool others_wait = false;    // the same of the listeners at the rate of the line
  bool unheard = false;        // no flag has reached the station: it misses the acknowledge only
};

// An error-active station at another rate hears a good frame. The frame is destroyed behind its arbitration field, where a
// flag would only win the arbitration, and at the latest in its CRC delimiter.
Clash clash_of_listener(const WireBits& frame, bool extended, bool sender_active, TwoRates rates);

// A station at another rate sends, alone or while another one sends (`beside`). `heard`: an error-active station at the rate
// of the line is there.
Clash clash_of_sender(const WireBits& own, bool own_active, const WireBits* beside, bool heard, TwoRates rates);

}  // namespace ipos::runtime
