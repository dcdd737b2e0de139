// Warnings of slips of the pen that the text alone shows: a variable compared with itself, an `else` or a statement that
// stands where it does not belong, `**`.
#pragma once

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"

namespace ipos::compiler {

// Looks at the body of a function.
void check_slips(const ast::Stmt& body, const SourceMap& sources, Diagnostics& diagnostics);

}  // namespace ipos::compiler
