// Positions that the unit measures, compared for equality with a target: the axis passes it between two looks, or stops
// beside it.
#pragma once

#include "compiler/sema/context.hpp"
#include "compiler/sema/program_roots.hpp"

namespace ipos::compiler {

void check_positions(Context& context, const ProgramRoots& roots);

}  // namespace ipos::compiler
