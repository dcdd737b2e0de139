// One way through the statements of a loop: what each turn computes, and what it writes.
#include "compiler/codegen/loops.hpp"

#include <algorithm>

#include "compiler/codegen/generator.hpp"
#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/fold.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;
using checked::StmtPtr;

namespace {

constexpr int kMostLoops = 4;  // of loops within a loop

bool continues(const StmtPtr& stmt) {
  bool found = false;
  checked::walk_statements(stmt, [&](const checked::Stmt& part) { found |= std::holds_alternative<checked::Continue>(part.node); });
  return found;
}

}  // namespace

LoopScan::LoopScan(const LoopParts& loop, std::function<bool(int32_t)> stays, std::vector<Counter> around)
    : stays_(std::move(stays)), condition_(loop.condition), counters_(std::move(around)) {
  for (const Counter& one : counters_) assumed_.set(static_cast<size_t>(one.variable));
  if (has_way_in(loop.body)) changed_.set();
  counter_ = counter_of(loop);
  inner_loop(loop, {}, true);
  if ((assumed_ & computed_).any()) changed_.set(), counter_.reset();
  changed_ |= computed_;
}

size_t LoopScan::moves(const Linear& number) const {
  size_t count = 0;
  for (size_t n = 0; n < move_count_; ++n) count += number.factor(moves_[n].variable) * moves_[n].by != 0;
  return count;
}

bool LoopScan::counts(const Expr& condition) const {
  const auto is_moved = [&](const Expr& side) {
    const int32_t* variable = as_variable(side);
    return variable != nullptr && moves_only(*variable) && moves(*linear(side)) != 0;
  };
  const auto* node = std::get_if<checked::Binary>(&condition.node);
  if (node == nullptr) return is_moved(condition);
  if (node->op == BinaryOp::LogicalAnd) return counts(*node->left) || counts(*node->right);
  if (!is_comparison(node->op)) return false;
  return is_moved(*node->left) || is_moved(*node->right);
}

void LoopScan::inner_loop(const LoopParts& loop, At at, bool has_turn) {
  if (++depth_ > kMostLoops) computed_.set();  // not looked at
  const bool outermost = depth_ == 1;
  const auto counter = depth_ > kMostLoops ? std::nullopt : outermost ? counter_ : counter_of(loop);
  if (!outermost && loop.init != nullptr) effect(*loop.init, at);
  if (counter) {
    counters_.push_back(*counter);
    assumed_.set(static_cast<size_t>(counter->variable));
  }
  if (depth_ <= kMostLoops) statement(loop.body, {at.certain && has_turn, !outermost});
  if (counter) counters_.pop_back();
  if (loop.condition != nullptr) expression(*loop.condition, {at.certain, !outermost, outermost});
  if (loop.step != nullptr) effect(*loop.step, {outermost, !outermost});
  --depth_;
}

void LoopScan::statement(const StmtPtr& stmt, At at) {
  const At perhaps{false, at.inner};
  const auto part = [&](const StmtPtr& one, At where) {
    if (one != nullptr) statement(one, where);
  };
  if (const auto* node = std::get_if<checked::ExprStmt>(&stmt->node)) effect(*node->expr, at);
  if (const auto* node = std::get_if<checked::Block>(&stmt->node))
    for (const StmtPtr& one : node->body) {
      part(one, at);
      at.certain = at.certain && !continues(one);
    }
  if (const auto* node = std::get_if<checked::If>(&stmt->node)) {
    expression(*node->condition, at);
    part(node->then, perhaps);
    part(node->otherwise, perhaps);
  }
  if (const auto* node = std::get_if<checked::While>(&stmt->node)) inner_loop({nullptr, node->condition, nullptr, node->body}, at, false);
  if (const auto* node = std::get_if<checked::DoWhile>(&stmt->node)) inner_loop({nullptr, node->condition, nullptr, node->body}, at, true);
  if (const auto* node = std::get_if<checked::For>(&stmt->node))
    inner_loop({node->init, node->condition, node->step, node->body}, at, true_after(node->init, node->condition));
  if (const auto* node = std::get_if<checked::Switch>(&stmt->node)) {
    expression(*node->value, at);
    part(node->body, perhaps);
  }
}

