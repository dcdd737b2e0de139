// Motor potentiometer, PI controller, setpoint filter.
#include "runtime/drive/setpoint_memory.hpp"

#include <algorithm>

namespace ipos::runtime {

int32_t MotorPotentiometer::step(int32_t span, int32_t time_ms) {
  if (time_ms <= 0) return span;
  remainder_ += span;
  const int64_t step = remainder_ / time_ms;
  remainder_ %= time_ms;
  return static_cast<int32_t>(step);
}

// Both orders at once, like none, hold the value (M07-CW-19).
void MotorPotentiometer::tick(const Order& order) {
  if (order.up != order.down)
    value_ += order.up ? step(order.span, order.up_ms) : -step(order.span, order.down_ms);
  else
    remainder_ = 0;
  value_ = std::clamp(value_, std::min(order.minimum, order.maximum), order.maximum);
}

int32_t PiController::tick(const Order& order) {
  constexpr int64_t kFull = 100'000;
  const int64_t deviation = (int64_t{order.setpoint} - order.actual) * (order.inverted ? -1 : 1);
  if (order.time_s > 0 && order.gain > 0) {
    const int64_t whole = kFull * order.time_s * 1000 / order.gain;  // integral that alone gives 100 %
    integral_ = std::clamp<int64_t>(integral_ + deviation, 0, whole);
  } else {
    integral_ = 0;
  }
  const int64_t share = order.time_s > 0 ? integral_ / (int64_t{order.time_s} * 1000) : 0;
  return static_cast<int32_t>(std::clamp<int64_t>(order.gain * (deviation + share), 0, kFull));
}

int32_t SetpointFilter::tick(int32_t input, int32_t time_us) {
  constexpr int64_t kUnit = 65536;
  constexpr int64_t kTick = 1000;  // us
  const int64_t target = int64_t{input} * kUnit;
  state_ = time_us <= 0 ? target : state_ + (target - state_) * kTick / (kTick + time_us);
  const int64_t rounded = (state_ + (state_ >= 0 ? kUnit / 2 : -kUnit / 2)) / kUnit;
  return static_cast<int32_t>(rounded);
}

}  // namespace ipos::runtime
