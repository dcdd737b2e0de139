// Bit 11 n + k is bit k of character n: 0 start, 1..8 data, 9 parity, 10 stop. The line rests at 1.
#include "runtime/bus/rs485/bit_fault.hpp"

#include <algorithm>
#include <set>

#include "runtime/bus/rs485/timing.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kParityBit = 9;

void rest(std::vector<bool>& bits, size_t from, size_t until) {
  for (size_t n = from; n < std::min(until, bits.size()); ++n) bits[n] = true;
}

void flip_some(std::vector<bool>& bits, Random& random) {
  const auto size = static_cast<uint32_t>(bits.size());
  const uint32_t count = std::min(size, 1 + random.below(kMostDisturbedBits));
  std::set<uint32_t> flipped;
  while (flipped.size() < count) flipped.insert(random.below(size));
  for (const uint32_t bit : flipped) bits[bit] = !bits[bit];
}

}  // namespace

void damage(OctetFaultKind kind, std::vector<bool>& bits, Random& random) {
  const auto characters = static_cast<uint32_t>(bits.size() / kCharacterBits);
  switch (kind) {
    case OctetFaultKind::Lost: return rest(bits, 0, bits.size());
    case OctetFaultKind::Cut: return rest(bits, kCharacterBits * random.below(std::max(characters, 1U)), bits.size());
    case OctetFaultKind::Parity: {
      const size_t bit = kCharacterBits * random.below(std::max(characters, 1U)) + kParityBit;
      if (bit < bits.size()) bits[bit] = !bits[bit];
      return;
    }
    case OctetFaultKind::Collision: {  // a 0 overrules a 1; one of the 11 is a stop bit
      const uint32_t from = random.below(static_cast<uint32_t>(std::max<size_t>(bits.size(), kCharacterBits)) - kCharacterBits + 1);
      for (size_t n = from; n < std::min<size_t>(from + kCharacterBits, bits.size()); ++n) bits[n] = false;
      return;
    }
    default: return flip_some(bits, random);
  }
}

}  // namespace ipos::runtime
