// What completion offers for values that a table or the plant of the line knows. Nothing where the plant does not read.
#pragma once

#include <string>
#include <vector>

namespace ipos::tools {

using Words = std::vector<std::string>;  // of the command line; the last one is being typed

Words offered_units();
Words offered_signals(const Words& words);
Words offered_stations(const Words& words);
// Behind a plant: P130, ... of its stations' units.
Words offered_parameters(const Words& words);

}  // namespace ipos::tools
