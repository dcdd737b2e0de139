// Window tests and bit work of the cam controllers.
#include "runtime/positioning/cams.hpp"

#include <algorithm>
#include <iterator>

namespace ipos::runtime {
namespace {

using Variables = std::span<int32_t>;

constexpr size_t kMostWindows = 4;

bool exists(Variables h, int64_t first, size_t count) {
  return first >= 0 && static_cast<size_t>(first) + count <= h.size();
}

// The value of the source when the output's dead time is over; 0.1 ms a digit.
int64_t leading(int32_t value, int32_t change, int32_t dead_time) {
  return value + int64_t{change} * dead_time / 10;
}

// Pairs of left and right limits, both part of the window; left must be below right (IPOSplus p. 86).
bool in_a_window(int64_t position, std::span<const int32_t> limits, int32_t windows) {
  const auto count = static_cast<size_t>(std::clamp<int32_t>(windows, 0, kMostWindows));
  for (size_t n = 0; n < count; ++n)
    if (limits[2 * n] < limits[2 * n + 1] && position >= limits[2 * n] && position <= limits[2 * n + 1])
      return true;
  return false;
}

void set_bits(int32_t& variable, uint32_t mask, uint32_t bits) {
  variable = static_cast<int32_t>((static_cast<uint32_t>(variable) & ~mask) | (bits & mask));
}

// Elements of GSCAM, and of what GSCAM_EXT points to for an output.
namespace standard {
constexpr size_t kSourceVar = 0, kDeadTime = 1, kDestVar = 2, kBitPosition = 3, kBitValue = 4, kWindows = 5,
                 kLimits = 6, kLength = 14;
}
namespace extended {
constexpr size_t kState = 0, kShift = 2, kForceOn = 3, kForceOff = 4, kSource = 5, kDestination = 6,
                 kCount = 7, kData = 8, kLength = 16;
}
namespace output {
constexpr size_t kDeadTime = 0, kWindows = 1, kLimits = 2, kLength = 10;
}

// CamSource 0..2: the encoders.
constexpr uint32_t kEncoderVariables[] = {511, 510, 509};

// The variable CamSource names, or -1. The virtual encoder (3) is not simulated.
int64_t source_of(int32_t element) {
  const auto bits = static_cast<uint32_t>(element);
  if ((bits >> 31) != 0) return bits & 0x7FFF'FFFFU;
  return bits < std::size(kEncoderVariables) ? kEncoderVariables[bits] : -1;
}

}  // namespace

void CamSources::watch(uint32_t variable, std::span<const int32_t> h) {
  for (const Source& source : sources_)
    if (source.used && source.variable == variable) return;
  for (Source& source : sources_) {
    if (source.used) continue;
    source = {true, variable, h[variable], 0};
    return;
  }
}

void CamSources::tick(std::span<const int32_t> h) {
  for (Source& source : sources_) {
    if (!source.used) break;  // they are taken in order
    const int32_t now = h[source.variable];
    source.change = static_cast<int32_t>(static_cast<uint32_t>(now) - static_cast<uint32_t>(source.value));
    source.value = now;
  }
}

int32_t CamSources::change(uint32_t variable) const {
  for (const Source& source : sources_)
    if (source.used && source.variable == variable) return source.change;
  return 0;
}

bool run_standard_cam(uint32_t structure, Variables h, CamSources& sources) {
  using namespace standard;
  if (!exists(h, structure, kLength)) return false;
  const auto cam = h.subspan(structure, kLength);
  const auto source = static_cast<uint32_t>(cam[kSourceVar]);
  if (!exists(h, cam[kSourceVar], 1) || !exists(h, cam[kDestVar], 1)) return false;
  sources.watch(source, h);
  const int64_t position = leading(h[source], sources.change(source), cam[kDeadTime]);
  const bool inside = in_a_window(position, cam.subspan(kLimits), cam[kWindows]);
  const uint32_t mask = 1U << (static_cast<uint32_t>(cam[kBitPosition]) & 31U);
  set_bits(h[static_cast<size_t>(cam[kDestVar])], mask, inside == (cam[kBitValue] == 0) ? mask : 0);
  return true;
}

bool ExtendedCams::start(uint32_t structure, Variables h, CamSources& sources) {
  if (!exists(h, structure, extended::kLength)) return false;
  const int64_t source = source_of(h[structure + extended::kSource]);
  if (exists(h, source, 1)) sources.watch(static_cast<uint32_t>(source), h);
  for (const Cam& cam : cams_)
    if (cam.used && cam.structure == structure) return true;
  for (Cam& cam : cams_) {
    if (cam.used) continue;
    cam = {true, structure, 0};
    return true;
  }
  return false;
}

bool ExtendedCams::tick(Variables h, CamSources& sources, const Status& status) {
  bool good = true;
  for (Cam& cam : cams_) {
    if (!cam.used || run(cam, h, sources, status)) continue;
    cam.used = false;
    good = false;
  }
  return good;
}

bool ExtendedCams::run(Cam& cam, Variables h, CamSources& sources, const Status& status) {
  using namespace extended;
  const auto element = [&](size_t n) { return h[cam.structure + n]; };
  enum State : uint32_t { Inactive = 0x8000'0000, Off, IfReferenced, Always };
  const auto state = static_cast<uint32_t>(element(kState));
  if (state < Inactive || state > Always || state == Inactive) return true;
  const auto count = static_cast<size_t>(std::clamp<int32_t>(element(kCount), 0, kOutputs));
  const int64_t source = source_of(element(kSource));
  if (!exists(h, source, 1) || !exists(h, element(kDestination), 1)) return false;

  if (state == Off || (state == IfReferenced && !status.referenced)) {
    cam.outputs = 0;
  } else {
    constexpr size_t kFast = 4;
    constexpr uint64_t kSlowMs = 4;
    const auto at = static_cast<uint32_t>(source);
    for (size_t n = 0; n < count; ++n) {
      if (n >= kFast && status.ms % kSlowMs != 0) continue;
      const int32_t data = element(kData + n);
      if (!exists(h, data, output::kLength)) return false;
      const auto out = h.subspan(static_cast<size_t>(data), output::kLength);
      const int64_t position = leading(h[at], sources.change(at), out[output::kDeadTime]);
      const uint32_t bit = 1U << n;
      cam.outputs &= ~bit;
      if (in_a_window(position, out.subspan(output::kLimits), out[output::kWindows])) cam.outputs |= bit;
    }
  }
  // Upper outputs fall off the end (IPOSplus p. 91); only the bits of the outputs are written (ours).
  const auto shift = static_cast<uint32_t>(element(kShift));
  if (shift > 31) return true;
  const uint32_t all = (1U << count) - 1U;
  const uint32_t forced =
      (cam.outputs | static_cast<uint32_t>(element(kForceOn))) & ~static_cast<uint32_t>(element(kForceOff));
  const uint32_t bits = state == Off ? 0 : forced;
  set_bits(h[static_cast<size_t>(element(kDestination))], all << shift, bits << shift);
  return true;
}

}  // namespace ipos::runtime
