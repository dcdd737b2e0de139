// Who gets through after arbitration, and what an error frame costs (ISO 11898-1, error signalling).
#include "runtime/bus/can/transfer.hpp"

#include <algorithm>
#include <cassert>

#include "runtime/bus/can/bit_error.hpp"
#include "runtime/bus/can/frame_bits.hpp"

namespace ipos::runtime {
namespace {

void end_with_error(Transfer& transfer, Transfer::Outcome outcome, uint32_t flag_end) {
  transfer.outcome = outcome;
  transfer.end = flag_end + kErrorDelimiterBits;
  transfer.bits = transfer.end + kIntermissionBits;
}

// The sender finds no acknowledge in its slot, and begins its flag with the bit after it.
void end_unacknowledged(Transfer& transfer, uint32_t frame_end) {
  constexpr uint32_t kFromSlotToEnd = 9;  // with the slot: delimiter and end of frame are 8 bits
  end_with_error(transfer, Transfer::Outcome::NoAcknowledge, frame_end - kFromSlotToEnd + 1 + kErrorFlagBits);
}

// First position where the two differ: different frames of one arbitration field do so before their CRC ends.
uint32_t first_difference(const WireBits& a, const WireBits& b) {
  uint32_t position = 0;
  while (position < a.count && a.recessive[position] == b.recessive[position]) ++position;
  return position;
}

// End of the superposed error flags when an error-active sender sees a dominant bit at `error` in place of
// its own recessive one. The sender of that dominant bit finds out at its next recessive bit, listeners at
// the sixth equal bit or at the CRC delimiter.
uint32_t collision_flag_end(const Transfer& transfer, const WireBits& dominant, uint32_t error,
                            bool listeners) {
  uint32_t end = error + 1 + kErrorFlagBits;
  for (const Transfer::Sender& sender : transfer.senders) {
    if (sender.lost || !sender.error_active) continue;
    const WireBits bits = wire_bits(sender.frame);
    if (!bits.recessive[error]) end = std::max(end, next_recessive(bits, error + 1) + 1 + kErrorFlagBits);
  }
  if (listeners) {
    uint32_t run = 1;
    while (run <= error && !dominant.recessive[error - run]) ++run;
    const uint32_t crc_delimiter = dominant.count - 10;
    end = std::max(end, std::min(error + 6 - run, crc_delimiter) + 1 + kErrorFlagBits);
  }
  return end;
}

// No dominant bit between this one and the end of the CRC.
bool is_silent_anyway(const WireBits& bits, uint32_t from) {
  for (uint32_t i = from + 1; i < bits.count - 10; ++i)
    if (!bits.recessive[i]) return false;
  return true;
}

// A disturbed bit: of all stations, of the sender or of one listener.
void disturb(Transfer& transfer, Listeners listeners, const WireBits& bits) {
  const Transfer::Sender& sender = transfer.winner();
  const uint32_t bit = disturbed_bit(bits, sender.frame.extended, transfer.fault.chance);
  const bool by_sender = transfer.fault.node == kNoNode ||
                         std::any_of(transfer.senders.begin(), transfer.senders.end(),
                                     [&](const auto& s) { return s.node == transfer.fault.node; });
  WireBits wrong = bits;
  wrong.recessive.flip(bit);
  if (by_sender) {
    // The sender monitors what it sends, so it is the first to notice. Its flag begins with the next bit.
    const WireBits& seen = transfer.fault.node == kNoNode ? wrong : bits;
    if (!sender.error_active && transfer.fault.node != kNoNode && is_silent_anyway(bits, bit)) {
      transfer.outcome = Transfer::Outcome::Repeated;  // nobody but the sender sees anything wrong
      return;
    }
    const uint32_t end =
        sender.error_active ? flags_end(seen, bit + 1, FirstFlag::Sender) : silence_end(seen, bit);
    return end_with_error(transfer, Transfer::Outcome::Corrupted, end);
  }
  if (!listeners.struck) return;
  if (listeners.struck_error_active) {
    WireBits seen = bits;
    if (listeners.others) {  // they have no reason not to acknowledge
      seen.recessive.reset(bits.count - 9);
      wrong.recessive.reset(bits.count - 9);
    }
    return end_with_error(transfer, Transfer::Outcome::Corrupted,
                          flags_end(seen, receiver_notices(wrong, false) + 1, FirstFlag::Listener));
  }
  // An error-passive listener cannot make itself heard: it alone has no frame, and gives no acknowledge.
  if (!listeners.others) end_unacknowledged(transfer, bits.count);
}

// The sender sees its last bit dominant. The others have the frame already, for them it is an overload flag.
void repeat(Transfer& transfer, const WireBits& bits) {
  transfer.outcome = Transfer::Outcome::Repeated;
  transfer.end = bits.count;
  transfer.bits = bits.count + 1 + kErrorFlagBits + kErrorDelimiterBits + kIntermissionBits;
}

void settle_outcome(Transfer& transfer, const Listeners& listeners, KnownFrames& known, bool short_circuit) {
  assert(!transfer.senders.empty());
  if (short_circuit)  // the start of frame already fails, and the flag is not seen
    return end_with_error(transfer, Transfer::Outcome::NoLevel, 1 + kErrorFlagBits);
  if (transfer.senders.size() == 1 && !transfer.fault.kind) {
    transfer.bits = known.bits(transfer.senders.front().frame);
    transfer.end = transfer.bits - kIntermissionBits;
    transfer.outcome = Transfer::Outcome::Delivered;
    if (!listeners.any) end_unacknowledged(transfer, transfer.end);
    return;
  }
  // The bus carries the frame that is dominant at each first difference.
  const Frame* carried = &transfer.senders.front().frame;
  WireBits bits = wire_bits(*carried);
  for (const Transfer::Sender& sender : transfer.senders) {
    if (sender.frame == *carried) continue;
    const WireBits other = wire_bits(sender.frame);
    if (!other.recessive[first_difference(bits, other)]) {
      carried = &sender.frame;
      bits = other;
    }
  }
  // Senders of other frames notice in the order of their first difference; the first error-active one ends it
  // all.
  uint32_t error = bits.count;
  for (const Transfer::Sender& sender : transfer.senders)
    if (sender.frame != *carried && sender.error_active)
      error = std::min(error, first_difference(bits, wire_bits(sender.frame)));
  for (Transfer::Sender& sender : transfer.senders)
    sender.lost = sender.frame != *carried && first_difference(bits, wire_bits(sender.frame)) < error;
  if (error < bits.count) {
    end_with_error(transfer, Transfer::Outcome::Collision,
                   collision_flag_end(transfer, bits, error, listeners.error_active));
  } else if (!listeners.any) {
    end_unacknowledged(transfer, bits.count);
  } else {
    transfer.outcome = Transfer::Outcome::Delivered;
    transfer.end = bits.count;
    transfer.bits = bits.count + kIntermissionBits;
    const FrameFault& fault = transfer.fault;
    if (fault.disturbs_a_bit()) disturb(transfer, listeners, bits);
    if (fault.is(FaultKind::Duplicate)) repeat(transfer, bits);
  }
}

// Whose flag there is: of a sender, or of a listener who has seen the frame destroyed.
bool is_flagged(const Transfer& transfer, const Listeners& listeners) {
  using Outcome = Transfer::Outcome;
  if (transfer.outcome == Outcome::Delivered || transfer.outcome == Outcome::NoLevel) return false;
  const bool sender = std::any_of(transfer.senders.begin(), transfer.senders.end(),
                                  [](const auto& s) { return s.error_active && !s.lost; });
  const bool destroyed = transfer.outcome == Outcome::Corrupted || transfer.outcome == Outcome::Collision;
  return sender || (destroyed && listeners.error_active);
}

}  // namespace

void resolve(Transfer& transfer, Listeners listeners, KnownFrames& known, bool short_circuit) {
  settle_outcome(transfer, listeners, known, short_circuit);
  transfer.flagged = is_flagged(transfer, listeners);
}

}  // namespace ipos::runtime
