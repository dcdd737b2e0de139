// The states of a station by name, as plant files and tests ask for them with `state = "..."`.
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
  std::string_view unit;
  int32_t (*read)(const runtime::Station& station);
};

std::span<const StationState> station_states();

}  // namespace ipos::signals
