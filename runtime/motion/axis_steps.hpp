// The steps of a tick that the plain way of an axis (axis.cpp) and that in detail (axis_in_detail.cpp) share.
#pragma once

#include <algorithm>
#include <cstdlib>

#include "runtime/motion/axis.hpp"

namespace ipos::runtime {
namespace axis_steps {

// 4096 increments a turn: speed in 1/1000 rpm x 4096 / 60000000 increments a millisecond. With twice the mean
// speed the fraction is 8 / 234375.
inline constexpr int64_t kIncrementShare = 8;
inline constexpr int64_t kIncrement = 234'375 * kFine;

// A shaft that something outside turns is never quite at 0: the brake may fall in below this (ours).
inline constexpr FineSpeed kNearlyStanding = 1'000 * kFine;
// Nor is one that is controlled by its encoder (ours).
inline constexpr FineSpeed kRealStanding = 5'000 * kFine;

constexpr Supply supply_of(AxisPhase phase) {
  constexpr Supply kSupplies[] = {Supply::Off,     Supply::Magnetizing, Supply::Driving,
                                  Supply::Driving, Supply::Driving,     Supply::DirectCurrent};
  return kSupplies[static_cast<size_t>(phase)];
}

}  // namespace axis_steps

inline FineSpeed Axis::target_of(const AxisOrder& order) {
  const bool moves = order.command == AxisCommand::Run || order.command == AxisCommand::Follow;
  return moves ? fine_speed(order.target) : 0;
}

// The motor is magnetized and follows the setpoint.
inline bool Axis::has_torque(AxisPhase phase) {
  return phase == AxisPhase::Releasing || phase == AxisPhase::Moving || phase == AxisPhase::Applying;
}

inline bool Axis::brake_open() const {
  return sequence_.phase() == AxisPhase::Releasing || sequence_.phase() == AxisPhase::Moving;
}

// Without encoder the drive knows only its own setpoint.
inline bool Axis::has_stopped(const AxisOrder& order) const {
  if (ramp_.output() != 0) return false;
  if (machine_.driven) return std::abs(speed_) <= axis_steps::kNearlyStanding;
  if (!machine_.real) return speed_ == 0;
  const bool blind = !order.control.encoder && !order.control.dc_braking;
  return blind || std::abs(speed_) <= axis_steps::kRealStanding;
}

inline void Axis::advance_sequence(const AxisOrder& order) {
  BrakeTimes times{order.premagnetize_ms, order.brake_release_ms, order.brake_apply_ms};
  if (!order.brake_function) times.release = times.apply = 0;
  switch (order.command) {
    case AxisCommand::Inhibit: return sequence_.inhibit();
    case AxisCommand::Stop: return sequence_.stop(times, has_stopped(order), order.standstill_current > 0);
    case AxisCommand::HoldZero:
    case AxisCommand::Run:
    case AxisCommand::Follow:
    case AxisCommand::Torque: return sequence_.enable(times);
  }
}

inline void Axis::advance_setpoint(const AxisOrder& order) {
  // A motor that still turns when its torque comes back is caught at its speed (ours).
  if (!has_torque(state_.phase)) ramp_.set(speed_);
  if (sequence_.phase() != AxisPhase::Moving) return;
  if (order.command >= AxisCommand::Follow)
    return ramp_.set(order.command == AxisCommand::Follow ? target_of(order) : speed_);
  // At the current limit the ramp waits for the shaft, or a stop would begin with more speed (ours).
  if (state_.current_limited) ramp_.wait_at(speed_);
  if (order.command == AxisCommand::Run) return ramp_.step(target_of(order), order.ramp);
  const uint32_t ms = order.stop_ramp_ms;
  ramp_.step(0, {ms, ms, ms, ms, 0});
}

inline Resistance Axis::resistance(const AxisOrder& order, bool brake_acts) const {
  return {machine_.load_torque + std::clamp(order.load_torque, -kTopTorque, kTopTorque),
          machine_.friction + (brake_acts ? machine_.brake_torque : 0)};
}

inline void Axis::count_position(int64_t way) {
  position_rest_ += way;
  int64_t increments = position_rest_ / axis_steps::kIncrement;
  position_rest_ %= axis_steps::kIncrement;
  if (position_rest_ < 0) {  // the counter rounds down in both directions
    position_rest_ += axis_steps::kIncrement;
    --increments;
  }
  position_ += static_cast<uint32_t>(increments);
}

// The power section follows the shaft; what nobody looks at every millisecond is shown when somebody asks.
[[gnu::always_inline]] inline void Axis::move(const AxisOrder& order, Supply supply, const Motion& motion) {
  count_position((speed_ + motion.speed) * axis_steps::kIncrementShare);
  speed_ = motion.speed;
  state_.standing = speed_ == 0;
  state_.current_limited = motion.limited;
  state_.speed = whole_speed(speed_);
  state_.position = static_cast<int32_t>(position_);
  state_.torque = static_cast<int32_t>(motion.torque);
  power_.step({supply, state_.speed, motion.torque, order.current_limit, order.standstill_current});
  state_.output_current = power_.output_current();
  power_shown_ = false;
}

}  // namespace ipos::runtime
