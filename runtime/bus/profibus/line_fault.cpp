// What a fault leaves of a frame. Noise turns one to three bits of the characters round: fewer than the
// distance of the frame formats, so that no receiver takes the rest for another frame; only a token has no
// check octet.
#include "runtime/bus/profibus/line_fault.hpp"

#include <set>

#include "runtime/bus/profibus/timing.hpp"

namespace ipos::profibus {
namespace {

// Bits 0 and 10 of a character are start and stop, 9 is parity.
void disturb(WireFrame& frame, runtime::Random& random) {
  const auto bits = static_cast<uint32_t>(frame.octets.size() * kCharacterBits);
  std::set<uint32_t> disturbed;
  const uint32_t count = 1 + random.below(runtime::kMostDisturbedBits);
  while (disturbed.size() < count) disturbed.insert(random.below(bits));
  std::vector<bool> odd(frame.octets.size());
  for (const uint32_t bit : disturbed) {
    const auto character = static_cast<size_t>(bit / kCharacterBits);
    const uint32_t place = bit % kCharacterBits;
    if (place == 0 || place == kCharacterBits - 1) {
      frame.damage = FrameError::Framing;
    } else {
      odd[character].flip();
      if (place <= 8)
        frame.octets[character] = static_cast<uint8_t>(frame.octets[character] ^ 1U << (place - 1));
    }
  }
  for (const bool wrong : odd)
    if (wrong && !frame.damage) frame.damage = FrameError::Parity;
}

}  // namespace

void damage(OctetFaultKind kind, WireFrame& frame, runtime::Random& random) {
  switch (kind) {
    case OctetFaultKind::Lost: return frame.octets.clear();
    case OctetFaultKind::Cut:
      return frame.octets.resize(random.below(static_cast<uint32_t>(frame.octets.size())));
    case OctetFaultKind::Parity:
    case OctetFaultKind::Collision: frame.damage = FrameError::Parity; return;
    case OctetFaultKind::Noise:
    case OctetFaultKind::Terminator:
    case OctetFaultKind::Length: break;
    default: return;  // of stations
  }
  disturb(frame, random);
}

}  // namespace ipos::profibus
