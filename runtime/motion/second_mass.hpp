// A second mass behind a spring: what the motor drives over a shaft, a belt or a rope ([station.load.second]). The spring has
// a stiffness, a damping and a play within which it gives nothing. The static torque of the load acts on this mass.
// Doubles, with the four operations and the root only: each build gives the same.
#pragma once

#include <cstdint>

#include "runtime/motion/shaft.hpp"

namespace ipos::runtime {

class SecondMass {
 public:
  explicit SecondMass(const MachineData& machine);  // within_limits

  bool fitted() const { return parts_ != 0; }
  // What the spring asks of the motor's shaft.
  double torque(FineSpeed motor) const;
  // A millisecond: `motor` is the speed of the motor's shaft, on which `torque` acts beside the spring; returns it after.
  FineSpeed step(FineSpeed motor, double torque, double friction, double load, double gain);
  FineSpeed speed() const { return fine_of(speed_); }
  bool operator==(const SecondMass&) const = default;

 private:
  double torque(double motor) const;

  double gain_ = 0;       // of this mass, as Shaft's
  double stiffness_ = 0;  // torque for a FineSpeed x ms
  double damping_ = 0;    // torque for a FineSpeed
  double play_ = 0;       // half of it, FineSpeed x ms
  int32_t parts_ = 0;     // of a millisecond
  double speed_ = 0, twist_ = 0;
};

}  // namespace ipos::runtime
