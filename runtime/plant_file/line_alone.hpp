// A line of a plant without its stations, for nodes that are elsewhere.
#pragma once

#include <string>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

// With the faults that are planted on the whole of it. Nothing when the plant has no line of that name.
PlantFile line_alone(const PlantFile& file, const std::string& bus);

}  // namespace ipos::runtime
