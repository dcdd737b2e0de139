// Allocation map: which variable stands at which number, and who uses it (ipos build --emit=map); and the
// symbols of the image.
#pragma once

#include <string>
#include <vector>

#include "compiler/sema/context.hpp"

namespace ipos::compiler {

// Fills program.symbols and program.map, and warns of variables nobody uses.
void describe_variables(Context& context);

// The map as text, a row a variable.
std::string map_text(const std::vector<checked::MapEntry>& map);

}  // namespace ipos::compiler
