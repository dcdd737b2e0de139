// The FMUs that the machines of a plant file name. An FMU is a program of somebody else that runs as the user, so each is opened
// only where the user has said so: with --allow-fmu, or in a file of his own.
#pragma once

#include <string>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::tools {

// Gives each machine of the plant its model. `path` is that of the plant file. Errors have their places in it.
std::vector<runtime::PlantError> open_machines(runtime::PlantFile& plant, const std::string& path, bool allowed);

}  // namespace ipos::tools
