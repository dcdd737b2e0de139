// Programs first, as they decide what a station is; then the plant.
#include "tools/testing/plant_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/cli/files.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/machines/open_machines.hpp"

namespace ipos::tools::testing {
namespace {

// Messages that are expected and do not come, and the reverse.
void compare_diagnostics(const TestCase& test, const Program& program, BuiltPlant& built) {
  std::multiset<ExpectedDiagnostic> missing(test.diagnostics.begin(), test.diagnostics.end());
  built.checks += missing.size();
  const auto finding = [&](uint32_t line, std::string text) {
    Finding found;
    found.file = test.file;
    found.place = {line, 1};
    found.text = std::move(text);
    if (line <= test.lines->size()) found.source.push_back((*test.lines)[line - 1]);
    built.findings.push_back(std::move(found));
  };
  for (const ExpectedDiagnostic& came : program.diagnostics) {
    const auto expected = missing.find(came);
    if (expected != missing.end())
      missing.erase(expected);
    else
      finding(came.line, fmt::format("{} is not expected:\n{}", came.code, program.messages));
  }
  for (const ExpectedDiagnostic& row : missing)
    finding(row.line, fmt::format("{} is expected and does not come", row.code));
}

// The program of a station; nothing when it cannot be used, then `messages` say why.
std::optional<vm::Image> load(const TestCase& test, runtime::StationConfig& station, Programs& programs,
                              BuiltPlant& built) {
  const std::string path = beside(test.plant_path, station.program);
  const auto program = programs.load(path, station.unit);
  if (!test.diagnostics.empty()) compare_diagnostics(test, *program, built);
  if (!program->image) {
    if (test.diagnostics.empty()) built.messages += program->messages;
    return std::nullopt;
  }
  std::string why;
  if (program->unit == nullptr || program->unit->tasks == 0)
    why = "the image is for a unit that runs no program";
  else if (station.unit != nullptr && station.unit != program->unit)
    why = fmt::format("the image is for unit {}, station '{}' is {}", program->unit->name, station.name,
                      station.unit->name);
  if (!why.empty()) {
    built.messages += mistakes_text(test.plant_path, {{station.program_place, path + ": " + why}}, false);
    return std::nullopt;
  }
  station.unit = program->unit;
  return program->image;
}

}  // namespace

BuiltPlant build_plant(const TestCase& test, Programs& programs, const RunOptions& options) {
  BuiltPlant built;
  runtime::PlantFile file = test.plant;
  runtime::move_seeds(file, options.seed);
  std::vector<std::optional<vm::Image>> images;
  bool complete = true;
  for (runtime::StationConfig& station : file.stations) {
    images.emplace_back();
    if (station.program.empty()) continue;
    images.back() = load(test, station, programs, built);
    complete &= images.back().has_value();
  }
  if (!complete) return built;
  if (const auto unopened = open_machines(file, test.plant_path, programs.allow_fmu()); !unopened.empty()) {
    built.messages += mistakes_text(test.plant_path, unopened, false);
    return built;
  }
  const uint32_t speed = test.speed != 0 ? test.speed : options.speed;
  std::optional<vm::Rates> rates;
  if (speed != 0) rates = vm::Rates{{speed, speed, speed}};
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(std::move(file), std::move(images), rates, errors, programs.execution());
  built.messages += mistakes_text(test.plant_path, errors, false);
  if (errors.empty()) built.plant = std::move(plant);
  if (built.plant) programs.look_at_objects(test.plant_path, *built.plant);
  return built;
}

}  // namespace ipos::tools::testing
