// The mechanics: one shaft with inertia, static load and dry friction. Torques in 1/1000 % of the rated
// torque. A shaft that is driven from outside has its speed from there, and the motor gives a torque.
#pragma once

#include <cstdint>

#include "runtime/motion/fine_speed.hpp"
#include "runtime/motion/machine_data.hpp"

namespace ipos::runtime {

// What acts on the shaft besides the motor.
struct Resistance {
  int64_t load;      // positive pulls counter-clockwise
  int64_t friction;  // against the motion, brake included
  int64_t against(int direction) const { return load + direction * friction; }
};

struct Motion {
  FineSpeed speed;
  int64_t torque;  // of the motor
  bool limited;    // the torque was not enough for the setpoint
};

class Shaft {
 public:
  explicit Shaft(const MachineData& machine);  // within_limits

  // Speed after one millisecond of this motor torque.
  FineSpeed free(FineSpeed speed, int64_t torque, const Resistance& resistance) const;

  // What takes it to the setpoint within one millisecond, against what acts on it in the direction of its motion.
  int64_t torque_for(FineSpeed speed, FineSpeed setpoint, int64_t against) const { return (setpoint - speed) / gain_ + against; }
  // The motor drives the shaft to the setpoint within one millisecond, as far as its torque reaches.
  Motion driven(FineSpeed speed, FineSpeed setpoint, int64_t torque_limit,
                const Resistance& resistance) const {
    const int64_t needed = torque_for(speed, setpoint, resistance.against(sign_of(setpoint != 0 ? setpoint : speed)));
    if (-torque_limit <= needed && needed <= torque_limit) return {setpoint, needed, false};
    return limited(speed, setpoint, needed, torque_limit, resistance);
  }

  // The motor gives this torque, as far as its limit allows. Beyond the speed limit it gives what holds that.
  Motion turned(FineSpeed speed, int64_t torque, FineSpeed speed_limit, int64_t torque_limit,
                const Resistance& resistance) const;

  // Speed after a millisecond in which the motor pulls with `stiffness` (torque for a speed of 1) towards the speed
  // `field`. The exponential of it is followed, not its tangent: any stiffness is stable.
  FineSpeed pulled(FineSpeed speed, double field, double stiffness, const Resistance& resistance) const;
  // The mean torque of the motor in a millisecond that brought the shaft from one speed to the other.
  int64_t torque_between(FineSpeed before, FineSpeed after, const Resistance& resistance) const;
  double gain() const { return static_cast<double>(gain_); }

  // Driven from outside: the torque that takes the inertia of this shaft to the setpoint, by a controller with a
  // proportional and an integral part. It is soft enough for a partner that answers a millisecond later.
  Motion controlled(FineSpeed speed, FineSpeed setpoint, int64_t torque_limit);
  void forget_control() { held_ = 0; }
  // The motor gives what it can of a torque that it cannot give.
  Motion limited(FineSpeed speed, FineSpeed setpoint, int64_t needed, int64_t torque_limit,
                 const Resistance& resistance) const;
  bool operator==(const Shaft&) const = default;

 private:

  int64_t gain_;      // change of speed in one millisecond by a torque of 1
  int64_t held_ = 0;  // the integral part of controlled()
};

}  // namespace ipos::runtime
