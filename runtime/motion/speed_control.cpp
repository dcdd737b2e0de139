// The exponential of the loop, and where limit and friction bend it.
#include "runtime/motion/speed_control.hpp"

#include <algorithm>
#include <cmath>

namespace ipos::runtime {
namespace {

// An exponential is that of a small part of a millisecond, by the first terms of its series, squared so often.
constexpr int kHalvings = 20;
constexpr double kPart = 1.0 / (1 << kHalvings);

// What is left of a difference after a millisecond of a filter with this time constant.
double left_after(int32_t time_us) {
  if (time_us <= 0) return 0;
  const double part = kPart * 1'000 / time_us;
  double left = 1 - part + part * part / 2;
  for (int n = 0; n < kHalvings; ++n) left *= left;
  return left;
}

}  // namespace

bool SpeedControl::Matrix3::operator==(const Matrix3& other) const {
  for (int row = 0; row < 3; ++row)
    if (!std::equal(at[row], at[row] + 3, other.at[row])) return false;
  return true;
}

SpeedControl::Matrix3 SpeedControl::times(const Matrix3& l, const Matrix3& r) {
  Matrix3 product{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      product.at[row][column] =
          l.at[row][0] * r.at[0][column] + l.at[row][1] * r.at[1][column] + l.at[row][2] * r.at[2][column];
  return product;
}

// By scaling and squaring, with the first terms of the series.
void SpeedControl::find(double gain, const ControlOrder& order) {
  gain_ = order.gain;
  time_us_ = order.time_us;
  filter_us_ = order.filter_us;
  precontrol_us_ = order.precontrol_us;
  constexpr int32_t kMostGain = 100'000, kMostTime = 10'000'000;  // beyond P200 and P201
  proportional_ = per_gain_ * std::clamp(order.gain, 0, kMostGain) / 1'000;
  integral_ = order.time_us <= 0 ? 0 : proportional_ * 1'000 / std::min(order.time_us, kMostTime);
  left_ = left_after(filter_us_);
  precontrol_left_ = left_after(precontrol_us_);
  if (filter_us_ > 0) return find_filtered(gain, filter_us_ / 1e3);
  const Matrix small{-gain * proportional_ * kPart, kPart, -gain * integral_ * kPart, 0};
  const Matrix square = times(small, small);
  way_ = {1 + small.a + square.a / 2, small.b + square.b / 2, small.c + square.c / 2, 1 + small.d + square.d / 2};
  for (int n = 0; n < kHalvings; ++n) way_ = times(way_, way_);
}

void SpeedControl::find_filtered(double gain, double time_ms) {
  const Matrix3 small{{{0, -gain * proportional_ * kPart, kPart},
                       {kPart / time_ms, -kPart / time_ms, 0},
                       {0, -gain * integral_ * kPart, 0}}};
  filtered_way_ = times(small, small);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      filtered_way_.at[row][column] = filtered_way_.at[row][column] / 2 + small.at[row][column] + (row == column ? 1 : 0);
  for (int n = 0; n < kHalvings; ++n) filtered_way_ = times(filtered_way_, filtered_way_);
}

SpeedControl::Place SpeedControl::after(const Place& before, double goal) const {
  if (filter_us_ <= 0) {
    const double deviation = goal - before.speed;
    const double speed = goal - way_.a * deviation + way_.b * before.held;
    return {speed, speed, -way_.c * deviation + way_.d * before.held};
  }
  const double speed = before.speed - goal, measured = before.measured - goal;
  const auto row = [&](const double (&of)[3]) { return of[0] * speed + of[1] * measured + of[2] * before.held; };
  return {goal + row(filtered_way_.at[0]), goal + row(filtered_way_.at[1]), row(filtered_way_.at[2])};
}

void SpeedControl::begin(FineSpeed speed, FineSpeed setpoint) {
  began_ = true;
  measured_ = static_cast<double>(speed);
  last_setpoint_ = setpoint;
  beforehand_ = 0;
}

// The torque that takes the inertia along with the setpoint: what comes out of its filter in the mean of the millisecond.
double SpeedControl::give_beforehand(double gain, FineSpeed setpoint, const ControlOrder& order) {
  const double wanted = order.precontrol / 1e3 * static_cast<double>(setpoint - last_setpoint_) / gain;
  last_setpoint_ = setpoint;
  const double missing = beforehand_ - wanted;
  beforehand_ = wanted + missing * precontrol_left_;
  return precontrol_us_ <= 0 ? wanted : wanted + missing * (1 - precontrol_left_) * precontrol_us_ / 1e3;
}

// The filter while the shaft goes as limit or friction let it.
void SpeedControl::measure(FineSpeed before, FineSpeed after) {
  const double mean = (static_cast<double>(before) + static_cast<double>(after)) / 2;
  measured_ = mean + (measured_ - mean) * left_;
}

Motion SpeedControl::step(const Shaft& shaft, FineSpeed speed, FineSpeed setpoint, int64_t torque_limit,
                          const ControlOrder& order, const Resistance& resistance) {
  const double gain = shaft.gain();
  if (gain_ != order.gain || time_us_ != order.time_us || filter_us_ != order.filter_us || precontrol_us_ != order.precontrol_us)
    find(gain, order);
  if (!began_) begin(speed, setpoint);
  const double beforehand = give_beforehand(gain, setpoint, order);
  if (filter_us_ <= 0) measured_ = static_cast<double>(speed);
  const auto limit = static_cast<double>(torque_limit), goal = static_cast<double>(setpoint);
  const double deviation = goal - measured_;
  const double wanted = proportional_ * deviation + held_ + beforehand;  // at the beginning
  const double force = wanted - static_cast<double>(resistance.load);
  const bool sticks = std::abs(force) <= static_cast<double>(resistance.friction);
  if (speed == 0 && sticks) {
    held_ = std::clamp(held_ + integral_ * deviation, -limit, limit);
    measure(0, 0);
    const double torque = std::clamp(wanted, -limit, limit);
    return {0, static_cast<int64_t>(torque), std::abs(wanted) > limit};
  }
  const int direction = speed != 0 ? sign_of(speed) : force < 0 ? -1 : 1;
  const double against = static_cast<double>(resistance.load + direction * resistance.friction) - beforehand;
  const Place next = after({static_cast<double>(speed), measured_, gain * (held_ - against)}, goal);
  const FineSpeed reached = fine_of(next.speed);
  const int64_t torque = shaft.torque_between(speed, reached, resistance);
  if (-torque_limit <= torque && torque <= torque_limit) {
    held_ = std::clamp(against + next.held / gain, -limit, limit);
    measured_ = next.measured;
    const bool stops = sticks && sign_of(reached) != direction;
    return {stops ? 0 : reached, torque, false};
  }
  const int64_t given = torque < 0 ? -torque_limit : torque_limit;
  const FineSpeed limited = shaft.free(speed, given, resistance);
  // The integral part goes on from where all parts together give the limit.
  measure(speed, limited);
  const double left = goal - (filter_us_ > 0 ? measured_ : static_cast<double>(limited));
  held_ = std::clamp(static_cast<double>(given) - proportional_ * left - beforehand, -limit, limit);
  return {limited, given, true};
}

}  // namespace ipos::runtime
