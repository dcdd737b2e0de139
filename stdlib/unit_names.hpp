// Units and their rules as text, for messages and pages: no list of units is written by hand.
#pragma once

#include <string>
#include <string_view>

#include "stdlib/unit_types.hpp"

namespace ipos::stdlib {

// With ", " between them: all units, those that run programs, those with the trait.
std::string unit_names();
std::string program_unit_names();
std::string unit_names(Trait trait);

// A unit by its name, or by how its nameplate begins ("MDX61B..."), in any case of letters; nullptr when there is none.
const UnitType* find_unit_or_plate(std::string_view name);

// "'nope' is no unit type; known are ..."
std::string no_unit_text(std::string_view name);

// Cycle times of a class of SBus objects: "1 to 9 ms", "10 to 65530 ms in steps of 10".
std::string cycle_text(const ObjectClass& objects);

}  // namespace ipos::stdlib
