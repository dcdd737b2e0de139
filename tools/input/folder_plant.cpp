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
  return try_read_file(path).value_or("").find("[[station]]") != std::string::npos;
}

}  // namespace

std::string plant_or_program(const std::string& given) {
  if (!given.empty() && !is_folder(given)) return given;
  std::vector<std::string> plants, programs;
  for (const std::string& name : list_files(given)) {
    const std::string path = given.empty() ? name : (std::filesystem::path(given) / name).generic_string();
    if (is_plant_file(path))
      plants.push_back(path);
    else if (is_source(path))
      programs.push_back(path);
  }
  std::vector<std::string>& choice = plants.empty() ? programs : plants;
  if (choice.size() == 1) return choice.front();
  std::sort(choice.begin(), choice.end());
  const std::string folder = given.empty() ? "this folder" : compiler::printable(given);
  throw Failure(kUsage, choice.empty()
                            ? fmt::format("{} has no plant (.toml) and no program (.IPC); name a file", folder)
                            : fmt::format("{} has {} {}; name one of them: {}", folder, choice.size(),
                                          plants.empty() ? "programs" : "plants", fmt::join(choice, ", ")));
}

}  // namespace ipos::tools
