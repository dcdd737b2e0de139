// Units on a PROFIBUS line, seen by a PC: what a master of class 2 may ask any slave, and the parameter channel, which lies
// in the cyclic data and so needs the master of class 1.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/links/dp_station.hpp"
#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools {

// Heads, then a row of `ipos scan` for the station; nothing where nobody answers.
std::vector<std::string> dp_scan_heads();
std::optional<std::vector<std::string>> dp_scan_row(DpStation& line, uint8_t address);

// The parameters of a slave: the PC becomes its master of class 1, with all process data 0, and gives it free at the end. A
// Failure: nobody, another unit, locked by another master, a configuration that is refused or has no channel.
std::unique_ptr<ParameterAccess> open_dp_unit(const LinkFlags& flags, uint8_t address);

}  // namespace ipos::tools
