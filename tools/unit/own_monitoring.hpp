// The net under everything that moves a drive over a line: the drive's own monitoring of process data. Which parameter
// says how long the words of a line may stay away, which one says what then happens, and which words need it at all.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "stdlib/parameters.hpp"

namespace ipos::tools {

// Lines over which ipos can send process data to a drive: RS-485 (P812, P833), and SBus (P815, on MOVIDRIVE B P883, and
// P836), which also holds for CANopen nodes. DP slaves get zeros only.
struct MonitoringIndices {  // the same in all units
  uint16_t timeout, response;
  std::string names, response_name;  // of the parameters
};
MonitoringIndices monitoring_indices(bool serial);

struct OwnMonitoring {
  const stdlib::Parameter* timeout = nullptr;   // null: this unit has none over this line
  const stdlib::Parameter* response = nullptr;  // null: it cannot be chosen, the unit stops
};
OwnMonitoring own_monitoring(const stdlib::UnitType& unit, bool serial);

// 0 switches it off, and on MOVIDRIVE 650 s do (1053 1610 p. 41).
constexpr bool is_off(int32_t timeout_ms) { return timeout_ms <= 0 || timeout_ms >= 650'000; }
// NO RESPONSE and DISPLAY ERROR let the drive go on with its last words (P830).
constexpr bool lets_go_on(int32_t response) { return response <= 1; }

// Whether one of the words would release a drive, if it is a control word: no inhibit, no rapid stop, no stop (1053 1610
// p. 40). A word of another meaning may look so, too.
constexpr bool could_enable(std::span<const uint16_t> words) {
  for (const uint16_t word : words)
    if ((word & 7U) == 6U) return true;
  return false;
}

}  // namespace ipos::tools
