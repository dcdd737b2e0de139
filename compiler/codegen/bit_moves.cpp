// `if (x & 4) o |= 2; else o &= ~2;` and its family as one BMOV or BMOVN. Either way the variable is written once, whatever the
// bit is, so nobody can tell one from the other.
#include <bit>

#include "compiler/codegen/generator.hpp"
#include "compiler/sema/fold.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;
using vm::Opcode;

namespace {

struct Bit {
  int32_t variable = 0;
  int32_t number = 0;
  bool is_one = true;  // tested or written so

  bool same_place(const Bit& other) const { return variable == other.variable && number == other.number; }
};

std::optional<int32_t> bit_of_mask(int32_t mask) {
  const auto bits = static_cast<uint32_t>(mask);
  if (!std::has_single_bit(bits)) return std::nullopt;
  return std::countr_zero(bits);
}

// A variable and a constant, in either order.
struct Masked {
  int32_t variable = 0;
  int32_t mask = 0;
};
std::optional<Masked> masked(const Expr& left, const Expr& right) {
  const int32_t* variable = as_variable(left);
  const int32_t* mask = as_constant(right);
  if (variable == nullptr || mask == nullptr) return std::nullopt;
  return Masked{*variable, *mask};
}
std::optional<Masked> masked(const checked::Binary& node) {
  const auto found = masked(*node.left, *node.right);
  return found ? found : masked(*node.right, *node.left);
}

// (x >> K) & 1, as io.h writes an input.
std::optional<Bit> shifted_bit(const checked::Binary& both) {
  const int32_t* one = as_constant(*both.right);
  const auto* shift = std::get_if<checked::Binary>(&both.left->node);
  if (one == nullptr || *one != 1 || shift == nullptr || shift->op != BinaryOp::Shr) return std::nullopt;
  const int32_t* variable = as_variable(*shift->left);
  const int32_t* count = as_constant(*shift->right);
  if (variable == nullptr || count == nullptr) return std::nullopt;
  return Bit{*variable, *count & 31, true};
}

// x & 4, (x >> 2) & 1, with !, != 0, == 0 and == 4 or == 1.
std::optional<Bit> tested_bit(const Expr& expr) {
  if (const auto* unary = std::get_if<checked::Unary>(&expr.node); unary != nullptr && unary->op == checked::UnaryOp::Not) {
    auto bit = tested_bit(*unary->operand);
    if (bit) bit->is_one = !bit->is_one;
    return bit;
  }
  const auto* node = std::get_if<checked::Binary>(&expr.node);
  if (node == nullptr) return std::nullopt;
  if (node->op == BinaryOp::And) {
    if (const auto bit = shifted_bit(*node)) return bit;
    const auto found = masked(*node);
    const auto number = found ? bit_of_mask(found->mask) : std::nullopt;
    return number ? std::optional(Bit{found->variable, *number, true}) : std::nullopt;
  }
  const int32_t* limit = as_constant(*node->right);
  const auto* inner = std::get_if<checked::Binary>(&node->left->node);
  if ((node->op != BinaryOp::Eq && node->op != BinaryOp::Ne) || limit == nullptr || inner == nullptr || inner->op != BinaryOp::And)
    return std::nullopt;
  auto bit = tested_bit(*node->left);
  if (!bit) return std::nullopt;
  const int32_t set = shifted_bit(*inner) ? 1 : masked(*inner)->mask;  // what it is when the bit is 1
  if (*limit != 0 && *limit != set) return std::nullopt;
  bit->is_one = (*limit == set) == (node->op == BinaryOp::Eq);
  return bit;
}

// v | 2 or v & ~2.
std::optional<Bit> written_bit(int32_t variable, BinaryOp op, int32_t mask) {
  if (op != BinaryOp::Or && op != BinaryOp::And) return std::nullopt;
  const auto number = bit_of_mask(op == BinaryOp::Or ? mask : ~mask);
  return number ? std::optional(Bit{variable, *number, op == BinaryOp::Or}) : std::nullopt;
}

std::optional<Bit> written_bit(const Expr& value, int32_t target) {
  const auto* node = std::get_if<checked::Binary>(&value.node);
  const auto found = node == nullptr ? std::nullopt : masked(*node);
  return found && found->variable == target ? written_bit(target, node->op, found->mask) : std::nullopt;
}

// A statement that sets or clears one bit of a variable.
std::optional<Bit> written_bit(const checked::Stmt& stmt) {
  if (const auto* block = std::get_if<checked::Block>(&stmt.node))
    return block->body.size() == 1 ? written_bit(*block->body.front()) : std::nullopt;
  const auto* single = std::get_if<checked::ExprStmt>(&stmt.node);
  if (single == nullptr) return std::nullopt;
  if (const auto* assign = std::get_if<checked::Assign>(&single->expr->node)) {
    if (assign->target.offset != nullptr) return std::nullopt;
    if (!assign->op) return written_bit(*assign->value, assign->target.number);
    const int32_t* mask = as_constant(*assign->value);
    return mask == nullptr ? std::nullopt : written_bit(assign->target.number, *assign->op, *mask);
  }
  const auto* call = std::get_if<checked::SystemCall>(&single->expr->node);
  if (call == nullptr || (call->opcode != Opcode::BitSet && call->opcode != Opcode::BitClear)) return std::nullopt;
  const int32_t* variable = std::get_if<int32_t>(&call->arguments[0]);
  const int32_t* number = std::get_if<int32_t>(&call->arguments[1]);
  if (variable == nullptr || number == nullptr) return std::nullopt;
  return Bit{*variable, *number, call->opcode == Opcode::BitSet};
}

// The command, where one way writes 1 to a bit and the other one 0.
struct Move {
  Opcode opcode;
  Bit to;
  Bit from;
};
std::optional<Move> move_of(const std::optional<Bit>& from, const std::optional<Bit>& then, const std::optional<Bit>& otherwise) {
  if (!from || !then || !otherwise || !then->same_place(*otherwise) || then->is_one == otherwise->is_one) return std::nullopt;
  return Move{from->is_one == then->is_one ? Opcode::BitMove : Opcode::BitMoveNeg, *then, *from};
}

}  // namespace

bool FunctionGenerator::bit_move(const checked::If& node, Span span) {
  if (node.otherwise == nullptr) return false;
  const auto move = move_of(tested_bit(*node.condition), written_bit(*node.then), written_bit(*node.otherwise));
  if (move) emit(move->opcode, span, {move->to.variable, move->to.number, move->from.variable, move->from.number});
  return move.has_value();
}

// o = x & 4 ? o | 2 : o & ~2;
bool FunctionGenerator::bit_move(const checked::Assign& node, Span span) {
  const auto* choice = std::get_if<checked::Conditional>(&node.value->node);
  if (choice == nullptr || node.op || node.target.offset != nullptr) return false;
  const int32_t target = node.target.number;
  const auto move = move_of(tested_bit(*choice->condition), written_bit(*choice->then, target), written_bit(*choice->otherwise, target));
  if (move) emit(move->opcode, span, {move->to.variable, move->to.number, move->from.variable, move->from.number});
  return move.has_value();
}

}  // namespace ipos::compiler
