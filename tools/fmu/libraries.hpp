// Where the libraries of an FMU lie, one a platform.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/fmu/dialect.hpp"

namespace ipos::tools {

// The folder of this program; empty where the system does not tell it.
std::filesystem::path program_folder();

// In this order: $IPOS_FMU_LIBRARIES alone if it is set; beside the program; lib beside it or beside its folder, as builds have it;
// the folder of ipos among the system's libraries; a build for Windows beside this one.
std::vector<std::filesystem::path> library_folders();
std::optional<std::filesystem::path> find_library(const Platform& platform);

}  // namespace ipos::tools
