// Reading a plant file for a verb.
#include "tools/input/plant_source.hpp"

#include <filesystem>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/mistakes.hpp"

namespace ipos::tools {

bool is_plant(std::string_view path) { return std::filesystem::path(path).extension() == ".toml"; }

runtime::TomlKind kind_of_file(const std::string& path) {
  const auto text = is_plant(path) ? try_read_file(path) : std::nullopt;
  return text ? runtime::kind_of_text(*text, path) : runtime::TomlKind::Unknown;
}

runtime::PlantFileResult try_read_plant(const std::string& path) {
  runtime::PlantFileResult result = runtime::read_plant_file(read_file(path), path);
  for (runtime::StationConfig& station : result.plant.stations)
    if (!station.nvram.empty()) station.nvram = beside(path, station.nvram);
  return result;
}

runtime::PlantFile read_plant(const std::string& path) {
  runtime::PlantFileResult result = try_read_plant(path);
  print_mistakes(path, result.errors);
  if (!result.errors.empty()) throw Failure(kBadInput, "");
  return std::move(result.plant);
}

std::string check_time(const std::string& text) {
  return runtime::parse_duration(text) < 0 ? "'" + text + "' is no time; write for example 500ms or 1.5s"
                                           : "";
}

}  // namespace ipos::tools
