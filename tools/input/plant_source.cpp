// Reading a plant file for a verb.
#include "tools/input/plant_source.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"

namespace ipos::tools {

namespace fs = std::filesystem;

bool is_plant(std::string_view path) { return fs::path(path).extension() == ".toml"; }

runtime::PlantFile read_plant(const std::string& path) {
  runtime::PlantFileResult result = runtime::read_plant_file(read_file(path));
  for (const runtime::PlantError& error : result.errors)
    fmt::print(stderr, "{}:{}:{}: error: {}\n", path, error.place.line, error.place.column, error.text);
  if (!result.errors.empty()) throw Failure(kBadInput, "");
  for (runtime::StationConfig& station : result.plant.stations)
    if (!station.nvram.empty()) station.nvram = (fs::path(path).parent_path() / station.nvram).string();
  return std::move(result.plant);
}

}  // namespace ipos::tools
