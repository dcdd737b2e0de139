// Settings of a unit beside those of another one: a station, a file of `ipos param`, or a station of a plant file; and the
// settings of a unit as lines of a plant file.
#pragma once

#include <string>

#include "tools/parameters/parameter_set.hpp"
#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {

// What a text has for the unit: all of a file of `ipos param`; of a plant file what its station has, and the factory
// settings for the rest. Without a name, or where the file has no such station, it must be the only one of this unit type. A
// Mistake says what is wrong with the text.
ParameterSet settings_in(const std::string& text, const std::string& station, const stdlib::UnitType& unit);

// `rows` that differ, and `file`: what the other one has there, as a file of `ipos param`.
Json compare(const ParameterSet& one, const ParameterSet& other);

// "[station.parameters]", then a line for each setting that is not the factory's.
std::string plant_lines(const ParameterSet& settings);

}  // namespace ipos::tools::serve
