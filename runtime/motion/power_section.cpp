// Currents by Pythagoras, DC link by energy, temperatures by first-order lags.
#include "runtime/motion/power_section.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ipos::runtime {
namespace {

constexpr int64_t kHundredPercent = 100'000;
constexpr int64_t kLosses = 20'000;  // of motor and inverter at IN, 1/1000 % of the rated power

int64_t square(int64_t value) { return value * value; }

// The whole square root. What floating point gives is only where to look: the result is exact whatever it
// rounds.
int64_t root(int64_t value) {
  auto result = static_cast<int64_t>(std::sqrt(static_cast<double>(value)));
  while (square(result) > value) --result;
  while (square(result + 1) <= value) ++result;
  return result;
}

}  // namespace

PowerSection::PowerSection(const MachineData& machine)
    : machine_{machine.rated_speed, machine.rated_slip,     machine.pole_pairs,           machine.rated_power,
               machine.ambient,     machine.heat_sink_rise, machine.rated_active_current, machine.magnetizing_current},
      active_(machine_.rated_active),
      magnetizing_(machine_.rated_magnetizing),
      charge_per_power_(kChargePerPower * machine.rated_power / machine.unit_power),
      continuous_heat_(square(machine.continuous_current) / kHundredPercent),
      rated_heat_(std::max<int64_t>(
          1, (square(machine.rated_active_current) + square(machine.magnetizing_current)) / kHundredPercent)),
      idle_charge_(square(machine.dc_link)),
      least_charge_(idle_charge_),
      mains_power_(machine.rated_power),
      charge_(idle_charge_),
      most_charge_(square(machine.braking_resistor ? machine.chopper_level : kTopDcLink)),
      dc_link_(machine.dc_link),
      unit_(machine.unit_heat_time_ms),
      motor_(machine.motor_heat_time_ms),
      heat_sink_(machine.heat_sink_time_ms) {
  find_torque_limit(0);
  find_currents({});
}

void PowerSection::find_torque_limit(int32_t current_limit) {
  limit_for_ = current_limit;
  const int64_t limit = std::clamp(current_limit, 0, kTopCurrent);
  const int64_t magnetizing = std::min<int64_t>(magnetizing_, limit);
  const int64_t active = root(square(limit) - square(magnetizing));
  torque_limit_ = std::min<int64_t>(kTopTorque, active * kHundredPercent / active_);
}

void PowerSection::set_flux(int32_t flux) {
  if (flux == flux_) return;
  flux_ = flux;
  active_ = static_cast<int32_t>(std::min<int64_t>(kTopCurrent, int64_t{machine_.rated_active} * 1'000 / flux));
  magnetizing_ = static_cast<int32_t>(std::min<int64_t>(kTopCurrent, int64_t{machine_.rated_magnetizing} * flux / 1'000));
  find_torque_limit(limit_for_);
  find_currents(currents_);
}

void PowerSection::find_currents(const Currents& currents) {
  currents_ = currents;
  const bool driving = currents.supply == Supply::Driving;
  const int64_t active = std::clamp<int64_t>(currents.torque * active_ / kHundredPercent, -10 * kTopCurrent, 10 * kTopCurrent);
  int64_t reactive = 0;
  if (driving || currents.supply == Supply::Magnetizing)
    reactive = std::clamp(currents.current_limit, 0, magnetizing_);
  if (currents.supply == Supply::DirectCurrent)
    reactive = std::clamp(currents.direct_current, 0, kTopCurrent);
  active_current_ = static_cast<int32_t>(active);
  output_current_ = static_cast<int32_t>(root(square(active) + square(reactive)));

  const int64_t heat = square(output_current_);
  losses_ = kLosses * heat / square(kHundredPercent);
  unit_target_ = std::min(kTopUtilization, heat / continuous_heat_);
  motor_target_ = std::min(kTopUtilization, heat / rated_heat_);
  // In 1/1000 K, as whole() is to be divided.
  heat_sink_target_ = std::min<int64_t>(kTopHeat, heat / 10'000'000 * machine_.heat_sink_rise);
}

int32_t PowerSection::frequency() const {
  if (!speed_.driving) return 0;
  const int64_t slip = machine_.rated_slip * speed_.torque / kHundredPercent;
  return static_cast<int32_t>((speed_.mrpm + slip) * machine_.pole_pairs / 60);
}

void PowerSection::advance(Ticks steps) {
  draw(steps);
  warm(steps);
}

void PowerSection::warm(Ticks steps) {
  Lag::Way unit = unit_.begin(unit_target_), motor = motor_.begin(motor_target_),
           heat_sink = heat_sink_.begin(heat_sink_target_);
  for (; steps != 0; --steps) {
    const uint64_t moved = unit_.step(unit) | motor_.step(motor) | heat_sink_.step(heat_sink);
    if (moved == 0) break;
  }
  unit_.finish(unit);
  motor_.finish(motor);
  heat_sink_.finish(heat_sink);
}

PowerSection::Lag::Lag(int32_t time_ms) {
  const int digits = 48 + static_cast<int>(std::bit_width(static_cast<uint32_t>(time_ms)));
  const Wide exact = (Wide{1} << digits) / static_cast<Wide>(time_ms) + 1;
  shift_ = std::max(digits - 63, 0);
  reciprocal_ = static_cast<uint64_t>(exact << (63 + shift_ - digits));
}

// While the mains charge the link it changes every millisecond, so this is the place where they go on.
void PowerSection::find_dc_link() {
  dc_link_ = static_cast<int32_t>(root(charge_));
  if (least_charge_ != 0 && least_charge_ != idle_charge_) charge_on();
}

void PowerSection::charge_on() {
  least_charge_ = std::min(idle_charge_, std::max(charge_, least_charge_) + idle_charge_ / kChargeMs);
}

void PowerSection::set_mains(bool on) {
  mains_power_ = on ? machine_.rated_power : 0;
  least_charge_ = 0;
  if (on) charge_on();
}

void PowerSection::empty() {
  charge_ = 0;
  dc_link_ = 0;
}

}  // namespace ipos::runtime
