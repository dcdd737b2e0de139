// Touch probes: an edge at DI02 (probe 1) or DI03 (probe 2) stores the positions of all encoders
// (H502..H507). Every edge of the wanted kind is stored until the probe is disabled (ours).
#pragma once

#include <array>
#include <cstdint>

#include "runtime/positioning/encoders.hpp"

namespace ipos::runtime {

class TouchProbes {
 public:
  static constexpr size_t kProbes = 2;

  struct Probe {
    bool rising = false;
    bool falling = false;
    bool touched = false;  // since it was enabled
    bool fresh = false;    // in the last millisecond
    int32_t motor = 0, external = 0, absolute = 0;
    bool operator==(const Probe&) const = default;
  };

  // _TouchProbe: enabling forgets an older edge; with neither edge the probe is disabled.
  void enable(size_t probe, bool rising, bool falling);

  // One millisecond. `levels` as InputLevel H483.
  void tick(uint16_t levels, const Encoders& encoders) {
    for (Probe& probe : probes_) probe.fresh = false;
    if (levels != levels_) take_levels(levels, encoders);
  }

  const Probe& probe(size_t n) const { return probes_[n]; }
  bool operator==(const TouchProbes&) const = default;

 private:
  void take_levels(uint16_t levels, const Encoders& encoders);

  std::array<Probe, kProbes> probes_{};
  uint16_t levels_ = 0;
};

}  // namespace ipos::runtime
