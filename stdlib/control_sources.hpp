// Codes of P100 and P101 (1053 1610 p. 72, 73; 11 and 4 of MOVITRAC 07 chapter 10.3), named once.
#pragma once

#include <cstdint>

namespace ipos::stdlib {

// P100.
enum class SetpointSource : int32_t {
  Bipolar = 0,
  Unipolar = 1,
  Rs485 = 2,
  Fieldbus = 3,
  MotorPot = 4,
  MotorPotPlusAi1 = 5,
  FixedPlusAi1 = 6,
  FixedTimesAi1 = 7,
  MasterSbus = 8,
  MasterRs485 = 9,
  Sbus = 10,
  Frequency = 11,
};

// P101.
enum class ControlSource : int32_t { Terminals = 0, Rs485 = 1, Fieldbus = 2, Sbus = 3, ThreeWire = 4 };

constexpr int32_t code(SetpointSource source) { return static_cast<int32_t>(source); }
constexpr int32_t code(ControlSource source) { return static_cast<int32_t>(source); }

// Values of P100.
constexpr bool follows_sbus_master(int32_t p100) { return p100 == code(SetpointSource::MasterSbus); }
constexpr bool follows_rs485_master(int32_t p100) { return p100 == code(SetpointSource::MasterRs485); }

}  // namespace ipos::stdlib
