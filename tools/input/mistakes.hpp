// Mistakes in plants and tests as the compiler shows those of programs: the place, what is wrong, the line and a caret.
#pragma once

#include <string>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::tools {

// The file is read again for its lines; without it they are left out.
std::string mistakes_text(const std::string& path, const std::vector<runtime::PlantError>& errors,
                          bool colours);

// To standard error.
void print_mistakes(const std::string& path, const std::vector<runtime::PlantError>& errors);

}  // namespace ipos::tools
