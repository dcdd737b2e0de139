// Two clocks on one wire: positions of one are turned into those of the other, and flags laid over the bits.
#include "runtime/bus/can/clash.hpp"

#include <algorithm>

#include "runtime/bus/can/bit_error.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kQuietBits = 11;  // after which a receiver knows that nothing follows

uint32_t capacity(const WireBits& bits) { return static_cast<uint32_t>(bits.recessive.size()); }

uint32_t in_line_bits(uint32_t bits, TwoRates rates) { return (bits * rates.line + rates.station - 1) / rates.station; }

// The bits of `sent`, as one with other bits sees them: `own` of his are as long as `theirs` of the sender.
WireBits sampled(const WireBits& sent, uint32_t own, uint32_t theirs) {
  WireBits seen;
  const uint32_t bits = (sent.count * own + theirs - 1) / theirs + kQuietBits;
  seen.count = std::min(bits, capacity(seen));
  for (uint32_t n = 0; n < seen.count; ++n) {
    const uint32_t at = (2 * n + 1) * theirs / (2 * own);
    seen.recessive[n] = at >= sent.count || sent.recessive[at];
  }
  return seen;
}

// The bits that pass until a station at another rate takes the frame for an error. It begins with the first dominant bit
// that it sees.
uint32_t notices_foreign(const WireBits& seen) {
  uint32_t start = 0;
  while (start < seen.count && seen.recessive[start]) ++start;
  return start + receiver_notices({seen.recessive >> start, seen.count - start}, false) + 1;
}

void hold_dominant(WireBits& bits, uint32_t begin, uint32_t end) {
  for (uint32_t n = begin; n < std::min(end, capacity(bits)); ++n) bits.recessive.reset(n);
  bits.count = std::min(std::max(bits.count, end), capacity(bits));
}

}  // namespace

Clash clash_of_listener(const WireBits& frame, bool extended, bool sender_active, TwoRates rates) {
  const uint32_t behind_arbitration = extended ? 41 : 17;
  const uint32_t notices = notices_foreign(sampled(frame, rates.station, rates.line));
  const uint32_t begin = std::clamp(in_line_bits(notices, rates), behind_arbitration, frame.count - kTailBits);
  const uint32_t own_end = begin + std::max(1U, in_line_bits(kErrorFlagBits, rates));
  const uint32_t sender_notices = next_recessive(frame, begin);
  WireBits heard = frame;
  if (!sender_active)  // it falls silent, and its flag is not seen
    for (uint32_t n = sender_notices + 1; n < capacity(heard); ++n) heard.recessive.set(n);
  hold_dominant(heard, begin, std::max(own_end, sender_notices + 1));
  if (sender_active) hold_dominant(heard, sender_notices + 1, sender_notices + 1 + kErrorFlagBits);
  const uint32_t listeners_end = receiver_notices(heard, false) + 1 + kErrorFlagBits;
  const uint32_t others_end = std::max(listeners_end, sender_active ? sender_notices + 1 + kErrorFlagBits : 0);
  Clash clash;
  clash.end = std::max(own_end, others_end);
  clash.station_waits = clash.end > own_end;
  clash.others_wait = clash.end > listeners_end;
  return clash;
}

Clash clash_of_sender(const WireBits& own, bool own_active, const WireBits* beside, bool heard, TwoRates rates) {
  Clash clash;
  const uint32_t own_flag = std::max(1U, in_line_bits(kErrorFlagBits, rates));
  if (!heard) {
    clash.unheard = true;
    clash.end = in_line_bits(own.count - kTailBits + 2, rates) + own_flag;  // behind the acknowledge slot
    return clash;
  }
  WireBits seen = sampled(own, rates.line, rates.station);
  uint32_t notices = capacity(seen);
  if (beside != nullptr)
    for (uint32_t n = 0; n < beside->count; ++n) {
      const bool foreign = n >= seen.count || seen.recessive[n];
      if (beside->recessive[n] && !foreign) notices = std::min(notices, n);
      if (!beside->recessive[n] && n < seen.count) seen.recessive.reset(n);
    }
  notices = std::min(notices, receiver_notices(seen, false));
  const uint32_t flag = notices + 1;
  const uint32_t flag_end = flag + kErrorFlagBits;
  clash.end = flag_end;
  const uint32_t at = next_recessive(own, flag * rates.station / rates.line);
  if (own_active && at < own.count) clash.end = std::max(flag_end, in_line_bits(at + 1, rates) + own_flag);
  clash.others_wait = clash.end > flag_end;
  return clash;
}

}  // namespace ipos::runtime
