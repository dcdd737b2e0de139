// What turns: motor, load, brake and the power section that feeds them. Torques in 1/1000 % of the motor's
// rated torque, currents in 1/1000 % of the rated unit current IN. The defaults are a self-ventilated 4-pole
// motor of 1.5 kW with brake on a matching 400 V inverter with braking resistor; the figures are ours,
// docs/inside/motion.md.
#pragma once

#include <cstdint>

namespace ipos::runtime {

// The static torque of the load is as it stands, that at rated speed with the square of the speed, against the motion,
// or times the sine of the place.
enum class LoadShape : uint8_t { Constant, BySpeed, ByPosition };

struct MachineData {
  // The unit: a ramp time is the time for this change of speed, 3000 rpm on MOVIDRIVE (ours) and 50 Hz on
  // MOVITRAC 07 (its manual, chapter 6.1).
  int32_t ramp_reference = 3'000'000;  // 1/1000 rpm

  // Without `real` the speed is the setpoint's as far as the current limit lets it (Shaft::driven).
  bool real = false;

  // The motor.
  int32_t rated_speed = 1'500'000;  // synchronous speed at 50 Hz, 1/1000 rpm
  int32_t rated_slip = 100'000;     // at rated torque, 1/1000 rpm
  int32_t pole_pairs = 2;
  int32_t rated_power = 1'500;             // W
  int32_t rated_active_current = 80'000;   // at rated torque
  int32_t magnetizing_current = 60'000;    // so rated apparent current = IN
  int32_t rotor_run_up_ms = 50;            // the bare rotor from 0 to rated speed with rated torque
  int32_t motor_heat_time_ms = 1'200'000;  // time constant of motor utilization
  int32_t breakdown_torque = 260'000;
  int32_t stator_drop = 6'000;  // of the active rated current at the stator's resistance, 1/1000 % of the rated voltage

  // The load. Static torque acts in one direction, like a hoist: positive pulls counter-clockwise.
  int32_t inertia = 400;  // of the load, % of the rotor's
  int32_t friction = 5'000;
  int32_t load_torque = 0;
  LoadShape load_shape = LoadShape::Constant;
  int32_t load_turns = 1'000;  // of ByPosition: 1/1000 turns of what is driven in a turn of the motor
  int32_t run_up_us = 0;       // of rotor and load together, where it is known better than by the two above
  double second_inertia = 0;   // kgm² of a second mass behind a spring; 0: there is none
  double stiffness = 0;        // of the spring, Nm/rad
  double damping = 0;          // Nms/rad
  double backlash = 0;         // rad
  bool driven = false;  // its speed is given from outside, and friction, torque and brake are there, too

  bool brake = true;  // a mechanical one is fitted
  int32_t brake_torque = 200'000;
  int32_t brake_release_ms = 0;  // from the order until its torque is gone
  int32_t brake_apply_ms = 0;    // and until it is there

  // The power section.
  int32_t unit_power = 1'500;            // W
  int32_t unit_current = 4'000;          // IN, mA
  int32_t dc_link = 560'000;             // mV, mains 400 V
  bool braking_resistor = true;          // holds the DC link at chopper_level
  int32_t chopper_level = 780'000;       // mV
  int32_t continuous_current = 125'000;  // 100 % unit utilization in the long run
  int32_t unit_heat_time_ms = 50'000;    // time constant of unit utilization
  int32_t ambient = 25;                  // °C
  int32_t heat_sink_rise = 40;           // K at IN
  int32_t heat_sink_time_ms = 300'000;
  int32_t noise = 0;  // of actual values, at most, 1/1000 % of rated speed or IN
  uint32_t noise_seed = 0;
  bool operator==(const MachineData&) const = default;
};

// Anything of it beyond the plainest shaft with ideal control. A shaft that is driven from outside has nothing of all this.
constexpr bool is_detailed(const MachineData& m) {
  if (m.driven) return false;
  return m.real || m.load_shape != LoadShape::Constant || m.brake_release_ms != 0 || m.brake_apply_ms != 0 ||
         m.second_inertia != 0 || m.noise != 0;
}

inline constexpr int32_t kTopTorque = 4'000'000;   // 40 x rated
inline constexpr int32_t kTopCurrent = 1'000'000;  // 10 x IN
inline constexpr int32_t kTopDcLink = 1'000'000;   // mV

// Nm, at rated speed less slip: what 100 % torque is.
double rated_torque(const MachineData& machine);
// kgm², of the bare rotor.
double rotor_inertia(const MachineData& machine);

// Every figure brought to where the model computes without overflow and without division by 0.
MachineData within_limits(MachineData machine);

}  // namespace ipos::runtime
