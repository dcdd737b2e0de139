// Conditions become jumps, not values: comparisons are one command, && and || are the jumps alone.
#include "compiler/codegen/generator.hpp"
#include "compiler/sema/fold.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;
using vm::Opcode;

namespace {

struct CompareRow {
  BinaryOp op;
  BinaryOp inverse;   // true when op is false
  BinaryOp mirrored;  // with the operands exchanged
  Opcode variable;
  Opcode constant;
};
constexpr CompareRow kCompare[] = {
    {BinaryOp::Eq, BinaryOp::Ne, BinaryOp::Eq, Opcode::JmpEqHH, Opcode::JmpEqHK},
    {BinaryOp::Ne, BinaryOp::Eq, BinaryOp::Ne, Opcode::JmpNeHH, Opcode::JmpNeHK},
    {BinaryOp::Lt, BinaryOp::Ge, BinaryOp::Gt, Opcode::JmpLtHH, Opcode::JmpLtHK},
    {BinaryOp::Le, BinaryOp::Gt, BinaryOp::Ge, Opcode::JmpLeHH, Opcode::JmpLeHK},
    {BinaryOp::Gt, BinaryOp::Le, BinaryOp::Lt, Opcode::JmpGtHH, Opcode::JmpGtHK},
    {BinaryOp::Ge, BinaryOp::Lt, BinaryOp::Le, Opcode::JmpGeHH, Opcode::JmpGeHK},
};

const CompareRow& compare_row(BinaryOp op) {
  for (const CompareRow& row : kCompare)
    if (row.op == op) return row;
  return kCompare[0];
}

bool is_logical(BinaryOp op) { return op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr; }

bool is_one(const Expr& expr) { return as_constant(expr) != nullptr && *as_constant(expr) == 1; }

// Gives 0 or 1 only.
bool is_truth(const Expr& expr) {
  if (const auto* unary = std::get_if<checked::Unary>(&expr.node)) return unary->op == checked::UnaryOp::Not;
  const auto* node = std::get_if<checked::Binary>(&expr.node);
  if (node == nullptr) return false;
  return is_comparison(node->op) || is_logical(node->op) ||
         (node->op == BinaryOp::And && is_one(*node->right));
}

// (x >> K) & 1, as io.h writes an input: x and the mask 1 << K.
const Expr* single_bit(const Expr& expr, int32_t& mask) {
  const auto* both = std::get_if<checked::Binary>(&expr.node);
  if (both == nullptr || both->op != BinaryOp::And || !is_one(*both->right)) return nullptr;
  const auto* shift = std::get_if<checked::Binary>(&both->left->node);
  if (shift == nullptr || shift->op != BinaryOp::Shr || !as_constant(*shift->right)) return nullptr;
  mask = *fold(BinaryOp::Shl, 1, *as_constant(*shift->right));
  return shift->left;
}

}  // namespace

// Jumps to `label` when the condition is `when`, else goes on after.
void FunctionGenerator::branch(const Expr& expr, int label, bool when) {
  const Hold hold(top_);
  if (const int32_t* known = as_constant(expr)) {
    if ((*known != 0) == when) jump(label, expr.span);
    return;
  }
  if (const auto* node = std::get_if<checked::Unary>(&expr.node)) {
    // -x is zero when x is.
    if (node->op == checked::UnaryOp::Not) return branch(*node->operand, label, !when);
    if (node->op == checked::UnaryOp::Minus) return branch(*node->operand, label, when);
  }
  if (const auto* node = std::get_if<checked::Comma>(&expr.node)) {
    effect(*node->left);
    return branch(*node->right, label, when);
  }
  if (const auto* node = std::get_if<checked::Conditional>(&expr.node)) {
    const int otherwise = new_label();
    const int end = new_label();
    branch(*node->condition, otherwise, false);
    branch(*node->then, label, when);
    jump(end, expr.span);
    place(otherwise);
    branch(*node->otherwise, label, when);
    return place(end);
  }
  if (const auto* node = std::get_if<checked::Binary>(&expr.node);
      node != nullptr && (is_comparison(node->op) || is_logical(node->op)))
    return branch_binary(*node, label, when, expr.span);
  test(expr, label, when);
}

void FunctionGenerator::branch_binary(const checked::Binary& node, int label, bool when, Span span) {
  if (is_logical(node.op)) {
    // The left side alone decides when it is false for &&, true for ||.
    const bool decisive = node.op == BinaryOp::LogicalOr;
    if (when == decisive) {
      branch(*node.left, label, when);
      return branch(*node.right, label, when);
    }
    const int skip = new_label();
    branch(*node.left, skip, decisive);
    branch(*node.right, label, when);
    return place(skip);
  }
  const int32_t* limit = as_constant(*node.right);
  if (limit != nullptr && (node.op == BinaryOp::Eq || node.op == BinaryOp::Ne) && !is_simple(*node.left)) {
    const bool equal = node.op == BinaryOp::Eq;
    if (*limit == 0) return branch(*node.left, label, equal ? !when : when);
    if (*limit == 1 && is_truth(*node.left)) return branch(*node.left, label, equal ? when : !when);
  }
  compare(node, label, when, span);
}

void FunctionGenerator::compare(const checked::Binary& node, int label, bool when, Span span) {
  const CompareRow* row = &compare_row(node.op);
  Operand left = guarded(value(*node.left), *node.right, node.left->span);
  Operand right = value(*node.right);
  if (left.constant && right.constant) {  // (a = 1) == 2
    const int32_t copy = temporary();
    set(copy, left, node.left->span);
    left = {false, copy};
  } else if (left.constant) {
    std::swap(left, right);
    row = &compare_row(row->mirrored);
  }
  if (!when) row = &compare_row(row->inverse);
  emit(right.constant ? row->constant : row->variable, span, {left.value, right.value}).label = label;
}

void FunctionGenerator::test(const Expr& expr, int label, bool when) {
  const Opcode opcode = when ? Opcode::JmpNeHK : Opcode::JmpEqHK;
  int32_t mask = 0;
  if (const Expr* word = single_bit(expr, mask)) {
    const int32_t bit = temporary();
    into(*word, bit);
    emit(Opcode::AndHK, expr.span, {bit, mask});
    emit(opcode, expr.span, {bit, 0}).label = label;
    return;
  }
  const Operand operand = value(expr);
  if (!operand.constant)
    emit(opcode, expr.span, {operand.value, 0}).label = label;
  else if ((operand.value != 0) == when)
    jump(label, expr.span);
}

}  // namespace ipos::compiler
