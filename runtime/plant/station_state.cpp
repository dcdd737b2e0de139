// The table, and how each state is read.
#include "runtime/plant/station_state.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {
namespace {

// The line of the command that ended the program, 0 when no fault has.
int32_t fault_line(const Station& station) {
  if (station.machine() == nullptr || station.machine()->fault().number == 0) return 0;
  return static_cast<int32_t>(station.source_line(station.machine()->fault().address));
}

constexpr StationState kStates[] = {
    {"fault", "fault number, errors and warnings; 0 is none",
     [](const Station& station) { return int32_t{station.fault()}; }},
    {"status", "status word 1", [](const Station& station) { return int32_t{station.status_word_1()}; }},
    {"enabled", "1 while it is enabled",
     [](const Station& station) { return station.drive().state().verdict().reason == Block::None ? 1 : 0; },
     true},
    {"ready", "1 while it is ready",
     [](const Station& station) { return station.drive().state().ready() ? 1 : 0; }, true},
    {"speed", "of the shaft, 1/1000 rpm",
     [](const Station& station) { return station.drive().state().axis().speed; }},
    {"setpoint", "speed the ramp orders, 1/1000 rpm",
     [](const Station& station) { return station.drive().state().axis().setpoint; }},
    {"position", "increments of the shaft",
     [](const Station& station) { return station.drive().state().shaft_position(); }},
    {"powered", "1 while the power is on", [](const Station& station) { return station.powered() ? 1 : 0; },
     true},
    {"running", "1 while a task of the program runs or waits",
     [](const Station& station) { return station.program_over() ? 0 : 1; }, true},
    {"program_fault", "number of the fault that ended the program; 0 is none",
     [](const Station& station) {
       return station.machine() == nullptr ? 0 : int32_t{station.machine()->fault().number};
     }},
    {"program_fault_line", "source line of that fault", fault_line},
};

}  // namespace

std::span<const StationState> station_states() { return kStates; }

int find_state(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kStates), std::end(kStates),
                                         [name](const StationState& state) { return state.name == name; });
  return found == std::end(kStates) ? -1 : static_cast<int>(found - std::begin(kStates));
}

std::string state_names() {
  std::string names;
  for (const StationState& state : kStates)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", state.name);
  return names;
}

bool tells_fault(std::string_view state) { return state.find("fault") != std::string_view::npos; }

}  // namespace ipos::runtime
