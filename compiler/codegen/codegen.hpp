// Code generation: checked tree to image.
#pragma once

#include <optional>

#include "compiler/codegen/layout.hpp"

namespace ipos::compiler {

// Nothing when the program does not fit: too many temporaries or too long. The same program always gives the
// same bytes.
std::optional<GeneratedProgram> generate(const checked::Program& program, const stdlib::UnitType& unit,
                                         const SourceMap& sources, Diagnostics& diagnostics);

}  // namespace ipos::compiler
