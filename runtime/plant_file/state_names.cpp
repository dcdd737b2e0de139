// The names of the states, in the order of the table.
#include "runtime/plant_file/state_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace ipos::runtime {
namespace {

constexpr std::string_view kNames[] = {
#define STATION_STATE(name, ...) name,
#include "runtime/plant_file/station_states.def"
};
constexpr std::string_view kUnits[] = {
#define STATION_STATE(name, meaning, on_off, unit, ...) unit,
#include "runtime/plant_file/station_states.def"
};

constexpr StationSwitchType kSwitches[] = {
#define STATION_SWITCH(name, word, most, meaning) {StationSwitch::name, word, most, meaning},
#include "runtime/plant_file/station_switches.def"
};

}  // namespace

std::span<const StationSwitchType> station_switches() { return kSwitches; }

const StationSwitchType* find_switch(std::string_view word) {
  const auto* const found = std::find_if(std::begin(kSwitches), std::end(kSwitches),
                                         [word](const StationSwitchType& type) { return type.word == word; });
  return found == std::end(kSwitches) ? nullptr : found;
}

int find_state(std::string_view name) {
  const auto* const found = std::find(std::begin(kNames), std::end(kNames), name);
  return found == std::end(kNames) ? -1 : static_cast<int>(found - std::begin(kNames));
}

std::string state_names() { return fmt::format("{}", fmt::join(kNames, ", ")); }

std::string old_state(std::string_view state) {
  const int row = find_state(state);
  constexpr std::string_view kThousandths = "1/1000 ";
  if (row < 0 || !kUnits[row].starts_with(kThousandths)) return {};
  return fmt::format("state = \"{0}\" counts in {1} and is kept for old tests; write signal = \"{0}\", which counts in {2}",
                     state, kUnits[row], kUnits[row].substr(kThousandths.size()));
}

bool tells_fault(std::string_view state) { return state.find("fault") != std::string_view::npos; }

}  // namespace ipos::runtime
