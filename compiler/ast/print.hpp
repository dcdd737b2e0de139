// The tree as text for --emit=ast: a node a line, `line:col what`, children indented.
#pragma once

#include <string>

#include "compiler/ast/ast.hpp"

namespace ipos::compiler::ast {

std::string print(const Program& program, const SourceMap& map);

// Spelling of an operator: "+", "<=", ...
std::string_view spelling(BinaryOp op);
std::string_view spelling(UnaryOp op);

}  // namespace ipos::compiler::ast
