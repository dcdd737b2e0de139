// A disturbed bit of a CAN frame: who notices when, and how long the superposed error flags are (ISO 11898-1,
// error signalling). Positions count the bits from the start of frame.
#pragma once

#include <cstdint>

#include "runtime/bus/can/frame_bits.hpp"

namespace ipos::runtime {

inline constexpr uint32_t kErrorFlagBits = 6;
inline constexpr uint32_t kErrorDelimiterBits = 8;
inline constexpr uint32_t kTailBits = 10;  // CRC delimiter, acknowledge slot and delimiter, end of frame

// Bits that a fault disturbs: after the arbitration field, where a bit error would only lose the
// arbitration, up to the end of the CRC.
uint32_t disturbed_bit(const WireBits& bits, bool extended, uint64_t chance);

// Where a receiver of these bits notices an error: at the sixth equal bit, at a dominant bit where the form
// is fixed, else, unless its CRC fits, after the acknowledge delimiter. That a wrong CRC fits by chance is
// left out (ours).
uint32_t receiver_notices(const WireBits& seen, bool crc_fits);

enum class FirstFlag : uint8_t { Sender, Listener };

// End of all error flags when an error-active station begins the first one at bit `begin` > 0. `seen` are the
// bits as the listeners see them without any flag.
uint32_t flags_end(WireBits seen, uint32_t begin, FirstFlag first);

// The same when an error-passive sender falls silent after bit `last`, which lies before the CRC delimiter.
uint32_t silence_end(WireBits seen, uint32_t last);

}  // namespace ipos::runtime
