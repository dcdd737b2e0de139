// Milliseconds in a row in which a drive goes as positioning tells it, in one direction, and nothing else happens: Drive::tick() with
// controls that differ in their speed alone. following_ticks() has said what all of them have in common; each is asked first
// whether it is such a tick, and where it is not, nothing has been done.
#pragma once

#include <algorithm>

#include "runtime/drive/drive.hpp"
#include "runtime/motion/axis_following.hpp"

namespace ipos::runtime {

class Drive::Following {
 public:
  [[gnu::always_inline]] explicit Following(Drive& drive)
      : drive_(drive),
        axis_(drive.state_.axis, drive.order_, drive.now_->reversing ? -1 : 1),
        speeds_(speeds_of(drive.state_.outputs, drive.now_->reversing)),
        counts_(drive.counts_limited()) {}

  // A tick at this speed. False: it would decide something.
  [[gnu::always_inline]] bool go(int32_t speed) {
    if (speed < speeds_.low || speeds_.high < speed) return false;
    const bool other_torque = axis_.aim(speed);
    if ((axis_.limited() && !holds_limited(speed)) || (other_torque && !holds_current())) {
      axis_.give_back();
      return false;
    }
    if (counts_) drive_.count_limited();
    axis_.go();
    return true;
  }
  // The next one may be such a tick, too: nothing has come up that it would have to watch.
  [[gnu::always_inline]] bool goes_on() {
    counts_ = drive_.counts_limited();
    const PowerSection& power = axis_.power();
    return power.dc_link() <= kOvervoltage && power.dc_link() >= drive_.least_dc_link_ &&
           power.energy() - drive_.state_.counted_energy < kEnergyDigit && (!counts_ || drive_.may_count_limited());
  }
  // So many of them are done, the last one with this control.
  [[gnu::always_inline]] void finish(const PositionControl& position, Ticks ticks) {
    State& state = drive_.state_;
    drive_.steady_left_ = 0;
    state.position = position;
    drive_.order_.target = state.setpoint.speed = state.setpoint.requested = position.speed;
    state.mains_ms += ticks;
    state.enabled_ms += ticks;
    axis_.finish(position.speed);
    state.outputs.advance(ticks);
  }

  int32_t position() const { return axis_.position(); }

 private:
  struct Speeds {
    int32_t low, high;
  };
  // With which no output changes, and the axis is not told to stand.
  static Speeds speeds_of(const Outputs& outputs, bool reversing) {
    const auto low = static_cast<int32_t>(std::clamp<int64_t>(outputs.speeds().low, 1, kTopSpeed + 1));
    const auto high = static_cast<int32_t>(std::clamp<int64_t>(outputs.speeds().high, 0, kTopSpeed));
    return reversing ? Speeds{-high, -low} : Speeds{low, high};
  }
  [[gnu::always_inline]] bool holds_current() const {
    return drive_.state_.outputs.holds_current(axis_.power().output_current(), axis_.power().gives_all());
  }
  // The speed is another one than the one that was told.
  [[gnu::always_inline]] bool holds_limited(int32_t told) const {
    const Outputs& outputs = drive_.state_.outputs;
    return !axis_.standing() && outputs.holds_speed(axis_.speed()) && outputs.holds_deviation(int64_t{axis_.speed()} - told);
  }

  Drive& drive_;
  Axis::Following axis_;
  Speeds speeds_;
  bool counts_;  // the next tick counts how long the torque has been at its limit
};

}  // namespace ipos::runtime
