// What a verb works on when it is given a folder, or nothing.
#pragma once

#include <string>
#include <vector>

namespace ipos::tools {

// The plants of a folder ("" is the one we are in) by name; its programs where it has no plant. Other people's TOML is no
// plant, and the tests of a plant are none.
std::vector<std::string> plants_in(const std::string& folder);

// A file is given back as it is; one that is not there is a Failure with the name that was perhaps meant. A folder gives its only plant, or its only program where it has no plant; nothing means
// the folder one is in. A Failure names what there is to choose from.
std::string plant_or_program(const std::string& given);

}  // namespace ipos::tools
