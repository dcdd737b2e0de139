// Constant arithmetic.
#include "compiler/sema/fold.hpp"

namespace ipos::compiler {

std::optional<int32_t> fold(ast::BinaryOp op, int32_t left, int32_t right) {
  using enum ast::BinaryOp;
  const auto a = static_cast<uint32_t>(left);
  const auto b = static_cast<uint32_t>(right);
  const auto wrap = [](uint32_t value) { return static_cast<int32_t>(value); };
  switch (op) {
    case Mul: return wrap(a * b);
    case Div:
      if (right == 0) return std::nullopt;
      return right == -1 ? wrap(0 - a) : left / right;
    case Mod:
      if (right == 0) return std::nullopt;
      return right == -1 ? 0 : left % right;
    case Add: return wrap(a + b);
    case Sub: return wrap(a - b);
    case Shl: return wrap(a << (b & 31));
    case Shr: return left >> (b & 31);
    case Lt: return left < right;
    case Le: return left <= right;
    case Gt: return left > right;
    case Ge: return left >= right;
    case Eq: return left == right;
    case Ne: return left != right;
    case And: return wrap(a & b);
    case Xor: return wrap(a ^ b);
    case Or: return wrap(a | b);
    case LogicalAnd: return left != 0 && right != 0;
    case LogicalOr: return left != 0 || right != 0;
  }
  return std::nullopt;
}

bool is_comparison(ast::BinaryOp op) { return op >= ast::BinaryOp::Lt && op <= ast::BinaryOp::Ne; }

}  // namespace ipos::compiler
