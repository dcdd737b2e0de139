// FMUs are programs of Linux here: they are loaded by a process of their own, which a browser has not.
#include "tools/machines/open_machines.hpp"

#include <fmt/format.h>

namespace ipos::tools {

std::vector<runtime::PlantError> open_machines(runtime::PlantFile& plant, const std::string& /*path*/, bool /*allowed*/) {
  std::vector<runtime::PlantError> errors;
  for (const runtime::MachineConfig& machine : plant.machines)
    errors.push_back({machine.fmu_place, fmt::format("machine '{}': an FMU as a machine is not in a browser; ipos for Linux has it",
                                                     machine.name)});
  return errors;
}

}  // namespace ipos::tools
