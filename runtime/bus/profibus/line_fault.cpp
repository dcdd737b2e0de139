// What a fault leaves of a frame. Noise turns one to three bits of the characters round: fewer than the
// distance of the frame formats, so that no receiver takes the rest for another frame; only a token has no
// check octet.
#include "runtime/bus/profibus/line_fault.hpp"

#include <algorithm>
#include <set>

#include "runtime/bus/profibus/timing.hpp"

namespace ipos::profibus {
namespace {

constexpr LineFaultType kTypes[] = {
#define DP_LINE_FAULT(name, word, scope, text) {LineFaultKind::name, word, LineFaultScope::scope, text},
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
    case LineFaultKind::Noise:
    case LineFaultKind::Terminator:
    case LineFaultKind::Length: break;
    default: return;  // of stations
  }
  disturb(frame, random);
}

}  // namespace

std::span<const LineFaultType> line_fault_types() { return kTypes; }

const LineFaultType& line_fault_type(LineFaultKind kind) { return kTypes[static_cast<size_t>(kind)]; }

std::optional<LineFaultKind> find_line_fault(std::string_view word) {
  for (const LineFaultType& type : kTypes)
    if (type.word == word) return type.kind;
  return std::nullopt;
}

bool LineFaults::end(LineFaultKind kind, NodeId sender, Time now) {
  bool found = false;
  for (Planted& planted : faults_) {
    LineFault& fault = planted.fault;
    if (fault.kind != kind || fault.sender != sender || fault.from > now || fault.until != runtime::kNever)
      continue;
    fault.until = now;
    found = true;
  }
  return found;
}

bool LineFaults::lasts(LineFaultKind kind, NodeId station, Time now) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const Planted& planted) {
    const LineFault& fault = planted.fault;
    return fault.kind == kind && fault.sender == station && fault.from <= now && now < fault.until;
  });
}

std::optional<LineFaultKind> LineFaults::strike(Time now, NodeId sender, WireFrame& frame) {
  std::optional<LineFaultKind> struck;
  for (Planted& planted : faults_) {
    const LineFault& fault = planted.fault;
    if (now < fault.from || now >= fault.until || line_fault_type(fault.kind).scope != LineFaultScope::Frame) continue;
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
