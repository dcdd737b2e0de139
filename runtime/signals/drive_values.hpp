// Which values of the drive a station has, by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/station/station.hpp"

namespace ipos::signals {

bool has_drive_value(const stdlib::UnitType& unit, std::string_view name);
std::vector<std::string> drive_value_names(const runtime::Station& station);

}  // namespace ipos::signals
