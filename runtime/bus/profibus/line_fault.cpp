// What a fault leaves of a frame. Noise turns one to three bits of the characters round: fewer than the
// distance of the frame formats, so that no receiver takes the rest for another frame; only a token has no
// check octet.
#include "runtime/bus/profibus/line_fault.hpp"

#include <set>

#include "runtime/bus/profibus/timing.hpp"

namespace ipos::profibus {
namespace {

struct FaultRow {
  LineFaultKind kind;
  std::string_view word;
  std::string_view text;
};
constexpr FaultRow kRows[] = {
#define DP_LINE_FAULT(name, word, text) {LineFaultKind::name, word, text},
#include "runtime/bus/profibus/line_faults.def"
};

constexpr uint32_t kMostDisturbedBits = 3;

// Bits 0 and 10 of a character are start and stop, 9 is parity.
void disturb(WireFrame& frame, runtime::Random& random) {
  const auto bits = static_cast<uint32_t>(frame.octets.size() * kCharacterBits);
  std::set<uint32_t> disturbed;
  const uint32_t count = 1 + random.below(kMostDisturbedBits);
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

void damage(LineFaultKind kind, WireFrame& frame, runtime::Random& random) {
  switch (kind) {
    case LineFaultKind::Lost: return frame.octets.clear();
    case LineFaultKind::Cut:
      return frame.octets.resize(random.below(static_cast<uint32_t>(frame.octets.size())));
    case LineFaultKind::Parity:
    case LineFaultKind::Collision: frame.damage = FrameError::Parity; return;
    case LineFaultKind::Noise: break;
  }
  disturb(frame, random);
}

}  // namespace

std::string_view line_fault_text(LineFaultKind kind) { return kRows[static_cast<size_t>(kind)].text; }

std::optional<LineFaultKind> find_line_fault(std::string_view word) {
  for (const FaultRow& row : kRows)
    if (row.word == word) return row.kind;
  return std::nullopt;
}

std::optional<LineFaultKind> LineFaults::strike(Time now, NodeId sender, WireFrame& frame) {
  std::optional<LineFaultKind> struck;
  for (Planted& planted : faults_) {
    const LineFault& fault = planted.fault;
    if (now < fault.from || now >= fault.until) continue;
    if (fault.sender != runtime::kNoNode && fault.sender != sender) continue;
    ++planted.seen;
    const bool meant =
        fault.frame == 0 ? planted.random.below(1000) < fault.per_mille : planted.seen == fault.frame;
    if (!meant || struck) continue;
    struck = fault.kind;
    damage(fault.kind, frame, planted.random);
  }
  return struck;
}

}  // namespace ipos::profibus
