// Loops that count an index beyond its array: for (i = 0; i <= 8; i++) a[i] = 0; with a[8].
#pragma once

#include "compiler/sema/context.hpp"
#include "compiler/sema/program_roots.hpp"
#include "compiler/sema/written.hpp"

namespace ipos::compiler {

void check_indexes(Context& context, const ProgramRoots& roots, const Written& written);

}  // namespace ipos::compiler
