// Semantic check: syntax tree to checked tree.
#pragma once

#include <optional>

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"
#include "compiler/sema/checked.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::compiler {

// Nothing when the program has errors, those found before included.
std::optional<checked::Program> check(const ast::Program& program, const stdlib::UnitType& unit,
                                      const SourceMap& sources, Diagnostics& diagnostics);

}  // namespace ipos::compiler
