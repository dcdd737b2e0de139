// The limits of the model, far around everything that exists.
#include "runtime/motion/machine_data.hpp"

#include <algorithm>
#include <numbers>

#include "runtime/motion/fine_speed.hpp"

namespace ipos::runtime {

MachineData within_limits(MachineData m) {
  const auto limit = [](int32_t& value, int32_t least, int32_t most) {
    value = std::clamp(value, least, most);
  };
  limit(m.ramp_reference, 1, kTopSpeed);
  limit(m.rated_speed, 1'000, 10'000'000);
  limit(m.rated_slip, 0, m.rated_speed);
  limit(m.pole_pairs, 1, 50);
  limit(m.rated_power, 1, 1'000'000);
  limit(m.rated_active_current, 1'000, kTopCurrent);
  limit(m.magnetizing_current, 0, kTopCurrent);
  limit(m.rotor_run_up_ms, 1, 100'000);
  limit(m.motor_heat_time_ms, 1, 10'000'000);
  limit(m.breakdown_torque, 110'000, kTopTorque);
  limit(m.stator_drop, 0, 50'000);
  limit(m.inertia, 0, 100'000);
  limit(m.friction, 0, kTopTorque);
  limit(m.load_torque, -kTopTorque, kTopTorque);
  limit(m.load_turns, -1'000'000, 1'000'000);
  if (m.run_up_us != 0) limit(m.run_up_us, 1'000, 2'000'000'000);
  limit(m.brake_torque, 0, kTopTorque);
  limit(m.brake_release_ms, 0, 60'000);
  limit(m.brake_apply_ms, 0, 60'000);
  limit(m.unit_power, std::max(1, m.rated_power / 10), 1'000'000);
  const auto limit_size = [](double& value, double least, double most) {
    value = value >= least ? std::min(value, most) : least;
  };
  limit_size(m.second_inertia, 0, 1e6);
  if (m.second_inertia != 0) limit_size(m.second_inertia, 1e-9, 1e6);
  limit_size(m.stiffness, 0, 1e9);
  limit_size(m.damping, 0, 1e6);
  limit_size(m.backlash, 0, 1e3);
  limit(m.unit_current, 1, 10'000'000);
  limit(m.dc_link, 1'000, kTopDcLink);
  limit(m.chopper_level, m.dc_link, kTopDcLink);
  limit(m.continuous_current, 1'000, kTopCurrent);
  limit(m.unit_heat_time_ms, 1, 10'000'000);
  limit(m.ambient, -50, 100);
  limit(m.heat_sink_rise, 0, 200);
  limit(m.heat_sink_time_ms, 1, 10'000'000);
  limit(m.noise, 0, 100'000);
  return m;
}

double rated_torque(const MachineData& machine) {
  const double rpm = std::max(1, machine.rated_speed - machine.rated_slip) / 1000.0;
  return machine.rated_power / (2 * std::numbers::pi * rpm / 60);
}

double rotor_inertia(const MachineData& machine) {
  const double speed = 2 * std::numbers::pi * machine.rated_speed / 60'000;
  return rated_torque(machine) * machine.rotor_run_up_ms / 1'000 / speed;
}

}  // namespace ipos::runtime
