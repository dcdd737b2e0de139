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
  limit(m.inertia, 0, 100'000);
  limit(m.friction, 0, kTopTorque);
  limit(m.load_torque, -kTopTorque, kTopTorque);
  limit(m.brake_torque, 0, kTopTorque);
  limit(m.dc_link, 1'000, kTopDcLink);
  limit(m.chopper_level, m.dc_link, kTopDcLink);
  limit(m.continuous_current, 1'000, kTopCurrent);
  limit(m.unit_heat_time_ms, 1, 10'000'000);
  limit(m.ambient, -50, 100);
  limit(m.heat_sink_rise, 0, 200);
  limit(m.heat_sink_time_ms, 1, 10'000'000);
  return m;
}

double rated_torque(const MachineData& machine) {
  const double rpm = std::max(1, machine.rated_speed - machine.rated_slip) / 1000.0;
  return machine.rated_power / (2 * std::numbers::pi * rpm / 60);
}

}  // namespace ipos::runtime
