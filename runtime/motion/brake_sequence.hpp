// From enable to motion and back: premagnetization (P323), brake release time (P731), motion, brake
// application time (P732), output stage off or standstill current (P710). The order of the steps is ours; the
// manuals at hand list the times only (1053 1610 p. 68-83).
#pragma once

#include <cstdint>

namespace ipos::runtime {

enum class AxisPhase : uint8_t {
  Off,                // output stage off, brake applied
  Magnetizing,        // output stage on, brake still applied
  Releasing,          // the brake opens, the motor holds the speed it found
  Moving,             // ramp and setpoints act
  Applying,           // standing, the brake closes, the motor still holds
  StandstillCurrent,  // brake applied, direct current in the motor
};

// All in ms. Without brake function both brake times are 0.
struct BrakeTimes {
  uint32_t premagnetize, release, apply;
};

class BrakeSequence {
 public:
  AxisPhase phase() const { return phase_; }

  // One of these each millisecond. A time of 0 is passed within the same one.
  void inhibit() { enter(AxisPhase::Off); }
  void enable(const BrakeTimes& times) {
    if (phase_ != AxisPhase::Moving) begin_motion(times);
  }
  // `standing`: ramp output and shaft are at 0. `hold_current`: standstill current is wanted.
  void stop(const BrakeTimes& times, bool standing, bool hold_current);
  bool operator==(const BrakeSequence&) const = default;

 private:
  void begin_motion(const BrakeTimes& times);
  void enter(AxisPhase phase) {
    phase_ = phase;
    elapsed_ = 0;
  }
  // True when `time` is over in this phase; else one more millisecond of it passes.
  bool over(uint32_t time) {
    if (elapsed_ >= time) return true;
    ++elapsed_;
    return false;
  }

  AxisPhase phase_ = AxisPhase::Off;
  uint32_t elapsed_ = 0;
};

}  // namespace ipos::runtime
