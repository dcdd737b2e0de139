// The fault of the unit as Slave_Diag shows it: taken over every 800 ms only, so that it comes and goes up to
// 800 ms late (MOVITRAC 31 PROFIBUS, 3.4). Counted from power-on (ours).
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

using runtime::Time;

class UnitFault {
 public:
  static constexpr Time kRefresh = 800 * runtime::kMillisecond;

  void power_on(Time now) { *this = UnitFault(now); }

  // The fault the unit has from now on.
  void set(Time now, std::optional<uint8_t> fault) {
    settle(now);
    present_ = fault;
    changed_ = now;
  }
  std::optional<uint8_t> shown(Time now) {
    settle(now);
    return shown_;
  }

  UnitFault() = default;

 private:
  explicit UnitFault(Time now) : origin_(now), changed_(now) {}

  // Between two changes the unit's fault is one: only the last refresh counts.
  void settle(Time now) {
    const Time refresh = now - (now - origin_) % kRefresh;
    if (refresh >= changed_) shown_ = present_;
  }

  Time origin_ = 0;
  Time changed_ = 0;
  std::optional<uint8_t> present_;
  std::optional<uint8_t> shown_;
};

}  // namespace ipos::profibus
