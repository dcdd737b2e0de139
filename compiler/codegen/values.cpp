// Expressions into variables. Commands have two addresses, so `a = b + c` is SET a = b, ADD a + c; the target
// itself is the accumulator unless the rest of the expression uses it, or somebody sees each of its values.
#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/codegen/generator.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/fold.hpp"
#include "compiler/sema/ranges.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;
using vm::Opcode;

namespace {

struct ArithmeticRow {
  BinaryOp op;
  Opcode variable;
  Opcode constant;
  bool commutes;
  int32_t neutral;  // right operand that changes nothing
  bool has_neutral;
};
// `>>` is the arithmetic shift (IPOSplus p. 196).
constexpr ArithmeticRow kArithmetic[] = {
    {BinaryOp::Mul, Opcode::MulHH, Opcode::MulHK, true, 1, true},
    {BinaryOp::Div, Opcode::DivHH, Opcode::DivHK, false, 1, true},
    {BinaryOp::Mod, Opcode::ModHH, Opcode::ModHK, false, 0, false},
    {BinaryOp::Add, Opcode::AddHH, Opcode::AddHK, true, 0, true},
    {BinaryOp::Sub, Opcode::SubHH, Opcode::SubHK, false, 0, true},
    {BinaryOp::Shl, Opcode::ShlHH, Opcode::ShlHK, false, 0, true},
    {BinaryOp::Shr, Opcode::AshrHH, Opcode::AshrHK, false, 0, true},
    {BinaryOp::And, Opcode::AndHH, Opcode::AndHK, true, -1, true},
    {BinaryOp::Xor, Opcode::XorHH, Opcode::XorHK, true, 0, true},
    {BinaryOp::Or, Opcode::OrHH, Opcode::OrHK, true, 0, true},
};

const ArithmeticRow* arithmetic_row(BinaryOp op) {
  for (const ArithmeticRow& row : kArithmetic)
    if (row.op == op) return &row;
  return nullptr;  // a comparison, && or ||
}

bool is_neutral(BinaryOp op, int32_t right) {
  const ArithmeticRow& row = *arithmetic_row(op);
  return row.has_neutral && right == row.neutral;
}

bool is_variable(const Expr& expr, int32_t variable) {
  const int32_t* direct = as_variable(expr);
  return direct != nullptr && *direct == variable;
}

Uses place_uses(const checked::Place& place, int32_t variable, Uses kind) {
  return place.offset != nullptr || place.number == variable ? kind : Uses{};
}

}  // namespace

const int32_t* as_constant(const Expr& expr) {
  const auto* node = std::get_if<checked::Constant>(&expr.node);
  return node == nullptr ? nullptr : &node->value;
}

const int32_t* as_variable(const Expr& expr) {
  const auto* node = std::get_if<checked::Load>(&expr.node);
  return node == nullptr || node->place.offset != nullptr ? nullptr : &node->place.number;
}

Uses uses(const Expr& expr, int32_t variable) {
  Uses out;
  if (is_temporary(variable)) return out;
  const auto add = [&](Uses more) {
    out.read |= more.read;
    out.write |= more.write;
  };
  checked::walk(expr, [&](const Expr& part) {
    if (const auto* node = std::get_if<checked::Load>(&part.node)) {
      add(place_uses(node->place, variable, {true, false}));
    } else if (const auto* step = std::get_if<checked::Step>(&part.node)) {
      add(place_uses(step->place, variable, {true, true}));
    } else if (const auto* assign = std::get_if<checked::Assign>(&part.node)) {
      add(place_uses(assign->target, variable, {assign->op.has_value(), true}));
    } else if (std::holds_alternative<checked::Call>(part.node) ||
               std::holds_alternative<checked::SystemCall>(part.node) ||
               std::holds_alternative<checked::CopyBlock>(part.node)) {
      add({true, true});
    }
  });
  return out;
}

bool acts_at_once(int32_t variable) {
  const auto number = static_cast<uint32_t>(variable);
  if (number >= stdlib::kFirstSystemVariable && number <= kLastReservedVariable) return true;
  const auto has_number = [&](const stdlib::UsedVariable& row) { return row.number == number; };
  const auto* const row = std::ranges::find_if(stdlib::kUsedVariables, has_number);
  return row != std::end(stdlib::kUsedVariables) && row->use != stdlib::VariableUse::Nothing;
}

FunctionGenerator::Operand FunctionGenerator::value(const Expr& expr) {
  if (const int32_t* known = as_constant(expr)) return {true, *known};
  if (const int32_t* direct = as_variable(expr)) return {false, *direct};
  if (const auto* node = std::get_if<checked::Assign>(&expr.node)) return assign(*node, expr.span);
  if (const auto* node = std::get_if<checked::Step>(&expr.node)) return step(*node, expr.span, true);
  if (const auto* node = std::get_if<checked::Comma>(&expr.node)) {
    effect(*node->left);
    return value(*node->right);
  }
  if (const Held* kept = held(expr)) return {false, kept->variable};
  const int32_t result = temporary();
  into(expr, result);
  return {false, result};
}

int32_t FunctionGenerator::variable(const Expr& expr) {
  const Operand operand = value(expr);
  if (!operand.constant) return operand.value;
  const int32_t copy = temporary();
  set(copy, operand, expr.span);
  return copy;
}

