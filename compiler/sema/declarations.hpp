// First pass over a program: pragmas, types, variables with their numbers, aliases and the names of
// functions.
#pragma once

#include "compiler/ast/ast.hpp"
#include "compiler/sema/context.hpp"

namespace ipos::compiler {

// Fills scope, ranges and symbols. Functions are known by name afterwards; their bodies come later.
void declare(const ast::Program& program, Context& context);

// After the bodies, when all raw names are known: collisions between variables, raw names and ranges.
void check_numbers(Context& context);

}  // namespace ipos::compiler
