// Milliseconds in a row of an axis that moves and goes as it is told, in one direction: Axis::step() with orders that differ in their
// target alone. What is the same in all of them is found once, and what only a reader needs is shown at the end. The arithmetic
// is that of every step.
#pragma once

#include "runtime/motion/axis_steps.hpp"

namespace ipos::runtime {

class Axis::Following {
 public:
  static bool possible(const Axis& axis, const AxisOrder& order) {
    return !axis.detailed_ && !axis.machine_.driven && order.command == AxisCommand::Follow &&
           axis.state_.phase == AxisPhase::Moving &&
           axis.power_.drives(order.current_limit, order.standstill_current);
  }

  // All targets have the sign of `direction`.
  [[gnu::always_inline]] Following(Axis& axis, const AxisOrder& order, int direction)
      : axis_(axis),
        resistance_(axis.resistance(order, false)),
        against_(resistance_.against(direction)),
        torque_limit_(axis.power_.torque_limit(order.current_limit)),
        torque_(axis.power_.torque()) {
    axis.catch_up();
  }

  // What the next step will be: its torque, and the currents of that. True: they are other ones than those of the last step. Either go()
  // or give_back() follows.
  [[gnu::always_inline]] bool aim(int32_t target) {
    speed_ = target * kFine;
    shown_ = target;
    limited_ = false;
    int64_t torque = axis_.shaft_.torque_for(axis_.speed_, speed_, against_);
    if (torque < -torque_limit_ || torque_limit_ < torque) torque = limit(torque);
    if (torque == axis_.power_.torque()) return false;
    give(torque);
    return true;
  }
  // Whether the torque does not reach its target; and its speed.
  bool limited() const { return limited_; }
  int32_t speed() const { return shown_; }
  bool standing() const { return speed_ == 0; }
  // It is not made: the currents are those of the last step again.
  [[gnu::always_inline]] void give_back() {
    if (axis_.power_.torque() != torque_) axis_.power_.give(torque_);
  }
  // Makes it.
  [[gnu::always_inline]] void go() {
    axis_.count_position((axis_.speed_ + speed_) * axis_steps::kIncrementShare);
    axis_.speed_ = speed_;
    torque_ = axis_.power_.torque();
    axis_.power_.draw_at(shown_);
    axis_.state_.current_limited = limited_;
    if (limited_) show_torque();
    ++cold_;
  }
  // Shows what the steps have left, the last of which had this target.
  [[gnu::always_inline]] void finish(int32_t target) {
    warm();
    axis_.ramp_.set(target * kFine);
    AxisState& state = axis_.state_;
    state.standing = axis_.speed_ == 0;
    state.ramping = false;
    state.setpoint = target;
    state.position = position();
    state.output_current = axis_.power_.output_current();
    show_torque();
    axis_.power_.show_speed(state.speed);
    axis_.power_shown_ = false;
  }

  int32_t position() const { return static_cast<int32_t>(axis_.position_); }
  const PowerSection& power() const { return axis_.power_; }  // but for what is warm

 private:
  [[gnu::always_inline]] int64_t limit(int64_t torque) {
    const Resistance resistance = resistance_;  // a copy, so that this object may lie in registers
    const Motion motion = axis_.shaft_.limited(axis_.speed_, speed_, torque, torque_limit_, resistance);
    speed_ = motion.speed;
    shown_ = whole_speed(speed_);
    limited_ = true;
    return motion.torque;
  }
  [[gnu::always_inline]] void show_torque() {
    axis_.state_.speed = whole_speed(axis_.speed_);
    axis_.state_.torque = static_cast<int32_t>(axis_.power_.torque());
  }
  [[gnu::always_inline]] void give(int64_t torque) {
    warm();
    axis_.power_.give(torque);
  }
  [[gnu::always_inline]] void warm() {
    if (cold_ != 0) axis_.power_.warm(cold_);
    cold_ = 0;
  }

  Axis& axis_;
  Resistance resistance_;
  int64_t against_;
  int64_t torque_limit_;
  int64_t torque_;  // of the last step
  FineSpeed speed_ = 0;
  int32_t shown_ = 0;  // the same, in 1/1000 rpm
  bool limited_ = false;
  Ticks cold_ = 0;  // steps with the present torque that have warmed nothing yet
};

}  // namespace ipos::runtime
