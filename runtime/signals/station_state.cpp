// How each state is read.
#include "runtime/signals/station_state.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

// 0 where none has ended the program.
int32_t program_fault(const Station& station) {
  return station.machine() == nullptr ? 0 : int32_t{station.machine()->fault().number};
}

// The line of the command that ended the program, 0 when no fault has.
int32_t program_fault_line(const Station& station) {
  if (program_fault(station) == 0) return 0;
  return static_cast<int32_t>(station.source_line(station.machine()->fault().address));
}

constexpr StationState kStates[] = {
#define STATION_STATE(name, meaning, on_off, ...) \
  {name, meaning, on_off, [](const Station& station) -> int32_t { return __VA_ARGS__; }},
#include "runtime/plant_file/station_states.def"
};

}  // namespace

std::span<const StationState> station_states() { return kStates; }

}  // namespace ipos::signals
