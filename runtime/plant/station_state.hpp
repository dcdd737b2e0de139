// The states of a station that are neither variable nor parameter, by the names that plant files and tests give
// them (docs/testing.md).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "runtime/plant/station.hpp"

namespace ipos::runtime {

struct StationState {
  std::string_view name;
  std::string_view meaning;
  int32_t (*read)(const Station& station);
  bool on_off = false;  // only 0 and 1
};

std::span<const StationState> station_states();

// Its number in the table, or -1.
int find_state(std::string_view name);

// "fault, status, ..."
std::string state_names();

// Whether it tells that a station or its program has a fault.
bool tells_fault(std::string_view state);

}  // namespace ipos::runtime
