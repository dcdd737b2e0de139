// The faults of the units (faults.def) and what a unit does about them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace ipos::stdlib {

// Values of P830..P837 (1053 1610 p. 81; 6 is missing there and taken from the Danish edition).
enum class FaultResponse : uint8_t {
  None = 0,              // the fault is passed over
  Display = 1,           // shown, the drive goes on
  ImmediateError = 2,    // output stage off at once; reset needed
  EmergencyError = 3,    // stop on the emergency ramp P137; reset needed
  RapidError = 4,        // stop on the stop ramp P136; reset needed
  ImmediateWarning = 5,  // as 2..4, but it ends with its cause
  EmergencyWarning = 6,
  RapidWarning = 7,
};

// Only _FaultReaction chooses another response.
inline constexpr std::string_view kByCommand = "command";

struct FaultRow {
  uint8_t number;
  std::string_view name;
  FaultResponse response;      // factory setting
  std::string_view parameter;  // number of the parameter that chooses the response; kByCommand; empty: fixed
  std::string_view meaning;
};

std::span<const FaultRow> fault_table();  // in rising order of the numbers
const FaultRow* find_fault(uint8_t number);

}  // namespace ipos::stdlib
