// The parts of the setpoint that have a memory: motor potentiometer, PI controller, filter of the analog
// input. One call a millisecond each; integer arithmetic with remainders, so nothing drifts.
#pragma once

#include <cstdint>

namespace ipos::runtime {

// Rises and falls on ramp t3 between the speed limits (P150, P151). The value is a magnitude in 1/1000 rpm.
class MotorPotentiometer {
 public:
  struct Order {
    bool up = false;
    bool down = false;
    int32_t minimum = 0;
    int32_t maximum = 0;
    int32_t up_ms = 0;  // for `span`
    int32_t down_ms = 0;
    int32_t span = 0;  // speed the ramp times refer to
  };
  void tick(const Order& order);
  void set(int32_t value) { value_ = value; }
  int32_t value() const { return value_; }
  bool operator==(const MotorPotentiometer&) const = default;

 private:
  int32_t step(int32_t span, int32_t time_ms);
  int32_t value_ = 0;
  int64_t remainder_ = 0;
};

// P250..P255 of MOVITRAC 07. Setpoint, actual value and output in 1/1000 %; the output is 0..100 %. How gain
// and integral time make the output is ours: gain x (deviation + integral / time).
class PiController {
 public:
  struct Order {
    int32_t setpoint = 0;
    int32_t actual = 0;
    bool inverted = false;
    int32_t gain = 1;
    int32_t time_s = 1;  // 0: no integral part
  };
  int32_t tick(const Order& order);
  void reset() { integral_ = 0; }
  bool operator==(const PiController&) const = default;

 private:
  int64_t integral_ = 0;  // 1/1000 % x ms
};

// First-order filter P115 of the analog setpoint; time constant in microseconds.
class SetpointFilter {
 public:
  int32_t tick(int32_t input, int32_t time_us);
  bool operator==(const SetpointFilter&) const = default;

 private:
  int64_t state_ = 0;  // x 65536
};

}  // namespace ipos::runtime
