// Code generation: checked tree to image.
#pragma once

#include <optional>

#include "compiler/codegen/layout.hpp"

namespace ipos::compiler {

// Nothing when there are too many temporaries; a program that is too long comes with its error. The same
// program always gives the same bytes.
std::optional<GeneratedProgram> generate(const checked::Program& program, const stdlib::UnitType& unit,
                                         const SourceMap& sources, GenerateOptions options, Diagnostics& diagnostics);

}  // namespace ipos::compiler
