// Edge detection; the position is that of the millisecond in which the level is seen.
#include "runtime/positioning/touch_probe.hpp"

namespace ipos::runtime {

void TouchProbes::enable(size_t n, bool rising, bool falling) {
  Probe& probe = probes_[n];
  probe.rising = rising;
  probe.falling = falling;
  probe.touched = false;
}

void TouchProbes::take_levels(uint16_t levels, const Encoders& encoders) {
  constexpr unsigned kFirstInput = 2;  // DI02
  for (unsigned n = 0; n < kProbes; ++n) {
    const bool before = (levels_ >> (kFirstInput + n) & 1) != 0;
    const bool now = (levels >> (kFirstInput + n) & 1) != 0;
    Probe& probe = probes_[n];
    if (before == now || !(now ? probe.rising : probe.falling)) continue;
    probe.touched = probe.fresh = true;
    probe.motor = encoders.position(PositionSource::Motor);
    probe.external = encoders.position(PositionSource::External);
    probe.absolute = encoders.position(PositionSource::Absolute);
  }
  levels_ = levels;
}

}  // namespace ipos::runtime
