// The analog outputs AO1 and AO2 (P640..P645, 1053 1610 p. 79). The list prints functions, scaling and modes; what 10 V are is
// ours: 3000 rpm, 100 Hz, 150 % of IN, 150 % utilization.
#pragma once

#include <cstdint>

namespace ipos::runtime {

enum class AnalogFunction : uint8_t {
  None = 0,
  RampInput = 1,
  SpeedSetpoint = 2,
  ActualSpeed = 3,
  ActualFrequency = 4,
  OutputCurrent = 5,
  ActiveCurrent = 6,
  UnitUtilization = 7,
  IposOutput = 8,
};

struct AnalogOutputSettings {
  int32_t function, scaling, mode;  // scaling in 1/1000
};

// Of a terminal that is wired as voltage or as current; the other one is 0.
struct AnalogLevel {
  int32_t millivolt = 0, microampere = 0;
  bool operator==(const AnalogLevel&) const = default;
};

struct AxisState;

// `ramp_input`: 1/1000 rpm. `ipos`: of H478 or H479, 10000 is 10 V.
AnalogLevel analog_level(const AnalogOutputSettings& settings, const AxisState& axis, int32_t ramp_input, int32_t ipos);

}  // namespace ipos::runtime
