// Messages that name parameters, in the words of one unit. A part in braces has alternatives, divided by |: the first
// one counts whose parameters the unit has, and one that names none always does. So a table needs one text a message.
//
//   "no process data within {P883|P815|its timeout}"
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stdlib/unit_types.hpp"

namespace ipos::stdlib {

std::string unit_text(const UnitType& unit, std::string_view text);

// The parameters that a text names: "P815", and "P61x" for some of P610 to P619.
std::vector<std::string> named_parameters(std::string_view text);
// The unit has this one, or one of those.
bool has_named(const UnitType& unit, std::string_view parameter);

}  // namespace ipos::stdlib
