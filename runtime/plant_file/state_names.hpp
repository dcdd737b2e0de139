// The names of the states and switches of a station, as a plant file and a test may use them: station_states.def,
// station_switches.def.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ipos::runtime {

// Its number in the table, or -1.
int find_state(std::string_view name);

// "fault, status, ..."
std::string state_names();

// Of a state that counts in thousandths of what the signal with its name counts in: that it is old, and what to write; else
// empty.
std::string old_state(std::string_view state);

// The switches of a station that a hand can turn.
enum class StationSwitch : uint8_t {
#define STATION_SWITCH(name, word, most, meaning) name,
#include "runtime/plant_file/station_switches.def"
};
struct StationSwitchType {
  StationSwitch which;
  std::string_view word;
  int32_t most;
  std::string_view meaning;
};
std::span<const StationSwitchType> station_switches();
const StationSwitchType* find_switch(std::string_view word);  // nullptr: there is none

// Whether it tells that a station or its program has a fault.
bool tells_fault(std::string_view state);

}  // namespace ipos::runtime
