// Conditions that a copy or a timer decides: a variable that has just got the value of another one, and a timer that counts
// down from less.
#pragma once

#include "compiler/sema/context.hpp"
#include "compiler/sema/program_roots.hpp"
#include "compiler/sema/written.hpp"

namespace ipos::compiler {

void check_copies(Context& context, const ProgramRoots& roots, const Written& written);

}  // namespace ipos::compiler
