// Two masses and a spring, in so many parts of a millisecond as the spring needs.
#include "runtime/motion/second_mass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ipos::runtime {

SecondMass::SecondMass(const MachineData& machine) {
  if (machine.second_inertia == 0) return;
  constexpr double kRadian = 2 * std::numbers::pi / 60 / 1'000 / static_cast<double>(kFine);  // a FineSpeed, rad/s
  constexpr double kMillisecond = 1e-3;
  const double unit = rated_torque(machine) / 100'000;  // Nm of a torque of 1
  gain_ = unit / machine.second_inertia * kMillisecond / kRadian;
  stiffness_ = machine.stiffness * kRadian * kMillisecond / unit;
  damping_ = machine.damping * kRadian / unit;
  play_ = machine.backlash / 2 / (kRadian * kMillisecond);
  // Stiffer than 40 rad a millisecond, or damped more than that, counts as so much: beyond it a millisecond has too few parts.
  constexpr double kQuickest = 40;
  const double gains = gain_ + Shaft(machine).gain();
  stiffness_ = std::min(stiffness_, kQuickest * kQuickest / gains);
  damping_ = std::min(damping_, kQuickest / gains);
  const double quick = std::max(std::sqrt(stiffness_ * gains), damping_ * gains);
  parts_ = static_cast<int32_t>(std::clamp(quick * 8 + 1, 1.0, 64.0));
}

double SecondMass::torque(double motor) const {
  if (std::abs(twist_) <= play_) return 0;
  return stiffness_ * (twist_ - (twist_ < 0 ? -play_ : play_)) + damping_ * (motor - speed_);
}

double SecondMass::torque(FineSpeed motor) const {
  constexpr double kMost = kTopTorque;
  return std::clamp(torque(static_cast<double>(motor)), -kMost, kMost);
}

FineSpeed SecondMass::step(FineSpeed motor, double torque, double friction, double load, double gain) {
  auto speed = static_cast<double>(motor);
  const double part = 1.0 / parts_;
  for (int32_t n = 0; n < parts_; ++n) {
    const double spring = this->torque(speed);
    const double force = torque - spring;
    const bool holds = std::abs(force) <= friction;
    if (!(speed == 0 && holds)) {
      const double direction = speed != 0 ? (speed < 0 ? -1 : 1) : force < 0 ? -1 : 1;
      const double next = speed + gain * part * (force - direction * friction);
      speed = holds && next * direction < 0 ? 0 : next;
    }
    speed_ += gain_ * part * (spring - load);
    twist_ += part * (speed - speed_);
  }
  speed_ = std::clamp(speed_, -static_cast<double>(kTopFine), static_cast<double>(kTopFine));
  return fine_of(speed);
}

}  // namespace ipos::runtime
