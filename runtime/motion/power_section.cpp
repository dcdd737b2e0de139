// Currents by Pythagoras, DC link by energy, temperatures by first-order lags.
#include "runtime/motion/power_section.hpp"

#include <algorithm>
#include <cstdlib>

namespace ipos::runtime {
namespace {

constexpr int64_t kHundredPercent = 100'000;
constexpr int64_t kLosses = 20'000;  // of motor and inverter at IN, 1/1000 % of the rated power
constexpr int64_t kStandby = 1'000;  // always taken from the DC link

// Rated power lifts the square of the DC link voltage by 10000 V² a millisecond: about 200 µF a kilowatt.
constexpr int64_t kChargePerPower = 100'000;  // mV² per 1/1000 %

int64_t square(int64_t value) { return value * value; }

// The whole square root.
int64_t root(int64_t value) {
  int64_t result = 0;
  for (int64_t bit = int64_t{1} << 30; bit != 0; bit >>= 1)
    if (square(result + bit) <= value) result += bit;
  return result;
}

}  // namespace

PowerSection::PowerSection(const MachineData& machine)
    : machine_(machine),
      idle_charge_(square(machine.dc_link)),
      charge_(idle_charge_),
      most_charge_(square(machine.braking_resistor ? machine.chopper_level : kTopDcLink)),
      unit_(machine.unit_heat_time_ms),
      motor_(machine.motor_heat_time_ms),
      heat_sink_(machine.heat_sink_time_ms) {}

int64_t PowerSection::torque_limit(int32_t current_limit) const {
  const int64_t limit = std::clamp(current_limit, 0, kTopCurrent);
  const int64_t magnetizing = std::min<int64_t>(machine_.magnetizing_current, limit);
  const int64_t active = root(square(limit) - square(magnetizing));
  return std::min<int64_t>(kTopTorque, active * kHundredPercent / machine_.rated_active_current);
}

void PowerSection::step(const Load& load) {
  const bool driving = load.supply == Supply::Driving;
  const int64_t torque = driving ? load.torque : 0;
  const int64_t active = torque * machine_.rated_active_current / kHundredPercent;
  int64_t reactive = 0;
  if (driving || load.supply == Supply::Magnetizing)
    reactive = std::clamp(load.current_limit, 0, machine_.magnetizing_current);
  if (load.supply == Supply::DirectCurrent) reactive = std::clamp(load.direct_current, 0, kTopCurrent);
  active_current_ = static_cast<int32_t>(active);
  output_current_ = static_cast<int32_t>(root(square(active) + square(reactive)));

  const int64_t mrpm = whole_speed(load.speed);
  const int64_t slip = machine_.rated_slip * torque / kHundredPercent;
  frequency_ = driving ? static_cast<int32_t>((mrpm + slip) * machine_.pole_pairs / 60) : 0;
  step_power(torque * mrpm / machine_.rated_speed);

  constexpr int64_t kTopUtilization = 10'000'000;  // 1/1000 %
  const int64_t heat = square(output_current_);
  unit_.follow(std::min(kTopUtilization, heat / (square(machine_.continuous_current) / kHundredPercent)));
  const int64_t rated = square(machine_.rated_active_current) + square(machine_.magnetizing_current);
  motor_.follow(std::min(kTopUtilization, heat / std::max<int64_t>(1, rated / kHundredPercent)));
  // In 1/1000 K, as whole() is to be divided.
  heat_sink_.follow(std::min<int64_t>(1'000'000, heat / 10'000'000 * machine_.heat_sink_rise));
}

void PowerSection::cool(uint64_t steps) {
  unit_.fall(steps);
  motor_.fall(steps);
  heat_sink_.fall(steps);
}

// Below one digit of the division nothing changes any more.
void PowerSection::Lag::fall(uint64_t steps) {
  for (; steps != 0 && value_ >= time_ms_; --steps) value_ -= value_ / time_ms_;
}

// Mechanical power in 1/1000 % of the rated power; losses are added, what comes back charges the DC link.
void PowerSection::step_power(int64_t mechanical) {
  const int64_t power = mechanical + kLosses * square(output_current_) / square(kHundredPercent);
  const int64_t change = std::clamp<int64_t>(power + kStandby, -100'000'000, 100'000'000) * kChargePerPower;
  charge_ = std::clamp(charge_ - change, idle_charge_, most_charge_);
  if (power <= 0) return;
  constexpr int64_t kPerWs = kHundredPercent * 1'000;
  energy_rest_ += std::min<int64_t>(power, 100'000'000) * machine_.rated_power;
  energy_ += energy_rest_ / kPerWs;
  energy_rest_ %= kPerWs;
}

int32_t PowerSection::dc_link() const { return static_cast<int32_t>(root(charge_)); }

int32_t PowerSection::heat_sink() const { return machine_.ambient + heat_sink_.whole() / 1'000; }

}  // namespace ipos::runtime
