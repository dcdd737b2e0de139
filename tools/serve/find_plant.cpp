// Other people's TOML is no plant, and the tests of a plant are none.
#include "tools/serve/find_plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "stdlib/spelling.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"
#include "tools/test_file/read_tests.hpp"

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;

bool has_station(const std::string& path) {
  const auto text = try_read_file(path);
  return text && (text->starts_with("[[station]]") || text->find("\n[[station]]") != std::string::npos);
}

// Nothing is there: the name that is nearest to it, of the same folder.
[[noreturn]] void refuse(const std::string& named) {
  const fs::path path = named;
  const std::vector<std::string> files = list_files(path.parent_path().string());
  const std::vector<std::string_view> names(files.begin(), files.end());
  const std::string_view meant = stdlib::nearest(path.filename().string(), names);
  throw Failure(kNoInput, meant.empty() ? fmt::format("{}: there is no such file", named)
                                        : fmt::format("{}: there is no such file; did you mean {}?", named,
                                                      (path.parent_path() / meant).generic_string()));
}

}  // namespace

std::vector<std::string> plants_in(const std::string& folder) {
  std::vector<std::string> plants, programs;
  for (const std::string& name : list_files(folder)) {
    const std::string path = (fs::path(folder) / name).generic_string();
    if (is_plant(name) && !testing::is_test_file(name) && has_station(path)) plants.push_back(path);
    if (is_source(name)) programs.push_back(path);
  }
  std::vector<std::string>& found = plants.empty() ? programs : plants;
  std::sort(found.begin(), found.end());
  return found;
}

std::string find_plant(const std::string& named) {
  if (!named.empty() && !is_folder(named)) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(named, error)) && named != "-") refuse(named);
    return named;
  }
  const std::vector<std::string> plants = plants_in(named);
  if (plants.size() == 1) return plants.front();
  if (named.empty()) return "";
  if (plants.empty()) throw Failure(kNoInput, fmt::format("{}: there is no plant in this folder", named));
  throw Failure(kUsage, fmt::format("{}: which of its plants? {}", named, fmt::join(plants, ", ")));
}

}  // namespace ipos::tools::serve
