// The binary outputs: what P620..P637 put on them, and the reference signals P400..P442 with hysteresis and
// delay (1053 1610 p. 76, 79).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "runtime/drive/settings.hpp"

namespace ipos::runtime {

// Settings of P620..P637 the drive can show; the functions of the DRS card (16..18) stay at their quiet
// level.
enum class OutputFunction : uint8_t {
  None = 0,
  NoFault = 1,
  Ready = 2,
  OutputStageOn = 3,
  RotatingField = 4,
  BrakeReleased = 5,
  BrakeApplied = 6,
  Standstill = 7,
  ParameterSet = 8,
  SpeedReference = 9,
  SpeedWindow = 10,
  SetpointReached = 11,
  CurrentReference = 12,
  CurrentLimit = 13,
  NoMotorUtilization1 = 14,
  NoMotorUtilization2 = 15,
  NoDrsPrewarning = 16,
  NoDrsLagError = 17,
  DrsInPosition = 18,
  IposInPosition = 19,
  IposReferenced = 20,
  IposOutput = 21,
  NoIposFault = 22,
  PiReference = 23,
};

// A comparison with hysteresis whose result must last before it shows.
class ReferenceSignal {
 public:
  // `above` the condition holds, `below` it does not; between the two the last one stays.
  bool tick(bool above, bool below, int32_t delay_ms) {
    const bool raw = above || (!below && raw_);
    if (raw == shown_) {
      raw_ = raw;
      return shown_;
    }
    lasted_ms_ = raw == raw_ ? lasted_ms_ + (lasted_ms_ < INT32_MAX) : 0;
    raw_ = raw;
    if (lasted_ms_ >= delay_ms) shown_ = raw;
    return shown_;
  }
  bool value() const { return shown_; }
  bool raw() const { return raw_; }
  bool settled() const { return raw_ == shown_; }  // no delay runs
  // Ticks that only count while the result stays as it is, and what they do.
  int32_t ticks_left(int32_t delay_ms) const { return settled() ? INT32_MAX : delay_ms - 1 - lasted_ms_; }
  void go_on(int32_t ticks) {
    if (!settled()) lasted_ms_ += ticks;
  }
  bool operator==(const ReferenceSignal&) const = default;

 private:
  bool raw_ = false;
  bool shown_ = false;
  int32_t lasted_ms_ = 0;  // while it does not show
};

// What the outputs show of the drive.
struct OutputInputs {
  bool fault = false;
  bool ipos_fault = false;
  bool ready = false;
  bool output_stage = false;
  bool brake_released = false;
  bool standstill = false;
  bool second_set = false;
  bool motor_1_overloaded = false;
  bool motor_2_overloaded = false;
  bool in_position = false;
  bool referenced = false;
  int32_t speed = 0;  // 1/1000 rpm
  int32_t setpoint = 0;
  int32_t current = 0;  // 1/1000 % of IN
  int32_t current_limit = 0;
  uint16_t ipos_outputs = 0;  // by bit as below

  constexpr uint32_t flags() const {
    const auto bit = [](bool flag, unsigned n) { return (flag ? 1U : 0U) << n; };
    return bit(fault, 0) | bit(ipos_fault, 1) | bit(ready, 2) | bit(output_stage, 3) |
           bit(brake_released, 4) | bit(standstill, 5) | bit(second_set, 6) | bit(motor_1_overloaded, 7) |
           bit(motor_2_overloaded, 8) | bit(in_position, 9) | bit(referenced, 10);
  }
};

// Of a drive that positioning moves, where the rest stays as it is; there a setpoint is not compared.
struct OutputMotion {
  bool standstill;
  bool in_position;
  bool referenced;
  int32_t speed;
  int32_t current;

  // Those of OutputInputs, where all others are 0.
  constexpr uint32_t flags() const {
    OutputInputs in;
    in.standstill = standstill;
    in.in_position = in_position;
    in.referenced = referenced;
    return in.flags();
  }
};
inline constexpr uint32_t kMotionFlags = OutputMotion{true, true, true, 0, 0}.flags();

class Outputs {
 public:
  // One millisecond. Bit 0 DB00, bit 1 DO01, bit 2 DO02, bit 8 DO10 .. bit 15 DO17.
  uint16_t tick(const Settings& settings, const OutputInputs& inputs);
  uint16_t levels() const { return levels_; }
  // A tick with the settings of the last one. False: nothing was done, for it takes tick().
  [[gnu::always_inline]] bool go_on(const OutputInputs& in) {
    return in.flags() == basis_.flags && in.ipos_outputs == basis_.ipos_outputs &&
           in.current_limit == current_limit_ && go_on(in.speed, in.setpoint, in.current);
  }
  [[gnu::always_inline]] bool go_on(const OutputMotion& in) {
    return in.flags() == (basis_.flags & kMotionFlags) && go_on(in.speed, 0, in.current);
  }
  bool operator==(const Outputs&) const = default;

 private:
  [[gnu::always_inline]] bool go_on(int32_t speed, int32_t setpoint, int32_t current) {
    const bool same = speeds_.have(magnitude(speed)) &&
                      deviations_.have(magnitude(int64_t{speed} - setpoint)) &&
                      currents_.have(magnitude(current));
    if (!same) return false;
    if (settled_) return true;
    if (ticks_left_ == 0) return false;
    --ticks_left_;
    ++ticks_;
    return true;
  }

  static int64_t magnitude(int64_t value) { return value < 0 ? -value : value; }
  void find_ranges(const Settings& settings, const OutputInputs& inputs);
  bool level(OutputFunction function, const OutputInputs& inputs, unsigned bit) const;

  struct Signals {
    bool speed, window, compare, current, limit;
    bool operator==(const Signals&) const = default;
  };
  // What the levels follow from; found again when one of it changes.
  struct Basis {
    uint32_t flags = 0;  // of OutputInputs
    uint16_t ipos_outputs = 0;
    Signals signals{};
    std::array<uint8_t, 16> functions{};
    bool operator==(const Basis&) const = default;
  };
  // Values with which no comparison has another result.
  struct Range {
    int64_t low = 0;
    int64_t high = -1;
    bool have(int64_t value) const { return low <= value && value <= high; }
    bool operator==(const Range&) const = default;
  };
  static Range both(const Range& a, const Range& b) {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
  }
  // With the limits of tick(), and within or outside of two limits.
  static Range staying(const ReferenceSignal& signal, int64_t above_from, int64_t below_to);
  static Range around(const ReferenceSignal& signal, int64_t from, int64_t to, int64_t value);

  ReferenceSignal speed_, window_, compare_, current_, limit_;
  // Range of values and number of ms for which go_on() is valid since the last tick(), and ms used.
  Range speeds_, deviations_, currents_;
  int32_t current_limit_ = 0;
  bool settled_ = true;
  int32_t ticks_left_ = 0;
  int32_t ticks_ = 0;
  Signals signals_{};
  Basis basis_;
  uint16_t levels_ = 0;
};

}  // namespace ipos::runtime
