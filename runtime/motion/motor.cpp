// From kW, V, Hz, A, rpm and cos phi to the figures of MachineData.
#include "runtime/motion/motor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace ipos::runtime {
namespace {

constexpr MotorType kTypes[] = {
#define MOTOR_TYPE(name, watt, milliampere, rpm, cos_phi, inertia) \
  {name, {watt, 400, 50, milliampere / 1e3, rpm, cos_phi / 100.0, inertia * 1e-4}},
#include "runtime/motion/motor_types.def"
};

// Rated currents of the units of the series, W and mA (ours: rounded, near to what 400 V units of these sizes have).
struct UnitSize {
  int32_t power, current;
};
constexpr UnitSize kUnits[] = {{550, 2'000},   {750, 2'400},    {1'100, 3'100},   {1'500, 4'000},   {2'200, 5'500},
                               {3'000, 7'000}, {4'000, 9'500},  {5'500, 12'500},  {7'500, 16'000},  {11'000, 24'000},
                               {15'000, 32'000}, {22'000, 46'000}, {30'000, 60'000}, {37'000, 73'000}, {45'000, 89'000}};

int32_t whole(double value) { return static_cast<int32_t>(value + 0.5); }

int32_t rescaled(int32_t current, double from, double to) { return whole(current * from / to); }

void take_unit(MachineData& machine, int32_t power, int32_t current) {
  for (int32_t* share : {&machine.rated_active_current, &machine.magnetizing_current})
    *share = rescaled(*share, machine.unit_current, current);
  machine.unit_power = power;
  machine.unit_current = current;
}

}  // namespace

double Nameplate::efficiency() const { return power / (std::sqrt(3.0) * voltage * current * cos_phi); }

std::span<const MotorType> motor_types() { return kTypes; }

void fit_motor(MachineData& machine, const Nameplate& plate) {
  machine.pole_pairs = plate.pole_pairs();
  machine.rated_speed = whole(plate.synchronous() * 1e3);
  machine.rated_slip = machine.rated_speed - whole(plate.speed * 1e3);
  machine.rated_power = whole(plate.power);
  const double torque = rated_torque(machine);
  const double synchronous = 2 * std::numbers::pi / 60 * plate.synchronous();
  machine.rotor_run_up_ms = std::max(1, whole(plate.inertia * synchronous / torque * 1e3));
  machine.run_up_us = whole(plate.inertia * synchronous / torque * 1e6 * (100 + machine.inertia) / 100);
  // Of the losses beside those of the rotor two thirds arise in the stator's copper (ours).
  const double losses = plate.power / plate.efficiency() - plate.power;
  const double rotor = plate.power * machine.rated_slip / (plate.speed * 1e3);
  const double stator = std::max(losses - rotor, 0.0) * 2 / 3;
  const double drop = stator / (std::sqrt(3.0) * plate.current) / plate.voltage;  // of the apparent current
  machine.stator_drop = whole(drop * plate.cos_phi * 1e5);
  // In shares of a current of 1 A first.
  machine.unit_current = 1'000;
  machine.rated_active_current = whole(plate.current * plate.cos_phi * 1e5);
  machine.magnetizing_current = whole(plate.current * std::sqrt(1 - plate.cos_phi * plate.cos_phi) * 1e5);
  const auto* unit = std::find_if(std::begin(kUnits), std::end(kUnits), [&](const UnitSize& size) {
    return size.power >= machine.rated_power && size.current >= plate.current * 1e3 * 0.99;
  });
  if (unit != std::end(kUnits))
    take_unit(machine, unit->power, unit->current);
  else
    take_unit(machine, machine.rated_power, whole(plate.current * 1e3));
}

void fit_unit(MachineData& machine, std::optional<double> power, std::optional<double> current) {
  const auto* size = std::find_if(std::begin(kUnits), std::end(kUnits),
                                  [&](const UnitSize& row) { return power && row.power >= *power; });
  const int32_t usual = size != std::end(kUnits) ? size->current : machine.unit_current;
  take_unit(machine, power ? whole(*power) : machine.unit_power, current ? whole(*current * 1e3) : usual);
}

}  // namespace ipos::runtime
