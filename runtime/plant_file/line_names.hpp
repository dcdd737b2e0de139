// The lines that a station or a control is on, as the plant file names them.
#pragma once

#include <string>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

// SBus first, then serial lines, then PROFIBUS. The line to a keypad has no name in the file.
std::vector<std::string> line_names(const StationConfig& station);
std::vector<std::string> line_names(const ControlConfig& control);

}  // namespace ipos::runtime
