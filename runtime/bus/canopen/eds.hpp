// The electronic data sheet of a node (CiA 306): its object dictionary and the parameters of its unit as text
// for the configuration tools of masters.
#pragma once

#include <string>

#include "stdlib/unit_types.hpp"

namespace ipos::runtime::canopen {

std::string eds_text(const stdlib::UnitType& unit);

}  // namespace ipos::runtime::canopen
