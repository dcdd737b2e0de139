// A foreign FMU for co-simulation as the model of machines. Reading one runs nothing of it; each machine that is made of it runs
// in a process of its own (host_process.hpp).
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "runtime/plant_file/foreign_machine.hpp"

namespace ipos::fmi_import {

inline constexpr uint64_t kMostFile = uint64_t{1} << 30U;  // of the archive (ours)

// Of the bytes of the file. The error says what is wrong with it.
tl::expected<std::shared_ptr<const runtime::MachineModel>, std::string> read_fmu(std::string bytes);

}  // namespace ipos::fmi_import
