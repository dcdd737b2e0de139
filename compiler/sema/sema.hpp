// Semantic check: syntax tree to checked tree.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"
#include "compiler/sema/checked.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::compiler {

// Nothing when the program has errors, those found before included. `is_unit_value` as in CompileOptions.
std::optional<checked::Program> check(
    const ast::Program& program, const stdlib::UnitType& unit, const SourceMap& sources, Diagnostics& diagnostics,
    const std::function<bool(const stdlib::UnitType& unit, std::string_view name)>& is_unit_value = {});

}  // namespace ipos::compiler
