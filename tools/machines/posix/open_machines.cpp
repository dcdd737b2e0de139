// Linux: permission first, then the file.
#include "tools/machines/open_machines.hpp"

#include <fmt/format.h>

#include "compiler/diag/places.hpp"
#include "runtime/fmi_import/fmu_model.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/machines/posix/allowed.hpp"

namespace ipos::tools {
namespace {

// The error says why there is no model.
tl::expected<std::shared_ptr<const runtime::MachineModel>, std::string> open_fmu(const std::string& path, bool allowed) {
  if (const auto why = unreadable(path)) return tl::unexpected(*why);
  if (!allowed && !is_allowed(path))
    return tl::unexpected(fmt::format("an FMU is a program, which would run as you; allow it with --allow-fmu{}", where_to_allow()));
  try {
    return fmi_import::read_fmu(read_file(path, fmi_import::kMostFile));
  } catch (const Failure& failure) {
    return tl::unexpected(std::string(failure.what()));
  }
}

}  // namespace

std::vector<runtime::PlantError> open_machines(runtime::PlantFile& plant, const std::string& path, bool allowed) {
  std::vector<runtime::PlantError> errors;
  for (runtime::MachineConfig& machine : plant.machines) {
    if (machine.fmu.empty()) continue;
    const std::string file = beside(path, machine.fmu);
    auto model = open_fmu(file, allowed);
    if (model)
      machine.model = *std::move(model);
    else
      errors.push_back({machine.fmu_place, fmt::format("machine '{}': {}: {}", machine.name, compiler::printable(file), model.error())});
  }
  return errors;
}

}  // namespace ipos::tools
