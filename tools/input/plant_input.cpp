// Reading plants and their programs.
#include "tools/input/plant_input.hpp"

#include "tools/input/plant_source.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "stdlib/unit_types.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

void print_errors(const std::string& path, const std::vector<runtime::PlantError>& errors) {
  for (const runtime::PlantError& error : errors)
    fmt::print(stderr, "{}:{}:{}: error: {}\n", path, error.place.line, error.place.column, error.text);
  if (!errors.empty()) throw Failure(kBadInput, "");
}

runtime::PlantFile plant_of(const std::string& path, const std::string& sbus) {
  if (is_plant(path)) {
    return read_plant(path);
  }
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
vm::Image program_of(const PlantInput& input, runtime::StationConfig& station, CompileFlags compile) {
  if (station.unit != nullptr) compile.unit = station.unit->name;
  const std::string path = is_plant(input.path)
                               ? (fs::path(input.path).parent_path() / station.program).string()
                               : station.program;
  if (const auto why = is_plant(input.path) ? unreadable(path) : std::nullopt)
    throw Failure(kNoInput, fmt::format("{}:{}:{}: error: station '{}': program {}: {}", input.path,
                                        station.program_place.line, station.program_place.column,
                                        station.name, path, *why));
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

}  // namespace

bool is_plant(const std::string& path) { return fs::path(path).extension() == ".toml"; }

PlantInput read_plant_input(const std::string& path, const CompileFlags& compile, const std::string& sbus) {
  PlantInput input{path, plant_of(path, sbus), {}};
  for (runtime::StationConfig& station : input.file.stations) {
    if (station.program.empty())
      input.programs.emplace_back();
    else
      input.programs.emplace_back(program_of(input, station, compile));
  }
  return input;
}

std::unique_ptr<runtime::Plant> make_plant(PlantInput input, runtime::FileUse memories,
                                           std::optional<vm::Rates> rates,
                                           const runtime::Execution& execution) {
  for (runtime::StationConfig& station : input.file.stations) station.nvram_use = memories;
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(std::move(input.file), std::move(input.programs), rates,
                                                errors, execution);
  print_errors(input.path, errors);
  return plant;
}

}  // namespace ipos::tools
