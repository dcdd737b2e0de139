// Warnings about text that means something else than it seems to: operators that bind less than they look,
// chains of comparisons, `=+`, and a `;` that is the whole body of a loop.
#pragma once

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"

namespace ipos::compiler {

void check_habits(const ast::Stmt& body, const SourceMap& sources, Diagnostics& diagnostics);

}  // namespace ipos::compiler
