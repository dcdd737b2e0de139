// The plant is the first word that names one; --signals and --station stand behind it or before.
#include "tools/input/offers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/signals/find.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/unit_types.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

// Empty: no word but the one that is being typed is a plant.
std::string plant_among(const Words& words) {
  const auto end = words.empty() ? words.end() : words.end() - 1;
  const auto found = std::find_if(words.begin(), end, [](const std::string& word) {
    return (is_plant(word) || is_source(word)) && !unreadable(word);
  });
  return found == end ? "" : *found;
}

}  // namespace

Words offered_units() {
  Words names;
  for (const stdlib::UnitType& unit : stdlib::unit_types()) names.emplace_back(unit.name);
  return names;
}

Words offered_signals(const Words& words) {
  Words names;
  try {
    const auto plant = make_plant(read_plant_input(plant_among(words), {}), runtime::FileUse::Look);
    for (const signals::Signal& signal : signals::plant_signals(*plant)) names.push_back(signal.name);
  } catch (const Failure&) {
    return {};
  }
  return names;
}

Words offered_stations(const Words& words) {
  Words names;
  const std::string plant = plant_among(words);
  if (!is_plant(plant)) return names;
  for (const runtime::StationConfig& station : runtime::read_plant_file(read_file(plant)).plant.stations)
    names.push_back(station.name);
  return names;
}

Words offered_parameters(const Words& words) {
  const std::string plant = plant_among(words);
  if (!is_plant(plant)) return {};
  std::set<std::string> names;
  for (const runtime::StationConfig& station : runtime::read_plant_file(read_file(plant)).plant.stations)
    if (station.unit != nullptr)
      for (const stdlib::Parameter& row : stdlib::parameter_table(*station.unit).rows())
        if (!row.number.empty()) names.insert(fmt::format("P{}", row.number));
  return {names.begin(), names.end()};
}

}  // namespace ipos::tools
