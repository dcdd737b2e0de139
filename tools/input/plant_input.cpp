// Reading plants and their programs.
#include "tools/input/plant_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "stdlib/unit_types.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/input/plant_source.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

using Errors = std::vector<runtime::PlantError>;
using Images = std::vector<std::optional<vm::Image>>;

runtime::PlantFile plant_of_program(const std::string& path, const std::string& sbus) {
  runtime::PlantFile plant;
  runtime::StationConfig station;
  station.name = fs::path(path).stem().string();
  station.program = path;
  station.sbus = sbus;
  plant.stations.push_back(std::move(station));
  if (!sbus.empty()) {
    plant.buses.emplace_back();
    plant.buses.back().name = sbus;
  }
  return plant;
}

// A station's unit decides for which unit a source is compiled.
vm::Image program_of(const std::string& path, runtime::StationConfig& station, CompileFlags compile) {
  if (station.unit != nullptr) compile.unit = station.unit->name;
  vm::Image image = load_program(path, compile);
  const stdlib::UnitType* unit = stdlib::find_unit(image.unit);
  if (unit == nullptr || unit->tasks == 0)
    throw Failure(kFindings,
                  fmt::format("{}: the image is for unit type {}, which runs no program", path, image.unit));
  if (station.unit == nullptr) station.unit = unit;
  if (station.unit != unit)
    throw Failure(kFindings, fmt::format("{}: the image is for unit {}, station '{}' is {}", path, unit->name,
                                         station.name, station.unit->name));
  return image;
}

// What the units refuse, and the names that lead nowhere, in a plant whose file has mistakes elsewhere: its stations
// with their programs and what the surroundings do to them, without lines, memories and the stations that have no unit.
Errors further_mistakes(const runtime::PlantFile& file, Images programs) {
  runtime::PlantFile plant;
  Images images;
  std::set<std::string> names;
  for (size_t n = 0; n < file.stations.size(); ++n) {
    const runtime::StationConfig& from = file.stations[n];
    if (from.unit == nullptr || !names.insert(from.name).second) continue;
    runtime::StationConfig station;
    station.name = from.name;
    station.unit = from.unit;
    station.options = from.options;
    station.parameters = from.parameters;
    station.place = from.place;
    plant.stations.push_back(std::move(station));
    images.push_back(std::move(programs[n]));
  }
  // A name cannot be looked for in a program that was not read.
  const auto is_known = [&](const runtime::Signal& signal) {
    for (size_t n = 0; n < plant.stations.size(); ++n)
      if (plant.stations[n].name == signal.station)
        return signal.kind != runtime::SignalKind::Variable || images[n];
    return false;
  };
  for (const runtime::Stimulus& stimulus : file.stimuli)
    if (is_known(stimulus.signal)) plant.stimuli.push_back(stimulus);
  for (const runtime::Expectation& expectation : file.expectations)
    if (is_known(expectation.signal)) plant.expectations.push_back(expectation);
  Errors errors;
  const runtime::Plant built(std::move(plant), std::move(images), {}, errors, execution_of());
  return errors;
}

bool is_before(const runtime::PlantError& a, const runtime::PlantError& b) {
  return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
}

}  // namespace

PlantInput read_plant_input(const std::string& path, const CompileFlags& compile, const std::string& sbus) {
  PlantInput input{path, {}, {}};
  Errors errors;
  if (is_plant(path)) {
    runtime::PlantFileResult read = try_read_plant(path);
    input.file = std::move(read.plant);
    errors = std::move(read.errors);
  } else {
    input.file = plant_of_program(path, sbus);
  }
  const bool has_mistakes = !errors.empty();
  int code = has_mistakes ? kBadInput : kGood;
  std::string last;  // what is wrong with a program, and was not told yet
  for (runtime::StationConfig& station : input.file.stations) {
    input.programs.emplace_back();
    if (station.program.empty() || (has_mistakes && station.unit == nullptr)) continue;
    const std::string program = is_plant(path) ? beside(path, station.program) : station.program;
    if (const auto why = is_plant(path) ? unreadable(program) : std::nullopt) {
      errors.push_back(
          {station.program_place, fmt::format("station '{}': program {}: {}", station.name, program, *why)});
      if (code == kGood) code = kNoInput;
      continue;
    }
    try {
      input.programs.back() = program_of(program, station, compile);
    } catch (const Failure& failure) {
      if (!last.empty()) fmt::print(stderr, "ipos: {}\n", last);
      last = failure.what();
      if (!has_mistakes) code = failure.exit_code();
    }
  }
  if (code == kGood) return input;
  if (is_plant(path)) {
    // What follows from a mistake that is told already stands where it does.
    for (runtime::PlantError& error : further_mistakes(input.file, std::move(input.programs)))
      if (std::none_of(errors.begin(), errors.end(), [&](const runtime::PlantError& known) {
            return !is_before(known, error) && !is_before(error, known);
          }))
        errors.push_back(std::move(error));
    std::stable_sort(errors.begin(), errors.end(), is_before);
    print_mistakes(path, errors);
  }
  throw Failure(code, last);
}

std::unique_ptr<runtime::Plant> make_plant(PlantInput input, runtime::FileUse memories,
                                           std::optional<vm::Rates> rates,
                                           const runtime::Execution& execution) {
  for (runtime::StationConfig& station : input.file.stations) station.nvram_use = memories;
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(std::move(input.file), std::move(input.programs), rates,
                                                errors, execution);
  print_mistakes(input.path, errors);
  if (!errors.empty()) throw Failure(kBadInput, "");
  return plant;
}

}  // namespace ipos::tools
