// Return codes of the parameter channel on the bus: the table is stdlib/return_codes.def, this adds their
// text for people.
#pragma once

#include <string>

#include "stdlib/return_codes.hpp"

namespace ipos::runtime {

using stdlib::ReturnCode;
namespace return_codes = stdlib::return_codes;

// "class 8 code 0 additional 10h: invalid parameter index"
std::string describe(ReturnCode code);

}  // namespace ipos::runtime
