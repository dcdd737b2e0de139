// Torque to speed and back.
#include "runtime/motion/shaft.hpp"

#include <algorithm>
#include <cstdlib>

namespace ipos::runtime {
namespace {

// Of a shaft that is driven from outside (ours): the inertia told reaches the setpoint with this time constant, which
// leaves a quarter of the gain at which a delay of a millisecond would oscillate; and the time of the integral part.
constexpr int64_t kReachMs = 4, kHoldMs = 16;

}  // namespace

Shaft::Shaft(const MachineData& machine) {
  // Rated torque (100000) brings the shaft to rated speed within rotor x factor / 100 ms.
  const int64_t factor = 100 + int64_t{machine.inertia};
  const int64_t run_up = machine.run_up_us != 0 ? int64_t{machine.run_up_us} * 100 : machine.rotor_run_up_ms * factor * 1'000;
  gain_ = std::max<int64_t>(1, machine.rated_speed * kFine / run_up);
}

FineSpeed Shaft::pulled(FineSpeed speed, double field, double stiffness, const Resistance& resistance) const {
  const auto gain = static_cast<double>(gain_);
  const auto load = static_cast<double>(resistance.load), friction = static_cast<double>(resistance.friction);
  const double force = stiffness * field - load;  // at standstill
  const bool holds = std::abs(force) <= friction;
  if (speed == 0 && holds) return 0;
  const int direction = speed != 0 ? sign_of(speed) : force < 0 ? -1 : 1;
  const double end = field - (load + direction * friction) / stiffness;
  // e^-x by the first terms of its series for e^x: exact to a third of a percent up to x = 0.5, and never unstable.
  const double x = gain * stiffness;
  const double rest = 1 / (1 + x * (1 + x * (0.5 + x / 6)));
  const double next = end + (static_cast<double>(speed) - end) * rest;
  const FineSpeed whole = fine_of(next);
  if (holds && sign_of(whole) != direction) return 0;
  return whole;
}

int64_t Shaft::torque_between(FineSpeed before, FineSpeed after, const Resistance& resistance) const {
  return torque_for(before, after, resistance.against(sign_of(before != 0 ? before : after)));
}

FineSpeed Shaft::free(FineSpeed speed, int64_t torque, const Resistance& resistance) const {
  const int64_t force = torque - resistance.load;
  const bool holds = std::abs(force) <= resistance.friction;
  if (speed == 0 && holds) return 0;
  const int direction = sign_of(speed != 0 ? speed : force);
  const FineSpeed next = speed + (force - direction * resistance.friction) * gain_;
  if (holds && sign_of(next) != sign_of(speed)) return 0;
  return std::clamp(next, -kTopFine, kTopFine);
}

Motion Shaft::turned(FineSpeed speed, int64_t torque, FineSpeed speed_limit, int64_t torque_limit,
                     const Resistance& resistance) const {
  const int64_t given = std::clamp(torque, -torque_limit, torque_limit);
  const FineSpeed next = free(speed, given, resistance);
  const FineSpeed most = std::max<FineSpeed>(speed_limit, 0);
  if (-most <= next && next <= most) return {next, given, false};
  return driven(speed, next > 0 ? most : -most, torque_limit, resistance);
}

Motion Shaft::controlled(FineSpeed speed, FineSpeed setpoint, int64_t torque_limit) {
  const int64_t towards = (setpoint - speed) / (gain_ * kReachMs);
  const int64_t wanted = towards + held_;
  if (wanted < -torque_limit || torque_limit < wanted) return {speed, sign_of(wanted) * torque_limit, true};
  held_ = std::clamp(held_ + towards / kHoldMs, -torque_limit, torque_limit);
  return {speed, wanted, false};
}

Motion Shaft::limited(FineSpeed speed, FineSpeed setpoint, int64_t needed, int64_t torque_limit,
                      const Resistance& resistance) const {
  const int64_t torque = sign_of(needed) * torque_limit;
  const FineSpeed reached = free(speed, torque, resistance);
  // Friction that helps while a reversal passes zero must not carry it past the setpoint.
  return {needed > 0 ? std::min(reached, std::max(setpoint, speed))
                     : std::max(reached, std::min(setpoint, speed)),
          torque, true};
}

}  // namespace ipos::runtime
