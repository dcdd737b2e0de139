// The names of the states of a station, as a plant file and a test may use them: station_states.def.
#pragma once

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

// Whether it tells that a station or its program has a fault.
bool tells_fault(std::string_view state);

}  // namespace ipos::runtime
