// Conditions whose outcome is known before the program runs.
#pragma once

#include "compiler/ast/ast.hpp"
#include "compiler/sema/context.hpp"

namespace ipos::compiler {

// What the condition belongs to: endless loops and `do { } while (0)` are forms of their own.
enum class ConditionOf : uint8_t { Choice, Loop, LoopEnd };

// Warns of a condition that is always or never true. A plain constant that a macro gives is a switch of the
// user.
void check_decided(const ast::Expr& text, const checked::ExprPtr& condition, ConditionOf use,
                   Context& context);

}  // namespace ipos::compiler
