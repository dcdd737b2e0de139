// A plant without what has mistakes is built only to hear what its units refuse.
#include "runtime/plant/all_mistakes.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "runtime/plant/plant.hpp"

namespace ipos::runtime {
namespace {

using Errors = std::vector<PlantError>;
using Images = std::vector<std::optional<vm::Image>>;

// What the units refuse, and the names that lead nowhere: of the stations with their programs and what the surroundings do
// to them, without lines, memories and the stations that have no unit.
Errors further_mistakes(const PlantFile& file, Images programs) {
  PlantFile plant;
  Images images;
  std::set<std::string> names;
  for (size_t n = 0; n < file.stations.size(); ++n) {
    const StationConfig& from = file.stations[n];
    if (from.unit == nullptr || !names.insert(from.name).second) continue;
    StationConfig station;
    station.name = from.name;
    station.unit = from.unit;
    station.options = from.options;
    station.parameters = from.parameters;
    station.place = from.place;
    plant.stations.push_back(std::move(station));
    images.push_back(std::move(programs[n]));
  }
  // A name cannot be looked for in a program that was not read.
  const auto is_known = [&](const Signal& signal) {
    for (size_t n = 0; n < plant.stations.size(); ++n)
      if (plant.stations[n].name == signal.station) return signal.kind != SignalKind::Variable || images[n];
    return false;
  };
  for (const Stimulus& stimulus : file.stimuli)  // whether any other signal can be written depends on the shaft
    if (is_known(stimulus.signal) && stimulus.signal.kind != SignalKind::Any) plant.stimuli.push_back(stimulus);
  for (const Expectation& expectation : file.expectations)
    if (is_known(expectation.signal)) plant.expectations.push_back(expectation);
  Errors errors;
  const Plant built(std::move(plant), std::move(images), {}, errors);
  return errors;
}

bool is_before(const PlantError& a, const PlantError& b) {
  return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
}

}  // namespace

Errors all_mistakes(const PlantFile& file, Images programs, Errors errors) {
  for (PlantError& error : further_mistakes(file, std::move(programs)))
    if (std::none_of(errors.begin(), errors.end(), [&](const PlantError& known) {
          return !is_before(known, error) && !is_before(error, known);
        }))
      errors.push_back(std::move(error));
  std::stable_sort(errors.begin(), errors.end(), is_before);
  return errors;
}

}  // namespace ipos::runtime
