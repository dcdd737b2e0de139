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

}  // namespace

int find_state(std::string_view name) {
  const auto* const found = std::find(std::begin(kNames), std::end(kNames), name);
  return found == std::end(kNames) ? -1 : static_cast<int>(found - std::begin(kNames));
}

std::string state_names() { return fmt::format("{}", fmt::join(kNames, ", ")); }

bool tells_fault(std::string_view state) { return state.find("fault") != std::string_view::npos; }

}  // namespace ipos::runtime
