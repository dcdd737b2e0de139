// Speed control with encoder: a controller with a proportional and an integral part (P200, P201) and the inertia of the
// shaft. Both together are a linear system of second order; it is advanced by its exponential, so that a step is the closed
// form whatever the gains are. P200 = 1 gives rated torque for 2 % of the rated speed (ours; no manual read has the scale).
// Doubles, with the four operations only: each build gives the same.
#pragma once

#include <cstdint>

#include "runtime/motion/control_order.hpp"
#include "runtime/motion/shaft.hpp"

namespace ipos::runtime {

class SpeedControl {
 public:
  explicit SpeedControl(const MachineData& machine)  // within_limits
      : per_gain_(100'000 / (0.02 * static_cast<double>(fine_speed(machine.rated_speed)))) {}

  Motion step(const Shaft& shaft, FineSpeed speed, FineSpeed setpoint, int64_t torque_limit, const ControlOrder& order,
              const Resistance& resistance);
  // The motor is off; a hoist remembers its torque.
  void rest(bool remember) {
    if (!remember) held_ = 0;
  }
  bool operator==(const SpeedControl&) const = default;

 private:
  struct Matrix {
    double a, b, c, d;
    bool operator==(const Matrix&) const = default;
  };
  static Matrix times(const Matrix& l, const Matrix& r) {
    return {l.a * r.a + l.b * r.c, l.a * r.b + l.b * r.d, l.c * r.a + l.d * r.c, l.c * r.b + l.d * r.d};
  }
  void find(double gain, const ControlOrder& order);

  double per_gain_;   // torque for a FineSpeed of 1 with P200 = 1
  double held_ = 0;   // torque of the integral part
  int32_t gain_ = 0, time_us_ = 0;  // found for these
  double proportional_ = 0, integral_ = 0;  // torque for a FineSpeed, and that a millisecond
  Matrix way_{1, 0, 0, 1};  // of (speed - setpoint, gain x (held - resistance)) in a millisecond
};

}  // namespace ipos::runtime