// On its own, or beside a comma: only there a move is followed by that of what is kept.
void LoopScan::effect(const Expr& expr, At at) {
  if (const auto* comma = std::get_if<checked::Comma>(&expr.node)) {
    effect(*comma->left, at);
    return effect(*comma->right, at);
  }
  if (const auto move = move_of(&expr)) {
    if (move_count_ < moves_.size()) moves_[move_count_++] = *move;
    if (at.inner || move_count_ == moves_.size()) write(move->variable, move->variable, changed_);
    return;
  }
  if (std::holds_alternative<checked::Assign>(expr.node)) at.assignment = &expr;
  expression(expr, at);
}

void LoopScan::expression(const Expr& expr, At at) {
  if (as_constant(expr) != nullptr || as_variable(expr) != nullptr) return;
  if (auto number = linear(expr); number && !number->is_constant()) {
    if (at.certain) uses_.push_back({std::move(*number), &expr, nullptr, at.assignment});
    return;
  }
  const bool in_condition = at.condition;
  at.condition = false;
  const At perhaps{false, at.inner};
  if (const auto* node = std::get_if<checked::Load>(&expr.node)) place(node->place, at);
  if (const auto* node = std::get_if<checked::Unary>(&expr.node)) expression(*node->operand, at);
  if (const auto* node = std::get_if<checked::Step>(&expr.node)) {
    write(node->place);
    place(node->place, at);
  }
  if (const auto* node = std::get_if<checked::Binary>(&expr.node)) {
    at.condition = in_condition && node->op == BinaryOp::LogicalAnd;
    expression(*node->left, at);
    const bool both = at.condition || (node->op != BinaryOp::LogicalAnd && node->op != BinaryOp::LogicalOr);
    expression(*node->right, both ? at : perhaps);
  }
  if (const auto* node = std::get_if<checked::Conditional>(&expr.node)) {
    expression(*node->condition, at);
    expression(*node->then, perhaps);
    expression(*node->otherwise, perhaps);
  }
  if (const auto* node = std::get_if<checked::Assign>(&expr.node)) {
    write(node->target);
    place(node->target, at);
    // A constant comes to a computed place by a variable only.
    if (at.certain && !node->op && node->target.offset != nullptr && as_constant(*node->value) != nullptr)
      uses_.push_back({*linear(*node->value), node->value, nullptr, nullptr});
    // A variable is as good a place for a sum as a temporary.
    if (node->op || node->target.offset != nullptr || !linear(*node->value)) expression(*node->value, at);
  }
  if (const auto* node = std::get_if<checked::Comma>(&expr.node)) {
    expression(*node->left, at);
    expression(*node->right, at);
  }
  if (const auto* node = std::get_if<checked::CopyBlock>(&expr.node)) write(node->target, int64_t{node->target} + node->count - 1, changed_);
  if (std::holds_alternative<checked::Call>(expr.node)) changed_.set();
  if (const auto* node = std::get_if<checked::SystemCall>(&expr.node)) {
    if (is_of_the_host(*node)) changed_.set();
    written_blocks(*node, [&](uint32_t first, uint32_t count) { write(first, int64_t{first} + count - 1, changed_); });
    for (const checked::Argument& argument : node->arguments)
      if (const checked::ExprPtr* value = std::get_if<checked::ExprPtr>(&argument)) expression(**value, at);
  }
}

void LoopScan::place(const checked::Place& place, At at) {
  if (place.offset == nullptr) return;
  auto number = linear(place);
  if (!number || number->is_constant()) return expression(*place.offset, at);
  if (at.certain) uses_.push_back({std::move(*number), nullptr, &place, at.assignment});
}

void LoopScan::write(int64_t first, int64_t last, Variables& variables) {
  for (int64_t n = std::max<int64_t>(first, 0); n <= last && n < int64_t{kMaxNumbers}; ++n) variables.set(static_cast<size_t>(n));
}

}  // namespace ipos::compiler
