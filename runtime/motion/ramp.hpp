// The ramp generator: t11..t14, t21..t24 (P130..P147), one step a millisecond.
//
// Linear: the speed moves by reference / time each millisecond, exactly, without drift. A reversal goes down
// on the ramp of the old direction and up on that of the new one, in the middle of a millisecond if it must.
//
// S pattern 1, 2, 3 (P135; the rule is ours, no manual at hand has one): the slope of the linear ramp is
// built up and down evenly within 1/8, 1/4, 1/2 of the ramp time, at most 16 s. The change takes that much
// longer and is symmetric. The time is that of t12, up = down, in `up_cw_ms`; zero is passed without a stop.
// A target that is taken back while the speed still rises is passed and then approached from the other side.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/motion/fine_speed.hpp"

namespace ipos::runtime {

// Times in ms for a change by the reference; 0 is a jump, more than 2000 s count as 2000 s.
struct RampTimes {
  uint32_t up_cw_ms = 0, down_cw_ms = 0, up_ccw_ms = 0, down_ccw_ms = 0;
  uint8_t s_pattern = 0;  // 0 linear, 1 weak, 2 medium, 3 strong; more counts as 3
};

class Ramp {
 public:
  // `reference`: 1/1000 rpm, see MachineData::ramp_reference.
  explicit Ramp(int32_t reference) : reference_(reference), whole_(reference * kFine) {}

  FineSpeed output() const { return output_; }
  // Goes on from this speed, without slope.
  void set(FineSpeed speed) {
    output_ = std::clamp(speed, -kTopFine, kTopFine);
    level_ = 0;
  }
  // Goes on from this speed with the slope it has.
  void wait_at(FineSpeed speed) { output_ = speed; }
  void step(FineSpeed target, const RampTimes& times) {
    if (times.s_pattern == 0 && output_ == target)
      level_ = 0;  // it is there
    else
      go_on(target, times);
  }
  bool operator==(const Ramp&) const = default;

 private:
  // Slope of an S pattern: level times reference / (ms x levels) per millisecond.
  struct Slope {
    uint32_t ms = 0;
    int32_t levels = 0;
    bool operator==(const Slope&) const = default;
  };

  void go_on(FineSpeed target, const RampTimes& times);
  void step_linear(FineSpeed target, const RampTimes& times);
  uint64_t leg(FineSpeed goal, uint32_t ms, uint64_t left);
  void step_s_pattern(FineSpeed target, Slope slope);
  int64_t exact(int64_t divisor, int64_t level);

  int32_t reference_;
  FineSpeed output_ = 0;
  int64_t divisor_ = 1;  // of the running slope
  int64_t whole_;        // reference / divisor_
  int64_t part_ = 0;     // and what is left of that
  int64_t rest_ = 0;     // what its steps so far left undivided
  Slope slope_;
  int32_t level_ = 0;  // signed: the present slope of an S pattern
};

}  // namespace ipos::runtime
