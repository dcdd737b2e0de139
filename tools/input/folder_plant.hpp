// What a verb works on when it is given a folder, or nothing.
#pragma once

#include <string>

namespace ipos::tools {

// A file is given back as it is. A folder gives its only plant, or its only program where it has no plant; nothing means
// the folder one is in. A Failure names what there is to choose from.
std::string plant_or_program(const std::string& given);

}  // namespace ipos::tools
