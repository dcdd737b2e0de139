// Arithmetic of the language on constants: 32 bits that wrap, division toward zero, shift counts modulo 32.
#pragma once

#include <cstdint>
#include <optional>

#include "compiler/ast/ast.hpp"

namespace ipos::compiler {

// nullopt: division by zero.
std::optional<int32_t> fold(ast::BinaryOp op, int32_t left, int32_t right);

bool is_comparison(ast::BinaryOp op);

}  // namespace ipos::compiler
