// All mistakes of a plant file at once: those of the text, and those that only units and names find. `ipos` and the C
// library tell them alike.
#pragma once

#include <optional>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"
#include "vm/image/image.hpp"

namespace ipos::runtime {

// For a file whose reading or whose programs gave `errors`. `programs` has a row for each station, empty where there is no
// program or it could not be read. What follows from a mistake that stands at the same place is left out; the result is in
// the order of the file.
std::vector<PlantError> all_mistakes(const PlantFile& file, std::vector<std::optional<vm::Image>> programs,
                                     std::vector<PlantError> errors);

}  // namespace ipos::runtime
