// `for (i = 0; i < 8; i++) a[i] = b[i];` as one COPY and the last value of i, where nobody else looks at i; `a[i] = 0;` as one SET and COPYs
// that double what is filled, where nobody else writes the elements.
#include <algorithm>

#include "compiler/codegen/generator.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using vm::Opcode;

namespace {

constexpr int64_t kMostCopied = 4095;  // variables of a COPY

// i < 8, i <= 7, i != 8; i > 0, i >= 1, i != 0: the first value that ends the loop.
std::optional<int64_t> end_of(const checked::ExprPtr& condition, int32_t counter, bool up) {
  const auto* node = condition == nullptr ? nullptr : std::get_if<checked::Binary>(&condition->node);
  if (node == nullptr) return std::nullopt;
  const int32_t* variable = as_variable(*node->left);
  const int32_t* limit = as_constant(*node->right);
  if (variable == nullptr || *variable != counter || limit == nullptr) return std::nullopt;
  if (node->op == BinaryOp::Ne || node->op == (up ? BinaryOp::Lt : BinaryOp::Gt)) return *limit;
  if (node->op == (up ? BinaryOp::Le : BinaryOp::Ge)) return int64_t{*limit} + (up ? 1 : -1);
  return std::nullopt;
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
  const auto begin = constant_of(node.init);
  const auto move = move_of(node.step);
  const checked::Expr* expr = only_expression(*node.body);
  if (!begin || !move || expr == nullptr || (move->by != 1 && move->by != UINT32_MAX)) return false;
  const auto counter = begin->first, from = begin->second;
  const bool up = move->by == 1;
  const auto to = end_of(node.condition, counter, up);
  if (!to || move->variable != counter || !is_own(counter)) return false;
  const auto* assign = std::get_if<checked::Assign>(&expr->node);
  if (assign == nullptr || assign->op || !is_element(assign->target, counter)) return false;

  const int64_t count = up ? *to - from : from - *to;
  const int64_t target = int64_t{assign->target.number} + (up ? from : *to + 1);
  const auto can_be_part = [&](int64_t first) {
    if (!in_one_symbol(program_.symbols, first, count) || (counter >= first && counter < first + count)) return false;
    for (int64_t n = first; n < first + count; ++n)
      if (acts_at_once(static_cast<int32_t>(n))) return false;
    return true;
  };
  if (count < 1 || count > kMostCopied || !can_be_part(target)) return false;
  if (const auto* load = std::get_if<checked::Load>(&assign->value->node); load != nullptr && is_element(load->place, counter)) {
    const int64_t source = int64_t{load->place.number} + (up ? from : *to + 1);
    if (!can_be_part(source)) return false;
    // A loop hands a value on where it comes to an element after it has written it; COPY does not.
    if (up ? target > source && target < source + count : source > target && source < target + count) return false;
    emit(Opcode::Copy, expr->span, {static_cast<int32_t>(target), static_cast<int32_t>(source), static_cast<int32_t>(count)});
  } else if (!fill(*assign->value, counter, static_cast<int32_t>(target), static_cast<int32_t>(count))) {
    return false;
  }
  emit(Opcode::SetHK, node.step->span, {counter, static_cast<int32_t>(*to)});
  return true;
}

// The elements that are copied on must stay as they were filled, and so must a variable that they are filled with.
bool FunctionGenerator::fill(const checked::Expr& with, int32_t counter, int32_t target, int32_t count) {
  if (!is_simple(with)) return false;
  if (const int32_t* variable = as_variable(with))
    if (!stays(*variable) || *variable == counter || (*variable >= target && *variable < target + count)) return false;
  for (int32_t n = target; n < target + count; ++n)
    if (!stays(n)) return false;
  set(target, value(with), with.span);
  for (int32_t done = 1; done < count; done *= 2)
    emit(Opcode::Copy, with.span, {target + done, target, std::min(done, count - done)});
  return true;
}

}  // namespace ipos::compiler
