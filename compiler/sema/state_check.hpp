// Warnings of what constants decide about loops and states: loops that never run or never end, cases of a `switch` that
// nothing assigns, and states without a case.
#pragma once

#include "compiler/sema/context.hpp"
#include "compiler/sema/program_roots.hpp"
#include "compiler/sema/written.hpp"

namespace ipos::compiler {

void check_states(Context& context, const ProgramRoots& roots, const Written& written);

}  // namespace ipos::compiler
