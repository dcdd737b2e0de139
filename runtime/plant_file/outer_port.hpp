// Which buses a run joins to the real world. The port "fmi" is a terminal of an FMU (runtime/fmi): in a run of ipos the line is
// alone.
#pragma once

#include <string_view>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

inline constexpr std::string_view kFmiPort = "fmi";

inline bool has_outer_port(const BusConfig& bus) { return !bus.port.empty() && bus.port != kFmiPort; }

}  // namespace ipos::runtime
