// Linear forms of expressions and places; statements that move a variable by a constant.
#include "compiler/codegen/linear.hpp"

#include <cstddef>

#include "compiler/codegen/generator.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;

namespace {

// Both are in the order of their variables.
std::optional<Linear> sum(const Linear& a, const Linear& b, uint32_t times) {
  Linear out{{}, a.constant + b.constant * times};
  size_t count = 0, left = 0, right = 0;
  const auto is_left = [](const Linear& one, size_t at) { return at < Linear::kMostTerms && one.terms[at].factor != 0; };
  while (is_left(a, left) || is_left(b, right)) {
    const bool from_a = is_left(a, left) && (!is_left(b, right) || a.terms[left].variable <= b.terms[right].variable);
    const bool from_b = is_left(b, right) && (!is_left(a, left) || b.terms[right].variable <= a.terms[left].variable);
    Term term{from_a ? a.terms[left].variable : b.terms[right].variable, 0};
    if (from_a) term.factor += a.terms[left++].factor;
    if (from_b) term.factor += b.terms[right++].factor * times;
    if (term.factor == 0) continue;
    if (count == Linear::kMostTerms) return std::nullopt;
    out.terms[count++] = term;
  }
  return out;
}

}  // namespace

uint32_t Linear::factor(int32_t variable) const {
  for (const Term& term : terms)
    if (term.factor != 0 && term.variable == variable) return term.factor;
  return 0;
}

namespace {

constexpr int kMostOperators = 8;  // of operators in each other; none that is written by hand has more

std::optional<Linear> linear_within(const Expr& expr, int depth) {
  if (const int32_t* known = as_constant(expr)) return Linear{{}, static_cast<uint32_t>(*known)};
  if (const int32_t* variable = as_variable(expr)) return Linear{{Term{*variable, 1}}, 0};
  const auto* node = std::get_if<checked::Binary>(&expr.node);
  if (node == nullptr || depth == 0 || (node->op != BinaryOp::Add && node->op != BinaryOp::Sub && node->op != BinaryOp::Mul && node->op != BinaryOp::Shl))
    return std::nullopt;
  auto left = linear_within(*node->left, depth - 1), right = linear_within(*node->right, depth - 1);
  if (!left || !right) return std::nullopt;
  if (node->op == BinaryOp::Add) return sum(*left, *right, 1);
  if (node->op == BinaryOp::Sub) return sum(*left, *right, UINT32_MAX);
  if (node->op == BinaryOp::Mul && left->is_constant()) std::swap(left, right);
  if (!right->is_constant()) return std::nullopt;
  return sum({}, *left, node->op == BinaryOp::Mul ? right->constant : 1U << (right->constant & 31));
}

}  // namespace

std::optional<Linear> linear(const Expr& expr) { return linear_within(expr, kMostOperators); }

std::optional<Linear> linear(const checked::Place& place) {
  if (place.offset == nullptr || (place.number == 0 && is_simple(*place.offset))) return std::nullopt;
  auto out = linear(*place.offset);
  if (out) out->constant += static_cast<uint32_t>(place.number);
  return out;
}

std::optional<MoveBy> move_of(const Expr* expr) {
  if (expr == nullptr) return std::nullopt;
  if (const auto* step = std::get_if<checked::Step>(&expr->node))
    return step->place.offset == nullptr ? std::optional(MoveBy{step->place.number, static_cast<uint32_t>(step->delta)}) : std::nullopt;
  const auto* set = std::get_if<checked::Assign>(&expr->node);
  if (set == nullptr || set->target.offset != nullptr) return std::nullopt;
  auto value = linear(*set->value);
  if (!value) return std::nullopt;
  if (set->op == BinaryOp::Sub) value->constant = 0 - value->constant;
  const bool adds = set->op == BinaryOp::Add || set->op == BinaryOp::Sub;
  if (set->op && (!adds || !value->is_constant())) return std::nullopt;
  if (!set->op && value->terms != Linear{{Term{set->target.number, 1}}, 0}.terms) return std::nullopt;
  return MoveBy{set->target.number, value->constant};
}

std::optional<std::pair<int32_t, int32_t>> constant_of(const Expr* expr) {
  const auto* set = expr == nullptr ? nullptr : std::get_if<checked::Assign>(&expr->node);
  if (set == nullptr || set->op || set->target.offset != nullptr || as_constant(*set->value) == nullptr) return std::nullopt;
  return std::pair(set->target.number, *as_constant(*set->value));
}

}  // namespace ipos::compiler
