// Slip from torque, flux from voltage.
#include "runtime/motion/voltage_control.hpp"

#include <algorithm>
#include <cmath>

namespace ipos::runtime {
namespace {

constexpr double kRated = 100'000;      // torque
constexpr double kFollow = 1.0 / 20;    // of the torque that the slip compensation sees, a millisecond (ours)
constexpr double kLeastFlux = 0.05, kLeastFrequency = 0.02;  // of the rated ones
constexpr double kSlipOfOvercurrent = 2;  // times that of breakdown, at once: no limiter is as quick (ours)

}  // namespace

VoltageControl::VoltageControl(const MachineData& machine)
    : synchronous_(static_cast<double>(fine_speed(machine.rated_speed))),
      breakdown_(machine.breakdown_torque),
      drop_(machine.stator_drop / kRated),
      magnetizing_drop_(drop_ * machine.magnetizing_current / machine.rated_active_current) {
  const double ratio = breakdown_ / kRated;
  slip_ = static_cast<double>(fine_speed(std::max(1, machine.rated_slip))) * (ratio + std::sqrt(ratio * ratio - 1));
}

double VoltageControl::flux_for(double torque, const ControlOrder& order) const {
  const double frequency = std::abs(field_) / synchronous_;
  if (order.adjusted) return frequency > 1 ? std::max(1 / frequency, kLeastFlux) : 1;
  // The voltage goes up with the frequency to the rated one. What the resistance takes and P321 and P322 do not give is missing.
  const double active = std::abs(torque) / kRated / flux_ * ((torque < 0) == (field_ < 0) ? 1 : -1);
  const double missing =
      magnetizing_drop_ * (1 - order.boost / kRated) + drop_ * active * (1 - order.ixr / kRated);
  const double voltage = std::min(std::min(frequency, 1.0) - missing, 1.0);
  return std::clamp(voltage / std::max(frequency, kLeastFrequency), kLeastFlux, 1.0);
}

Motion VoltageControl::pull(const Shaft& shaft, FineSpeed speed, double limit, const Resistance& resistance) {
  const double share = (field_ - static_cast<double>(speed)) / slip_;
  const double stiffness = 2 * breakdown_ * flux_ * flux_ / slip_ / (1 + share * share);
  const FineSpeed next = shaft.pulled(speed, field_, stiffness, resistance);
  const double torque = speed == 0 && next == 0 ? stiffness * field_
                                                : static_cast<double>(shaft.torque_between(speed, next, resistance));
  return {next, static_cast<int64_t>(std::clamp(torque, -limit, limit)), false};
}

Motion VoltageControl::step(const Shaft& shaft, FineSpeed speed, FineSpeed setpoint, int64_t torque_limit,
                            const ControlOrder& order, const Resistance& resistance) {
  const double most = breakdown_ * flux_ * flux_;
  const double limit = std::clamp(static_cast<double>(torque_limit), 0.0, most);
  const double ratio = most / std::max(limit, 1.0);
  const double most_slip = slip_ * (ratio - std::sqrt(ratio * ratio - 1));

  field_ = static_cast<double>(setpoint) + static_cast<double>(fine_speed(order.slip_compensation)) * load_ / kRated;
  const double slip = field_ - static_cast<double>(speed);
  overcurrent_ = !limited_ && std::abs(slip) > kSlipOfOvercurrent * slip_;
  limited_ = std::abs(slip) > most_slip;
  Motion motion;
  if (limited_) {
    const double sign = slip < 0 ? -1 : 1;
    field_ = static_cast<double>(speed) + sign * most_slip;
    const auto torque = static_cast<int64_t>(sign * limit);
    motion = {shaft.free(speed, torque, resistance), torque, true};
  } else {
    motion = pull(shaft, speed, limit, resistance);
  }
  const auto torque = static_cast<double>(motion.torque);
  load_ += (torque - load_) * kFollow;
  flux_ = flux_for(torque, order);
  return motion;
}

Motion VoltageControl::stand(const Shaft& shaft, FineSpeed speed, const Resistance& resistance) {
  field_ = 0;
  flux_ = 1;
  limited_ = overcurrent_ = false;
  return pull(shaft, speed, breakdown_, resistance);
}

}  // namespace ipos::runtime
