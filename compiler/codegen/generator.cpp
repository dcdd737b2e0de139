// Statements. Loops test at their end, so that a turn costs one jump.
#include "compiler/codegen/generator.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "compiler/sema/fold.hpp"

namespace ipos::compiler {

using vm::Opcode;

namespace {

// A condition that one command decides: worth testing twice, before the loop and at its end.
bool one_command(const checked::Expr& condition) {
  if (as_variable(condition)) return true;
  if (const auto* negation = std::get_if<checked::Unary>(&condition.node))
    return negation->op == checked::UnaryOp::Not && one_command(*negation->operand);
  const auto* node = std::get_if<checked::Binary>(&condition.node);
  return node != nullptr && is_comparison(node->op) && is_simple(*node->left) && is_simple(*node->right);
}

}  // namespace

bool true_after(const checked::ExprPtr& init, const checked::ExprPtr& condition) {
  if (init == nullptr || condition == nullptr) return false;
  const auto* set = std::get_if<checked::Assign>(&init->node);
  const auto* test = std::get_if<checked::Binary>(&condition->node);
  if (set == nullptr || set->op || set->target.offset || test == nullptr || !is_comparison(test->op))
    return false;
  const int32_t* first = as_constant(*set->value);
  const int32_t* variable = as_variable(*test->left);
  const int32_t* limit = as_constant(*test->right);
  return first && variable && limit && *variable == set->target.number && !acts_at_once(*variable) &&
         fold(test->op, *first, *limit) == 1;
}

FunctionCode FunctionGenerator::generate() {
  assert(code_.commands.empty());  // once
  const checked::Function& function = program_.functions[function_];
  early_ = program_.observers->is_early(function_);
  statement(*function.body);
  // The end of the function belongs to its closing brace.
  const Span body = function.body->span;
  Location brace = body.end;
  if (brace.valid() && !brace.in_macro()) --brace.value;
  emit(ends_task_ ? Opcode::End : Opcode::Ret, {brace, body.end});
  return std::move(code_);
}

void FunctionGenerator::statement(const checked::Stmt& stmt) {
  const bool outside = std::exchange(early_, early_ || program_.observers->is_early(stmt));
  std::visit([&](const auto& node) { emit_stmt(node, stmt.span); }, stmt.node);
  early_ = outside;
}

void FunctionGenerator::emit_stmt(const checked::ExprStmt& node, Span) {
  const Hold hold(top_);
  find_pointers(*node.expr);
  effect(*node.expr);
  pointers_.clear();
}

void FunctionGenerator::emit_stmt(const checked::Block& node, Span) {
  for (const checked::StmtPtr& stmt : node.body) statement(*stmt);
}

void FunctionGenerator::emit_stmt(const checked::If& node, Span span) {
  if (!options_.as_written && bit_move(node, span)) return;
  const int otherwise = new_label();
  branch(*node.condition, otherwise, false);
  statement(*node.then);
  if (node.otherwise == nullptr) return place(otherwise);
  const int end = new_label();
  jump(end, span);
  place(otherwise);
  statement(*node.otherwise);
  place(end);
}

void FunctionGenerator::emit_stmt(const checked::While& node, Span) {
  loop({nullptr, node.condition, nullptr, node.body}, false);
}

void FunctionGenerator::emit_stmt(const checked::For& node, Span) {
  if (!options_.as_written && copy_loop(node)) return;
  if (node.init != nullptr) effect(*node.init);
  loop({node.init, node.condition, node.step, node.body}, true_after(node.init, node.condition));
}

void FunctionGenerator::loop(const LoopParts& parts, bool first_test_known) {
  const Hold hold(top_);
  const size_t held = held_.size(), counters = counters_.size();
  const checked::ExprPtr& condition = parts.condition;
  const int top = new_label();
  const int test = new_label();
  const int next = new_label();
  const int end = new_label();
  const bool endless = condition == nullptr || (as_constant(*condition) && *as_constant(*condition) != 0);
  const bool tests_first = !endless && !first_test_known;
  const bool tests_twice = tests_first && one_command(*condition);
  if (tests_twice) branch(*condition, end, false);
  if (!endless) hold_numbers(parts);
  if (tests_first && !tests_twice) jump(test, condition->span);
  place(top);
  breaks_.push_back(end);
  continues_.push_back(next);
  statement(*parts.body);
  breaks_.pop_back();
  continues_.pop_back();
  place(next);
  if (parts.step != nullptr) effect(*parts.step);
  place(test);
  if (endless)
    jump(top, condition != nullptr ? condition->span : parts.body->span);
  else
    branch(*condition, top, true);
  place(end);
  held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(held), held_.end());
  counters_.erase(counters_.begin() + static_cast<std::ptrdiff_t>(counters), counters_.end());
}

void FunctionGenerator::emit_stmt(const checked::DoWhile& node, Span) { loop({nullptr, node.condition, nullptr, node.body}, true); }

void FunctionGenerator::emit_stmt(const checked::Switch& node, Span span) {
  std::vector<int> labels;
  for (size_t n = 0; n < node.labels; ++n) labels.push_back(new_label());
  const int end = new_label();
  const int otherwise = node.otherwise ? labels[*node.otherwise] : end;
  std::vector<Case> cases;
  for (const auto& [number, label] : node.cases) cases.push_back({number, labels[label]});
  {
    const Hold hold(top_);
    const Operand selector = selector_of(node);
    if (selector.constant) {
      const auto chosen = std::find_if(cases.begin(), cases.end(), [&](const Case& one) { return one.number == selector.value; });
      jump(chosen == cases.end() ? otherwise : chosen->label, span);
    } else if (options_.as_written) {
      compare_in_order(cases, selector.value, otherwise, node.value->span, span);
    } else {
      in_halves(std::move(cases), selector.value, otherwise, node.value->span);
    }
  }
  switches_.push_back(std::move(labels));
  breaks_.push_back(end);
  statement(*node.body);
  breaks_.pop_back();
  switches_.pop_back();
  place(end);
}

void FunctionGenerator::emit_stmt(const checked::CaseLabel& node, Span) {
  place(switches_.back()[node.label]);
}

void FunctionGenerator::emit_stmt(const checked::Break&, Span span) { jump(breaks_.back(), span); }

void FunctionGenerator::emit_stmt(const checked::Continue&, Span span) { jump(continues_.back(), span); }

void FunctionGenerator::emit_stmt(const checked::Return&, Span span) {
  emit(ends_task_ ? Opcode::End : Opcode::Ret, span);
}

int FunctionGenerator::new_label() {
  code_.labels.push_back(0);
  return static_cast<int>(code_.labels.size() - 1);
}

void FunctionGenerator::place(int label) { code_.labels[static_cast<size_t>(label)] = code_.commands.size(); }

Command& FunctionGenerator::emit(Opcode opcode, Span span, std::initializer_list<int32_t> operands) {
  Command& command = code_.commands.emplace_back();
  command.instruction.opcode = opcode;
  std::copy(operands.begin(), operands.end(), command.instruction.operands.begin());
  command.span = span;
  command.held = top_;
  return command;
}

void FunctionGenerator::jump(int label, Span span) { emit(Opcode::Jmp, span).label = label; }

int32_t FunctionGenerator::temporary() {
  const uint32_t number = top_++;
  code_.temporaries = std::max(code_.temporaries, top_);
  return kTemporary + static_cast<int32_t>(number);
}

}  // namespace ipos::compiler
