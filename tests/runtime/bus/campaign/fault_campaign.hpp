// Fault campaign: a plant of four drives with parameter traffic, process data and cyclic variables under
// random mixed faults of the line, a seed a run. Checked in every run:
//
//   - a parameter takes a new value only if a request with this value was carried over the line intact
//   - within kRecovery after the last fault MOVLNK calls succeed, process data are answered, and variables
//   are fresh
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/bus/can/line_fault.hpp"

namespace ipos::tests {

// 50 ms until a MOVLNK gives up, 20 ms for the longest delay, the way back from bus-off, and one call.
inline constexpr runtime::Time kRecovery = 100 * runtime::kMillisecond;

struct FaultTotals {
  uint64_t seeds = 0;
  uint64_t frames = 0;  // carried
  std::array<uint64_t, std::size(runtime::kFaultTypes)> struck{};
  uint64_t bus_off = 0;
  uint64_t calls_good = 0;
  uint64_t calls_failed = 0;
  uint64_t parameter_changes = 0;
  runtime::Time longest_recovery = 0;  // last failed call after the last fault
  std::vector<std::string> failures;   // "seed 17: ..."
};

FaultTotals run_faults(uint64_t first_seed, uint64_t count);

std::string summary(const FaultTotals& totals);

}  // namespace ipos::tests
