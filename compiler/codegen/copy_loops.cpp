// `for (i = 0; i < 8; i++) a[i] = b[i];` as one COPY and the last value of i, where nobody else looks at i.
#include <algorithm>

#include "compiler/codegen/generator.hpp"
#include "compiler/sema/fold.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using vm::Opcode;

namespace {

constexpr int64_t kMostCopied = 4095;  // variables of a COPY

// i = 0
std::optional<std::pair<int32_t, int32_t>> begin_of(const checked::ExprPtr& init) {
  const auto* set = init == nullptr ? nullptr : std::get_if<checked::Assign>(&init->node);
  if (set == nullptr || set->op || set->target.offset != nullptr || as_constant(*set->value) == nullptr) return std::nullopt;
  return std::pair(set->target.number, *as_constant(*set->value));
}

// i < 8, i <= 7, i != 8: the first value that ends the loop.
std::optional<int64_t> end_of(const checked::ExprPtr& condition, int32_t counter) {
  const auto* node = condition == nullptr ? nullptr : std::get_if<checked::Binary>(&condition->node);
  if (node == nullptr) return std::nullopt;
  const int32_t* variable = as_variable(*node->left);
  const int32_t* limit = as_constant(*node->right);
  if (variable == nullptr || *variable != counter || limit == nullptr) return std::nullopt;
  if (node->op == BinaryOp::Lt || node->op == BinaryOp::Ne) return *limit;
  if (node->op == BinaryOp::Le) return int64_t{*limit} + 1;
  return std::nullopt;
}

// i++, ++i, i += 1
bool counts_by_one(const checked::ExprPtr& step, int32_t counter) {
  if (step == nullptr) return false;
  if (const auto* move = std::get_if<checked::Step>(&step->node))
    return move->place.offset == nullptr && move->place.number == counter && move->delta == 1;
  const auto* add = std::get_if<checked::Assign>(&step->node);
  return add != nullptr && add->op == BinaryOp::Add && add->target.offset == nullptr && add->target.number == counter &&
         as_constant(*add->value) != nullptr && *as_constant(*add->value) == 1;
}

bool is_element(const checked::Place& place, int32_t counter) {
  return place.offset != nullptr && as_variable(*place.offset) != nullptr && *as_variable(*place.offset) == counter;
}

const checked::Expr* only_expression(const checked::Stmt& stmt) {
  if (const auto* block = std::get_if<checked::Block>(&stmt.node))
    return block->body.size() == 1 ? only_expression(*block->body.front()) : nullptr;
  const auto* single = std::get_if<checked::ExprStmt>(&stmt.node);
  return single == nullptr ? nullptr : single->expr;
}

// All of them in one declared variable: numbers beyond it may be none of the unit, or the counter.
bool in_one_symbol(const std::vector<vm::Symbol>& symbols, int64_t first, int64_t count) {
  return std::any_of(symbols.begin(), symbols.end(), [&](const vm::Symbol& symbol) {
    return first >= symbol.variable && first + count <= int64_t{symbol.variable} + symbol.count;
  });
}

}  // namespace

bool FunctionGenerator::copy_loop(const checked::For& node) {
  const auto begin = begin_of(node.init);
  if (!begin) return false;
  const auto [counter, from] = *begin;
  const auto to = end_of(node.condition, counter);
  const checked::Expr* expr = only_expression(*node.body);
  if (!to || expr == nullptr || !counts_by_one(node.step, counter) || !is_own(counter)) return false;
  const auto* assign = std::get_if<checked::Assign>(&expr->node);
  const auto* load = assign == nullptr || assign->op ? nullptr : std::get_if<checked::Load>(&assign->value->node);
  if (load == nullptr || !is_element(assign->target, counter) || !is_element(load->place, counter)) return false;

  const int64_t count = *to - from;
  const int64_t target = int64_t{assign->target.number} + from;
  const int64_t source = int64_t{load->place.number} + from;
  if (count < 1 || count > kMostCopied) return false;
  if (!in_one_symbol(program_.symbols, target, count) || !in_one_symbol(program_.symbols, source, count)) return false;
  for (const int64_t first : {target, source}) {
    if (counter >= first && counter < first + count) return false;
    for (int64_t n = first; n < first + count; ++n)
      if (acts_at_once(static_cast<int32_t>(n))) return false;
  }
  // A loop hands a value on where the target comes behind the source; COPY does not.
  if (target > source && target < source + count) return false;
  emit(Opcode::Copy, expr->span, {static_cast<int32_t>(target), static_cast<int32_t>(source), static_cast<int32_t>(count)});
  emit(Opcode::SetHK, node.step->span, {counter, static_cast<int32_t>(*to)});
  return true;
}

}  // namespace ipos::compiler
