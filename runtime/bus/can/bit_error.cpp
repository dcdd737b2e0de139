// Follows the rules bit by bit: stuffing up to the end of the CRC, fixed form after it.
#include "runtime/bus/can/bit_error.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

uint32_t crc_delimiter(const WireBits& bits) { return bits.count - kTailBits; }

// The header of a frame as a receiver reads it, bit by bit without stuff bits: how many bits it has in all.
class HeaderReader {
 public:
  void take(uint32_t n, bool recessive) {
    if (n == 12) remote_ = recessive;  // RTR, or SRR of an extended frame
    if (n == 13) extended_ = recessive;
    if (extended_ && n == 32) remote_ = recessive;
    const uint32_t length_at = extended_ ? 35 : 15;
    if (n >= length_at && n < length_at + 4) length_ = length_ * 2 + (recessive ? 1 : 0);
    if (n + 1 == length_at + 4) wanted_ = length_at + 4 + (remote_ ? 0 : 8 * std::min(length_, 8U)) + 15;
  }
  uint32_t wanted() const { return wanted_; }  // bits up to the end of the CRC

 private:
  bool remote_ = false;
  bool extended_ = false;
  uint32_t length_ = 0;
  uint32_t wanted_ = ~0U;
};

}  // namespace

uint32_t disturbed_bit(const WireBits& bits, bool extended, uint64_t chance) {
  // Start of frame, identifier, RTR and IDE; stuff bits among them only move the first bit back.
  const uint32_t first = extended ? 41 : 17;
  return first + static_cast<uint32_t>(chance % (crc_delimiter(bits) - first));
}

uint32_t receiver_notices(const WireBits& seen, bool crc_fits) {
  HeaderReader header;
  uint32_t run = 0;
  uint32_t unstuffed = 0;
  bool last = false;
  uint32_t i = 0;
  for (; i < seen.count && (unstuffed != header.wanted() || run == 5); ++i) {
    const bool bit = seen.recessive[i];
    if (run == 5) {
      if (bit == last) return i;
      run = 1;
    } else {
      run = run > 0 && bit == last ? run + 1 : 1;
      header.take(unstuffed++, bit);
    }
    last = bit;
  }
  const uint32_t delimiter = i;
  for (; i < seen.count && i < delimiter + kTailBits; ++i) {
    if (i == delimiter + 1) continue;  // the acknowledge slot may be either
    if (!seen.recessive[i] || (i == delimiter + 2 && !crc_fits)) return i;
  }
  return i;
}

uint32_t flags_end(WireBits seen, uint32_t begin, FirstFlag first) {
  uint32_t last_notice = begin - 1;
  if (first == FirstFlag::Listener) {  // the first recessive bit of the sender is overwritten
    last_notice = begin;
    while (last_notice < seen.count && !seen.recessive[last_notice]) ++last_notice;
  }
  for (uint32_t i = begin; i < begin + kErrorFlagBits; ++i) seen.recessive.reset(i);
  seen.count = std::max(seen.count, begin + kErrorFlagBits);
  const uint32_t listeners = receiver_notices(seen, first == FirstFlag::Listener);
  return std::max(last_notice, listeners) + 1 + kErrorFlagBits;
}

uint32_t silence_end(WireBits seen, uint32_t last) {
  for (uint32_t i = last + 1; i < seen.recessive.size(); ++i) seen.recessive.set(i);
  return receiver_notices(seen, false) + 1 + kErrorFlagBits;
}

}  // namespace ipos::runtime
