// A motor fed with voltage and frequency, without encoder (VFC): the shaft follows the field with the slip that its torque
// needs. Torque over slip is Kloss's curve through rated and breakdown torque; above the rated frequency, and with too
// little voltage for the stator's resistance, the flux gets less. The current limit holds the slip back.
// Doubles, with the four operations and the root only: each build gives the same.
#pragma once

#include <cstdint>

#include "runtime/motion/control_order.hpp"
#include "runtime/motion/shaft.hpp"

namespace ipos::runtime {

class VoltageControl {
 public:
  explicit VoltageControl(const MachineData& machine);  // within_limits

  Motion step(const Shaft& shaft, FineSpeed speed, FineSpeed setpoint, int64_t torque_limit, const ControlOrder& order,
              const Resistance& resistance);
  // Direct current in the motor: the field stands.
  Motion stand(const Shaft& shaft, FineSpeed speed, const Resistance& resistance);
  // The motor is off; a hoist remembers its torque.
  void rest(bool remember) {
    field_ = 0;
    limited_ = overcurrent_ = false;
    flux_ = 1;
    if (!remember) load_ = 0;
  }

  double field() const { return field_; }  // speed of the rotating field, as FineSpeed
  int32_t flux() const { return static_cast<int32_t>(flux_ * 1'000 + 0.5); }  // 1/1000
  bool overcurrent() const { return overcurrent_; }
  bool operator==(const VoltageControl&) const = default;

 private:
  Motion pull(const Shaft& shaft, FineSpeed speed, double limit, const Resistance& resistance);
  double flux_for(double torque, const ControlOrder& order) const;

  double synchronous_;  // at the rated frequency
  double slip_;         // at breakdown torque
  double breakdown_;
  double drop_, magnetizing_drop_;  // voltages at the stator's resistance, of the rated one
  double field_ = 0, load_ = 0, flux_ = 1;
  bool limited_ = false, overcurrent_ = false;
};

}  // namespace ipos::runtime
