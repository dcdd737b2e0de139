// The states of a station (plant_file/station_states.def), and how each is read.
#include "runtime/signals/states.hpp"

#include <algorithm>

#include "runtime/signals/collector.hpp"

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
#define STATION_STATE(name, meaning, on_off, unit, ...) \
  {name, meaning, on_off, unit, [](const Station& station) -> int32_t { return __VA_ARGS__; }},
#include "runtime/plant_file/station_states.def"
};

void add(Collector& out, const StationState& state) {
  Signal& signal = out.add(Group::State, state.name, state.meaning,
                           [&station = out.station(), read = state.read]() -> int64_t { return read(station); });
  signal.bits = state.on_off ? 1 : 0;
  signal.number = static_cast<uint32_t>(&state - kStates);
  signal.unit = state.unit;
  if (old_state(state.name).empty()) return;
  signal.unit = "rpm";
  signal.factor = 1e-3;
  signal.decimals = 3;
}

}  // namespace

std::span<const StationState> station_states() { return kStates; }

void add_states(Collector& out) {
  for (const StationState& state : kStates) add(out, state);
  add_card(out);
}

std::optional<Signal> state_signal(Owner owner, std::string_view name) {
  const int row = find_state(name);
  Collector out(owner);
  if (row >= 0)
    add(out, kStates[row]);
  else
    add_card(out);
  for (Signal& signal : out.found)
    if (signal.own_name() == name) return std::move(signal);
  return std::nullopt;
}

void add_states_beside_drive(Collector& out) {
  for (const StationState& state : kStates)
    if (!is_drive_value(state.name)) add(out, state);
  add_card(out);
}

}  // namespace ipos::signals
