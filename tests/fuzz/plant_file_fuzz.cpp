// Any text to the plant file reader: errors with their place, or a plant whose references lead somewhere and
// that runs, or says why not.
#include "runtime/plant_file/plant_file.hpp"

#include <algorithm>

#include "runtime/plant/plant.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::runtime;  // NOLINT
using namespace ipos::tests;    // NOLINT

namespace {

constexpr size_t kStations = 8;  // more tell nothing new
constexpr Time kRun = 30 * kMillisecond;

// Without programs and without memory files.
void check_run(PlantFile file) {
  if (file.stations.size() > kStations) return;
  for (StationConfig& station : file.stations) station.nvram.clear();
  std::vector<std::optional<ipos::vm::Image>> programs(file.stations.size());
  std::vector<PlantError> errors;
  Plant plant(std::move(file), std::move(programs), std::nullopt, errors);
  for (const PlantError& error : errors) require(!error.text.empty(), "an error has a text");
  if (!errors.empty()) return;
  require(plant.run_until(kRun) && plant.now() == kRun, "a plant runs as long as asked for");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text = text_of(data, size);
  require(parse_duration(text.substr(0, 40)) >= -1, "a duration is not negative");
  require(parse_input(text.substr(0, 8)) < 16, "an input is a bit of 16");
  const PlantFileResult result = read_plant_file(text);
  for (const PlantError& error : result.errors) {
    require(!error.text.empty(), "an error has a text");
    require(error.place.line > 0 && error.place.column > 0, "an error has a place");
  }
  if (!result.errors.empty()) return 0;
  const PlantFile& plant = result.plant;
  for (const StationConfig& station : plant.stations) {
    require(station.unit != nullptr && !station.name.empty(), "a station has a unit and a name");
    const auto is_bus = [&](const BusConfig& bus) { return bus.name == station.sbus; };
    require(station.sbus.empty() || std::any_of(plant.buses.begin(), plant.buses.end(), is_bus),
            "a station is on a bus that exists");
    require(station.machine.inertia >= 0 && station.machine.friction >= 0, "a load resists");
    for (const InputSetting& input : station.inputs) require(input.input < 16, "an input is a bit of 16");
  }
  for (const Stimulus& stimulus : plant.stimuli) {
    require(stimulus.at >= 0 && stimulus.length >= 0 && stimulus.every >= 0, "times are not negative");
    require(stimulus.signal.line < kInputLines, "an input line exists");
    require(stimulus.action != Stimulus::Action::Pulse || stimulus.length > 0, "a pulse has a length");
  }
  for (const Wire& wire : plant.wires)
    require(wire.from.line < 16 && wire.to.line < 16, "a wire joins terminals that exist");
  for (const PositionSwitch& row : plant.switches)
    require(row.input.line < 16 && row.from <= row.to, "a switch has an input and a range");
  for (const Expectation& expect : plant.expectations) {
    const auto is_station = [&](const StationConfig& station) {
      return station.name == expect.signal.station;
    };
    require(std::any_of(plant.stations.begin(), plant.stations.end(), is_station),
            "an expectation is of a station that exists");
    require(expect.at >= 0, "an expectation is not before the start");
  }
  check_run(plant);
  return 0;
}
