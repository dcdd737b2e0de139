// Expressions for what they do: assignments, ++ and --, calls.
#include <utility>

#include "compiler/codegen/generator.hpp"
#include "compiler/sema/expressions.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;
using vm::Opcode;

void FunctionGenerator::effect(const Expr& expr) {
  const Hold hold(top_);
  if (!has_effect(expr)) return;
  if (const auto* node = std::get_if<checked::Assign>(&expr.node)) {
    if (!options_.as_written && bit_move(*node, expr.span)) return;
    assign(*node, expr.span);
    move_held(expr);
  } else if (const auto* move = std::get_if<checked::Step>(&expr.node)) {
    step(*move, expr.span, false);
    move_held(expr);
  } else if (const auto* comma = std::get_if<checked::Comma>(&expr.node)) {
    effect(*comma->left);
    effect(*comma->right);
  } else if (const auto* choice = std::get_if<checked::Conditional>(&expr.node)) {
    conditional_effect(*choice, expr.span);
  } else if (const auto* copy = std::get_if<checked::CopyBlock>(&expr.node)) {
    if (copy->target != copy->source)
      emit(Opcode::Copy, expr.span, {copy->target, copy->source, copy->count});
  } else if (std::holds_alternative<checked::Call>(expr.node)) {
    emit(Opcode::Call, expr.span).reference = reference_of(expr);
  } else if (const auto* call = std::get_if<checked::SystemCall>(&expr.node)) {
    system_call(*call, expr);
  } else if (const auto* binary = std::get_if<checked::Binary>(&expr.node);
             binary != nullptr && (binary->op == BinaryOp::LogicalAnd || binary->op == BinaryOp::LogicalOr)) {
    const int end = new_label();
    branch(*binary->left, end, binary->op == BinaryOp::LogicalOr);
    effect(*binary->right);
    place(end);
  } else {
    value(expr);
  }
}

void FunctionGenerator::conditional_effect(const checked::Conditional& node, Span span) {
  const int otherwise = new_label();
  const int end = new_label();
  branch(*node.condition, otherwise, false);
  effect(*node.then);
  jump(end, span);
  place(otherwise);
  effect(*node.otherwise);
  place(end);
}

FunctionGenerator::Operand FunctionGenerator::assign(const checked::Assign& node, Span span) {
  if (node.target.offset != nullptr) return assign_indirect(node, span);
  const int32_t target = node.target.number;
  if (!node.op) {
    if (is_simple(*node.value)) {
      set(target, value(*node.value), span);
    } else {
      const Assignment outside = std::exchange(assignment_, {span, uses(*node.value, target).read});
      into(*node.value, target);
      assignment_ = outside;
    }
    if (const int32_t* known = as_constant(*node.value)) return {true, *known};
    return {false, target};
  }
  // The old value counts even if the right side changes the target.
  const int32_t result = guarded({false, target}, *node.value, span).value;
  operate(*node.op, result, value(*node.value), span);
  set(target, {false, result}, span);
  return {false, target};
}

FunctionGenerator::Operand FunctionGenerator::assign_indirect(const checked::Assign& node, Span span) {
  // A pointer of the statement moves with each of its uses, so it comes here last.
  const bool moves = pointer_to(node.target) != nullptr;
  int32_t to = moves ? 0 : guarded({false, address(node.target, span)}, *node.value, span).value;
  if (!node.op) {
    const Operand source = value(*node.value);
    int32_t from = source.value;
    if (const Held* kept = source.constant ? held(*node.value) : nullptr) {
      from = kept->variable;
    } else if (source.constant) {
      from = temporary();
      set(from, source, span);
    }
    if (moves) to = address(node.target, span);
    emit(Opcode::SetiStore, span, {to, from});
    return source;
  }
  const bool order_unseen = !has_effect(*node.value);
  Operand right;
  if (order_unseen) right = value(*node.value);
  if (moves) to = address(node.target, span);
  const int32_t result = temporary();
  emit(Opcode::SetiLoad, span, {result, to});
  if (!order_unseen) right = value(*node.value);
  operate(*node.op, result, right, span);
  emit(Opcode::SetiStore, span, {to, result});
  return {false, result};
}

FunctionGenerator::Operand FunctionGenerator::step(const checked::Step& node, Span span, bool value_used) {
  const bool old_used = value_used && !node.prefix;
  const auto move = [&](int32_t variable) {
    emit(node.delta > 0 ? Opcode::AddHK : Opcode::SubHK, span, {variable, 1});
  };
  if (node.place.offset == nullptr) {
    Operand result{false, node.place.number};
    if (old_used) {
      result.value = temporary();
      set(result.value, {false, node.place.number}, span);
    }
    move(node.place.number);
    return result;
  }
  const int32_t at = address(node.place, span);
  const int32_t result = temporary();
  emit(Opcode::SetiLoad, span, {result, at});
  int32_t moved = result;
  if (old_used) {
    moved = temporary();
    set(moved, {false, result}, span);
  }
  move(moved);
  emit(Opcode::SetiStore, span, {at, moved});
  return {false, result};
}

void FunctionGenerator::system_call(const checked::SystemCall& node, const Expr& expr) {
  decltype(vm::Instruction::operands) operands{};
  size_t count = 0;
  for (const checked::Argument& argument : node.arguments) {
    if (const int32_t* known = std::get_if<int32_t>(&argument))
      operands[count++] = *known;
    else if (const checked::ExprPtr* value = std::get_if<checked::ExprPtr>(&argument))
      operands[count++] = variable(**value);
  }
  Command& command = emit(node.opcode, expr.span);
  command.instruction.operands = operands;
  command.reference = reference_of(expr);
}

}  // namespace ipos::compiler
