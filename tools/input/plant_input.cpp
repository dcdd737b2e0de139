// Reading plants and their programs.
#include "tools/input/plant_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "compiler/diag/places.hpp"
#include "runtime/plant/all_mistakes.hpp"
#include "stdlib/unit_types.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/machines/open_machines.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

using Errors = std::vector<runtime::PlantError>;

runtime::PlantFile plant_of_program(const std::string& path, const std::string& sbus) {
  runtime::PlantFile plant;
  runtime::StationConfig station;
  station.name = compiler::printable(fs::path(path).stem().string());
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

// A program that several stations of one unit have is compiled once, and its messages come once.
struct CompiledProgram {
  std::optional<vm::Image> image;  // nothing: it has mistakes
  std::vector<std::string> stations;
};
using Compiled = std::map<std::pair<std::string, const stdlib::UnitType*>, CompiledProgram>;

// Whose programs have mistakes.
void tell_users(const Compiled& compiled) {
  for (const auto& [program, result] : compiled)
    if (!result.image && result.stations.size() > 1)
      fmt::print(stderr, "ipos: {} is the program of {} stations: {} to {}\n", compiler::printable(program.first),
                 result.stations.size(), result.stations.front(), result.stations.back());
}

void tell(const std::string& path, const std::vector<runtime::PlantError>& errors, BuildRecord* record) {
  if (record == nullptr) return print_mistakes(path, errors);
  for (const runtime::PlantError& error : errors)
    record->tell({"error", path, error.place.line, error.place.column, error.text});
}

// A plant file of a stranger may name any file. The form of a memory keeps other files safe, but not folders tidy.
void warn_of_far_memories(const PlantInput& input) {
  const fs::path folder = fs::weakly_canonical(fs::absolute(input.path).parent_path());
  for (const runtime::StationConfig& station : input.file.stations) {
    if (station.nvram.empty()) continue;
    std::error_code error;
    const fs::path memory = fs::weakly_canonical(fs::absolute(station.nvram), error);
    const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), memory.begin(), memory.end());
    if (end != folder.end())
      fmt::print(stderr, "ipos: warning: {}:{}:{}: the memory of '{}' is outside of the folder of the plant: {}\n",
                 compiler::printable(input.path), station.nvram_place.line, station.nvram_place.column,
                 station.name, compiler::printable(memory.generic_string()));
  }
}

}  // namespace

PlantInput read_plant_input(const std::string& path, const CompileFlags& compile, const std::string& sbus) {
  PlantInput input{path, {}, {}};
  Errors errors;
  if (is_plant(path)) {
    if (compile.record != nullptr) compile.record->texts[path] = read_file(path);
    runtime::PlantFileResult read = try_read_plant(path);
    input.file = std::move(read.plant);
    errors = std::move(read.errors);
    for (runtime::PlantError& error : open_machines(input.file, path, compile.allow_fmu)) errors.push_back(std::move(error));
  } else {
    input.file = plant_of_program(path, sbus);
  }
  const bool has_mistakes = !errors.empty();
  int code = has_mistakes ? kBadInput : kGood;
  std::string last;  // what is wrong with a program, and was not told yet
  Compiled compiled;
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
    auto [known, is_new] = compiled.try_emplace({program, station.unit});
    known->second.stations.push_back(station.name);
    if (!is_new && !known->second.image) continue;
    try {
      if (is_new) known->second.image = program_of(program, station, compile);
      input.programs.back() = *known->second.image;
    } catch (const Failure& failure) {
      if (!last.empty() && compile.record != nullptr) compile.record->tell({"error", "", 0, 0, last});
      if (!last.empty() && compile.record == nullptr) fmt::print(stderr, "ipos: {}\n", compiler::printable(last));
      last = failure.what();
      if (!has_mistakes) code = failure.exit_code();
    }
  }
  tell_users(compiled);
  if (code == kGood) return input;
  if (is_plant(path)) {
    errors = runtime::all_mistakes(input.file, std::move(input.programs), std::move(errors));
    tell(path, errors, compile.record);
  }
  throw Failure(code, last);
}

std::unique_ptr<runtime::Plant> make_plant(PlantInput input, runtime::FileUse memories,
                                           std::optional<vm::Rates> rates,
                                           const runtime::Execution& execution, BuildRecord* record) {
  if (memories == runtime::FileUse::Write) warn_of_far_memories(input);
  for (runtime::StationConfig& station : input.file.stations) station.nvram_use = memories;
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(std::move(input.file), std::move(input.programs), rates,
                                                errors, execution);
  tell(input.path, errors, record);
  if (!errors.empty()) throw Failure(kBadInput, "");
  return plant;
}

}  // namespace ipos::tools
