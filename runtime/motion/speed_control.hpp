// Speed control with encoder: a controller with a proportional and an integral part (P200, P201), the inertia of the shaft
// and a filter of the speed that is measured (P204). Together they are a linear system of second or third order; it is
// advanced by its exponential, so that a step is the closed form whatever the gains are. What the setpoint's change needs is
// given beforehand (P202, through the filter P203), and so is what a load needs at the start (P205). P200 = 1 gives rated
// torque for 2 % of the rated speed, P202 = 1 what the inertia needs (ours; no manual read has the scales).
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
  // The motor is off; a hoist remembers its torque, any other drive begins with this one.
  void rest(bool remember, int64_t torque) {
    if (!remember) held_ = static_cast<double>(torque);
    began_ = false;
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
  struct Matrix3 {
    double at[3][3];
    bool operator==(const Matrix3& other) const;
  };
  struct Place {  // held: gain x (torque of the integral part - resistance)
    double speed, measured, held;
  };
  static Matrix3 times(const Matrix3& l, const Matrix3& r);
  void find(double gain, const ControlOrder& order);
  void find_filtered(double gain, double time_ms);
  void begin(FineSpeed speed, FineSpeed setpoint);
  double give_beforehand(double gain, FineSpeed setpoint, const ControlOrder& order);
  Place after(const Place& before, double goal) const;
  void measure(FineSpeed before, FineSpeed after);

  double per_gain_;   // torque for a FineSpeed of 1 with P200 = 1
  double held_ = 0;   // torque of the integral part
  int32_t gain_ = 0, time_us_ = 0, filter_us_ = 0, precontrol_us_ = 0;  // found for these
  double proportional_ = 0, integral_ = 0;  // torque for a FineSpeed, and that a millisecond
  Matrix way_{1, 0, 0, 1};  // of (speed - setpoint, gain x (held - resistance)) in a millisecond
  Matrix3 filtered_way_{};  // of (speed - setpoint, measured speed - setpoint, the same), with P204
  double left_ = 0, precontrol_left_ = 0;  // of a difference after a millisecond: P204, P203
  bool began_ = false;
  double measured_ = 0;          // the speed that the controller sees, with P204
  FineSpeed last_setpoint_ = 0;  // of the millisecond before
  double beforehand_ = 0;        // torque, as it comes out of P203
};

}  // namespace ipos::runtime
