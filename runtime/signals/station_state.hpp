// The states of a station (runtime/plant_file/station_states.def), and how each is read.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/plant_file/state_names.hpp"
#include "runtime/station/station.hpp"

namespace ipos::signals {

struct StationState {
  std::string_view name;
  std::string_view meaning;
  bool on_off;  // only 0 and 1
  int32_t (*read)(const runtime::Station& station);
};

std::span<const StationState> station_states();

}  // namespace ipos::signals
