// The binary outputs: what P620..P637 put on them, and the reference signals P400..P442 with hysteresis and
// delay (1053 1610 p. 76, 79).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "runtime/drive/settings.hpp"
#include "runtime/part/part.hpp"

namespace ipos::runtime {

// Settings of P620..P637 the drive can show; those of the DRS card (16..18) are at their quiet level without it.
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
  // Ticks with the same comparison that only count, as the last one did (pace/part.hpp).
  void advance(Ticks ticks) {
    if (!settled()) lasted_ms_ += static_cast<int32_t>(ticks);
  }
  Ticks bound(int32_t delay_ms) const {
    return settled() ? kNoBound : static_cast<Ticks>(delay_ms - 1 - lasted_ms_);
  }
  bool operator==(const ReferenceSignal&) const = default;

 private:
  bool raw_ = false;
  bool shown_ = false;
  int32_t lasted_ms_ = 0;  // while it does not show
};

// What is on or off of a drive, for the outputs.
namespace output_flags {
inline constexpr uint32_t kFault = 1 << 0;
inline constexpr uint32_t kIposFault = 1 << 1;
inline constexpr uint32_t kReady = 1 << 2;
inline constexpr uint32_t kSecondSet = 1 << 3;
inline constexpr uint32_t kOutputStage = 1 << 4;
inline constexpr uint32_t kBrakeReleased = 1 << 5;
inline constexpr uint32_t kStandstill = 1 << 6;
inline constexpr uint32_t kMotor1Overloaded = 1 << 7;
inline constexpr uint32_t kMotor2Overloaded = 1 << 8;
inline constexpr uint32_t kInPosition = 1 << 9;
inline constexpr uint32_t kReferenced = 1 << 10;
inline constexpr uint32_t kDrsPrewarning = 1 << 11;
inline constexpr uint32_t kDrsLagError = 1 << 12;
inline constexpr uint32_t kDrsInPosition = 1 << 13;
}  // namespace output_flags

struct OutputInputs {
  uint32_t flags = 0;
  int32_t speed = 0;  // 1/1000 rpm
  int32_t setpoint = 0;
  int32_t current = 0;  // 1/1000 % of IN
  int32_t current_limit = 0;
  bool limited = false;       // the motor gives all that the current limit lets it
  uint16_t ipos_outputs = 0;  // by bit as below

  bool is(uint32_t flag) const { return (flags & flag) != 0; }
  // The current that shows is rounded down, so at the limit it may be less.
  int64_t limited_current() const {
    const int64_t shown = current < 0 ? -int64_t{current} : current;
    return limited ? std::max<int64_t>(shown, current_limit) : shown;
  }
};

class Outputs {
 public:
  // One millisecond. Bit 0 DB00, bit 1 DO01, bit 2 DO02, bit 8 DO10 .. bit 15 DO17.
  uint16_t tick(const Settings& settings, const OutputInputs& inputs);
  uint16_t levels() const { return levels_; }
  // A tick with the settings of the last one. False: nothing was done, for it takes tick().
  [[gnu::always_inline]] bool go_on(const OutputInputs& in) {
    if (!holds(in) || ticks_left_ == 0) return false;
    advance(1);
    return true;
  }
  // Nothing that is compared has another result with these.
  [[gnu::always_inline]] bool holds(const OutputInputs& in) const {
    return in.flags == basis_.flags && in.ipos_outputs == basis_.ipos_outputs && in.current_limit == current_limit_ &&
           holds_speed(in.speed) && holds_deviation(int64_t{in.speed} - in.setpoint) &&
           holds_current(in.current, in.limited);
  }
  bool holds_ipos_outputs(uint16_t levels) const { return levels == basis_.ipos_outputs; }
  bool holds_speed(int64_t speed) const { return speeds_.have(magnitude(speed)); }
  bool holds_deviation(int64_t deviation) const { return deviations_.have(magnitude(deviation)); }
  bool holds_current(int64_t current, bool limited) const { return currents_[limited ? 1 : 0].have(magnitude(current)); }
  // Ticks that go on with the same values (pace/part.hpp): delays run.
  void advance(Ticks ticks) {
    if (ticks_left_ == kNoBound) return;
    ticks_left_ -= ticks;
    ticks_ += ticks;
  }
  Ticks bound() const { return ticks_left_; }
  bool operator==(const Outputs&) const = default;

  // Values with which no comparison has another result.
  struct Range {
    int64_t low = 0;
    int64_t high = -1;
    bool have(int64_t value) const { return low <= value && value <= high; }
    bool operator==(const Range&) const = default;
  };
  const Range& speeds() const { return speeds_; }  // of the amount

 private:
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
  static Range both(const Range& a, const Range& b) {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
  }
  // With the limits of tick(), and within or outside of two limits.
  static Range staying(const ReferenceSignal& signal, int64_t above_from, int64_t below_to);
  static Range at_least(const Range& range, int64_t floor);
  static Range around(const ReferenceSignal& signal, int64_t from, int64_t to, int64_t value);

  ReferenceSignal speed_, window_, compare_, current_, limit_;
  // Range of values and number of ms for which go_on() is valid since the last tick(), and ms used.
  Range speeds_, deviations_;
  std::array<Range, 2> currents_;  // the second one where the motor gives all that the limit lets it
  int32_t current_limit_ = 0;
  Ticks ticks_left_ = kNoBound;
  Ticks ticks_ = 0;
  Signals signals_{};
  Basis basis_;
  uint16_t levels_ = 0;
};

}  // namespace ipos::runtime
