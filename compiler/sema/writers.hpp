// Warnings about variables that several tasks or interrupt routines write.
#pragma once

#include "compiler/sema/context.hpp"
#include "compiler/sema/program_roots.hpp"

namespace ipos::compiler {

void check_writers(Context& context, const ProgramRoots& roots);

}  // namespace ipos::compiler