void FunctionGenerator::into(const Expr& expr, int32_t target) {
  const Hold hold(top_);
  if (is_simple(expr) || held(expr) != nullptr) return set(target, value(expr), expr.span);
  if (const auto* node = std::get_if<checked::Load>(&expr.node))
    return load_into(node->place, target, expr.span);
  if (const auto* node = std::get_if<checked::Conditional>(&expr.node))
    return conditional_into(*node, target, expr.span);
  if (const auto* node = std::get_if<checked::Binary>(&expr.node)) {
    if (arithmetic_row(node->op) != nullptr) return arithmetic(*node, target, expr.span);
    return truth_into(expr, target);
  }
  if (const auto* node = std::get_if<checked::Unary>(&expr.node)) {
    if (node->op == checked::UnaryOp::Not) return truth_into(expr, target);
    if (node->op == checked::UnaryOp::BitNot) {
      const int32_t operand = variable(*node->operand);
      emit(Opcode::NotH, expr.span, {target, operand});
      return;
    }
    // The product with -1 is the only way to negate in place.
    const int32_t result = is_variable(*node->operand, target) || !shows_steps(target) ? target : temporary();
    into(*node->operand, result);
    operate(BinaryOp::Mul, result, {true, -1}, expr.span);
    return set(target, {false, result}, expr.span);
  }
  if (const auto* node = std::get_if<checked::Step>(&expr.node)) {
    const int32_t source = node->place.number;
    if (!node->prefix && node->place.offset == nullptr && source != target) {
      set(target, {false, source}, expr.span);
      step(*node, expr.span, false);
      return;
    }
  }
  if (const auto* node = std::get_if<checked::Comma>(&expr.node)) {
    effect(*node->left);
    return into(*node->right, target);
  }
  set(target, value(expr), expr.span);
}

void FunctionGenerator::arithmetic(const checked::Binary& node, int32_t target, Span span) {
  const Expr* left = node.left;
  const Expr* right = node.right;
  const bool order_unseen = !has_effect(*left) && !has_effect(*right);
  if (arithmetic_row(node.op)->commutes && order_unseen && !is_variable(*left, target) &&
      (is_variable(*right, target) || (is_simple(*left) && !is_simple(*right))))
    std::swap(left, right);

  if (const int32_t* known = as_constant(*right); known != nullptr && is_neutral(node.op, *known))
    return into(*left, target);
  const Uses later = uses(*right, target);
  if (is_variable(*left, target) && !later.write) return operate(node.op, target, value(*right), span);
  // x - a into a is -a + x.
  if (node.op == BinaryOp::Sub && is_simple(*left) && is_variable(*right, target) && !shows_steps(target)) {
    operate(BinaryOp::Mul, target, {true, -1}, span);
    return operate(BinaryOp::Add, target, value(*left), span);
  }
  const bool in_target = !later.read && !later.write && !shows_steps(target);
  const int32_t result = in_target ? target : temporary();
  into(*left, result);
  operate(node.op, result, value(*right), span);
  set(target, {false, result}, span);
}

// 0 or 1. A variable of the program gets its value once; a temporary may be 1 for a moment, which is shorter.
void FunctionGenerator::truth_into(const Expr& expr, int32_t target) {
  const int yes = new_label();
  if (is_temporary(target)) {
    set(target, {true, 1}, expr.span);
    branch(expr, yes, true);
    set(target, {true, 0}, expr.span);
    return place(yes);
  }
  const int end = new_label();
  branch(expr, yes, true);
  set(target, {true, 0}, expr.span);
  jump(end, expr.span);
  place(yes);
  set(target, {true, 1}, expr.span);
  place(end);
}

void FunctionGenerator::conditional_into(const checked::Conditional& node, int32_t target, Span span) {
  const int otherwise = new_label();
  const int end = new_label();
  branch(*node.condition, otherwise, false);
  into(*node.then, target);
  jump(end, span);
  place(otherwise);
  into(*node.otherwise, target);
  place(end);
}

void FunctionGenerator::load_into(const checked::Place& place, int32_t target, Span span) {
  int32_t from = 0;
  if (is_temporary(target) && !is_simple(*place.offset) && pointer_to(place) == nullptr && held(place) == nullptr) {
    number_into(place, target, span);
    from = target;
  } else {
    from = address(place, span);
  }
  emit(Opcode::SetiLoad, span, {target, from});
}

// The variable that holds the number of a place.
int32_t FunctionGenerator::address(const checked::Place& place, Span span) {
  if (const Held* kept = held(place)) return kept->variable;
  if (Pointer* pointer = pointer_to(place)) return moved_to(*pointer, place.number, span);
  if (place.number == 0) return variable(*place.offset);
  const int32_t result = temporary();
  number_into(place, result, span);
  return result;
}

void FunctionGenerator::operate(BinaryOp op, int32_t target, Operand right, Span span) {
  const ArithmeticRow& row = *arithmetic_row(op);
  if (right.constant && is_neutral(op, right.value)) return;
  emit(right.constant ? row.constant : row.variable, span, {target, right.value});
}

void FunctionGenerator::set(int32_t target, Operand source, Span span) {
  if (!source.constant && source.value == target) return;
  emit(source.constant ? Opcode::SetHK : Opcode::SetHH, span, {target, source.value});
}

// An operand evaluated before `later`: copied when that may change it.
FunctionGenerator::Operand FunctionGenerator::guarded(Operand operand, const Expr& later, Span span) {
  if (operand.constant || !uses(later, operand.value).write) return operand;
  const int32_t copy = temporary();
  set(copy, operand, span);
  return {false, copy};
}

}  // namespace ipos::compiler
