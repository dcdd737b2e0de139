// The faults of the units (faults.def) and what a unit does about them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "stdlib/parameters.hpp"

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
  std::string_view parameter;  // numbers of parameters that choose the response; kByCommand; empty: fixed
  std::string_view meaning;    // of all units; meaning_on() has that of one
};

std::span<const FaultRow> fault_table();  // in rising order of the numbers
const FaultRow* find_fault(uint8_t number);

std::string meaning_on(const UnitType& unit, const FaultRow& row);
// The parameter of this unit that chooses the response; nullptr: none does.
const Parameter* response_parameter(const ParameterTable& table, const FaultRow& row);
// Where none does: that from the factory, on MOVITRAC 07 a rapid stop (its manual, chapter 7.1).
FaultResponse fixed_response(const UnitType& unit, const FaultRow& row);

}  // namespace ipos::stdlib
