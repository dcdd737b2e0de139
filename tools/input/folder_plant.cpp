// The only plant of a folder is what people mean by the folder.
#include "tools/input/folder_plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "compiler/diag/places.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

// Tests and campaigns have a table [[station]] nowhere; files of other programs neither.
bool is_plant_file(const std::string& path) {
  if (!is_plant(path) || !std::filesystem::path(path).stem().extension().empty()) return false;
  const std::string text = try_read_file(path).value_or("");
  return text.starts_with("[[station]]") || text.find("\n[[station]]") != std::string::npos;
}

}  // namespace

std::vector<std::string> plants_in(const std::string& folder) {
  std::vector<std::string> plants, programs;
  for (const std::string& name : list_files(folder)) {
    const std::string path = folder.empty() ? name : (std::filesystem::path(folder) / name).generic_string();
    if (is_plant_file(path))
      plants.push_back(path);
    else if (is_source(path))
      programs.push_back(path);
  }
  std::vector<std::string>& found = plants.empty() ? programs : plants;
  std::sort(found.begin(), found.end());
  return found;
}

std::string plant_or_program(const std::string& given) {
  if (!given.empty() && !is_folder(given)) {
    std::error_code none;
    if (given != "-" && !std::filesystem::exists(std::filesystem::symlink_status(given, none)))
      throw Failure(kNoInput, fmt::format("{}: {}", given, unreadable(given).value_or("")));
    return given;
  }
  const std::vector<std::string> found = plants_in(given);
  if (found.size() == 1) return found.front();
  const std::string folder = given.empty() ? "this folder" : compiler::printable(given);
  throw Failure(kUsage, found.empty()
                            ? fmt::format("{} has no plant (.toml) and no program (.IPC); name a file", folder)
                            : fmt::format("{} has {} {}; name one of them: {}", folder, found.size(),
                                          is_source(found.front()) ? "programs" : "plants", fmt::join(found, ", ")));
}

}  // namespace ipos::tools
