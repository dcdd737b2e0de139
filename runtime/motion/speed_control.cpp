// The exponential of the loop, and where limit and friction bend it.
#include "runtime/motion/speed_control.hpp"

#include <algorithm>
#include <cmath>

namespace ipos::runtime {

// By scaling and squaring, with the first terms of the series.
void SpeedControl::find(double gain, const ControlOrder& order) {
  gain_ = order.gain;
  time_us_ = order.time_us;
  constexpr int32_t kMostGain = 100'000, kMostTime = 10'000'000;  // beyond P200 and P201
  proportional_ = per_gain_ * std::clamp(order.gain, 0, kMostGain) / 1'000;
  integral_ = order.time_us <= 0 ? 0 : proportional_ * 1'000 / std::min(order.time_us, kMostTime);
  constexpr int kHalvings = 20;
  constexpr double kPart = 1.0 / (1 << kHalvings);
  const Matrix small{-gain * proportional_ * kPart, kPart, -gain * integral_ * kPart, 0};
  const Matrix square = times(small, small);
  way_ = {1 + small.a + square.a / 2, small.b + square.b / 2, small.c + square.c / 2, 1 + small.d + square.d / 2};
  for (int n = 0; n < kHalvings; ++n) way_ = times(way_, way_);
}

Motion SpeedControl::step(const Shaft& shaft, FineSpeed speed, FineSpeed setpoint, int64_t torque_limit,
                          const ControlOrder& order, const Resistance& resistance) {
  const double gain = shaft.gain();
  if (gain_ != order.gain || time_us_ != order.time_us) find(gain, order);
  const auto limit = static_cast<double>(torque_limit);
  const double deviation = static_cast<double>(setpoint) - static_cast<double>(speed);
  const double wanted = proportional_ * deviation + held_;  // at the beginning
  const double force = wanted - static_cast<double>(resistance.load);
  const bool sticks = std::abs(force) <= static_cast<double>(resistance.friction);
  if (speed == 0 && sticks) {
    held_ = std::clamp(held_ + integral_ * deviation, -limit, limit);
    const double torque = std::clamp(wanted, -limit, limit);
    return {0, static_cast<int64_t>(torque), std::abs(wanted) > limit};
  }
  const int direction = speed != 0 ? sign_of(speed) : force < 0 ? -1 : 1;
  const double against = static_cast<double>(resistance.load + direction * resistance.friction);
  const double held = gain * (held_ - against);
  const FineSpeed next = fine_of(static_cast<double>(setpoint) - way_.a * deviation + way_.b * held);
  const int64_t torque = shaft.torque_between(speed, next, resistance);
  if (-torque_limit <= torque && torque <= torque_limit) {
    held_ = std::clamp(against + (-way_.c * deviation + way_.d * held) / gain, -limit, limit);
    const bool stops = sticks && sign_of(next) != direction;
    return {stops ? 0 : next, torque, false};
  }
  const int64_t given = torque < 0 ? -torque_limit : torque_limit;
  const FineSpeed reached = shaft.free(speed, given, resistance);
  // The integral part goes on from where both parts together give the limit.
  const double left = static_cast<double>(setpoint) - static_cast<double>(reached);
  held_ = std::clamp(static_cast<double>(given) - proportional_ * left, -limit, limit);
  return {reached, given, true};
}

}  // namespace ipos::runtime
