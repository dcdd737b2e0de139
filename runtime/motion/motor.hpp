// The nameplate of a motor, and what the model makes of it.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>

#include "runtime/motion/machine_data.hpp"

namespace ipos::runtime {

struct Nameplate {
  double power = 0;      // W
  double voltage = 400;  // V
  double frequency = 50;
  double current = 0;  // A
  double speed = 0;    // rpm
  double cos_phi = 0;
  double inertia = 0;  // kgm²

  int pole_pairs() const { return std::max(1, static_cast<int>(60 * frequency / speed)); }
  double synchronous() const { return 60 * frequency / pole_pairs(); }  // rpm
  double efficiency() const;
};

struct MotorType {
  std::string_view name;
  Nameplate plate;
};
std::span<const MotorType> motor_types();

// The motor of this machine, on a unit that fits it.
void fit_motor(MachineData& machine, const Nameplate& plate);
// Another unit: currents are shares of its rated current.
void fit_unit(MachineData& machine, std::optional<double> power, std::optional<double> current);

}  // namespace ipos::runtime
