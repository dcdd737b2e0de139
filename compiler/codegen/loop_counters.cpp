// What a counter and a place that is computed can be. A place that is computed may be any variable, unless counters with constant bounds say
// which: `for (i = 0; i < 8; i++) a[i] = 0;` writes the eight elements, and no counter.
#include <algorithm>

#include "compiler/codegen/generator.hpp"
#include "compiler/codegen/loops.hpp"
#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/walk.hpp"
#include "vm/isa/coding.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;
using checked::StmtPtr;

namespace {

// Whether the expression may write the variable by its number, or in a way that is not looked through.
bool writes(const Expr& expr, int32_t variable) {
  bool found = false;
  checked::walk(expr, [&](const Expr& part) {
    const auto is = [&](const checked::Place& place) { return place.offset == nullptr && place.number == variable; };
    if (const auto* step = std::get_if<checked::Step>(&part.node)) found |= is(step->place);
    if (const auto* assign = std::get_if<checked::Assign>(&part.node)) found |= is(assign->target);
    if (const auto* copy = std::get_if<checked::CopyBlock>(&part.node)) found |= variable >= copy->target && variable < copy->target + copy->count;
    found |= std::holds_alternative<checked::Call>(part.node);
    const auto* call = std::get_if<checked::SystemCall>(&part.node);
    if (call == nullptr) return;
    found |= is_of_the_host(*call);
    written_blocks(*call, [&](uint32_t first, uint32_t count) { found |= variable >= static_cast<int32_t>(first) && variable < static_cast<int32_t>(first + count); });
  });
  return found;
}

std::optional<Bounds> within_int(Bounds bounds) {
  return bounds.least < INT32_MIN || bounds.most > INT32_MAX ? std::nullopt : std::optional(bounds);
}

// The values for which a body runs that counts from `first` by `step`.
std::optional<Bounds> counted(const Bounds& first, int64_t step, BinaryOp op, const Bounds& limit) {
  const bool up = step > 0;
  int64_t last = up ? limit.most : limit.least;
  if (op == BinaryOp::Ne && limit.least == limit.most && (up ? step == 1 && first.most <= last : step == -1 && first.least >= last))
    op = up ? BinaryOp::Lt : BinaryOp::Gt;
  if (op == BinaryOp::Lt || op == BinaryOp::Gt) last += up ? -1 : 1;
  if (up ? op != BinaryOp::Lt && op != BinaryOp::Le : op != BinaryOp::Gt && op != BinaryOp::Ge) return std::nullopt;
  if (!within_int({last + step, last + step})) return std::nullopt;  // it wraps
  return up ? Bounds{first.least, std::max(first.least, last)} : Bounds{std::min(first.most, last), first.most};
}

}  // namespace

bool has_way_in(const StmtPtr& stmt) {
  size_t cases = 0, own = 0;
  checked::walk_statements(stmt, [&](const checked::Stmt& part) {
    cases += std::holds_alternative<checked::CaseLabel>(part.node);
    if (const auto* choice = std::get_if<checked::Switch>(&part.node)) own += choice->labels;
  });
  return cases != own;
}

bool is_of_the_host(const checked::SystemCall& call) {
  const vm::Flow flow = vm::coding(call.opcode).flow;
  return flow == vm::Flow::System || flow == vm::Flow::SystemCall;
}

std::optional<Counter> LoopScan::counter_of(const LoopParts& loop) const {
  if (loop.init == nullptr || loop.condition == nullptr || loop.step == nullptr) return std::nullopt;
  const auto* init = std::get_if<checked::Assign>(&loop.init->node);
  const auto move = move_of(loop.step);
  const auto* test = std::get_if<checked::Binary>(&loop.condition->node);
  while (test != nullptr && test->op == BinaryOp::LogicalAnd) test = std::get_if<checked::Binary>(&test->left->node);
  if (init == nullptr || init->op || init->target.offset != nullptr || !move || test == nullptr || has_way_in(loop.body)) return std::nullopt;
  const int32_t variable = init->target.number;
  const int32_t* tested = as_variable(*test->left);
  if (tested == nullptr || *tested != variable || move->variable != variable || !stays_(variable)) return std::nullopt;
  bool is_written = writes(*loop.condition, variable);
  checked::walk(*loop.body, [&](const Expr& expr) { is_written |= writes(expr, variable); });
  const auto first = bounds(*init->value), limit = bounds(*test->right);
  if (is_written || !first || !limit) return std::nullopt;
  const auto values = counted(*first, static_cast<int32_t>(move->by), test->op, *limit);
  return values ? std::optional(Counter{variable, *values}) : std::nullopt;
}

void LoopScan::write(const checked::Place& place) {
  if (place.offset == nullptr) return write(place.number, place.number, changed_);
  auto numbers = bounds(*place.offset);
  if (numbers) numbers = within_int({numbers->least + place.number, numbers->most + place.number});
  if (!numbers) numbers = Bounds{0, kMaxNumbers};
  write(numbers->least, numbers->most, computed_);
}

std::optional<Bounds> LoopScan::bounds(const Expr& expr) const {
  if (const int32_t* known = as_constant(expr)) return Bounds{*known, *known};
  if (const int32_t* variable = as_variable(expr)) {
    for (const Counter& one : counters_)
      if (one.variable == *variable) return one.bounds;
    return std::nullopt;
  }
  const auto* node = std::get_if<checked::Binary>(&expr.node);
  if (node == nullptr) return std::nullopt;
  const int32_t* known = as_constant(*node->right);
  if (node->op == BinaryOp::And && known != nullptr && *known >= 0) return Bounds{0, *known};
  if (node->op == BinaryOp::Mod && known != nullptr && *known > 0) return Bounds{1 - int64_t{*known}, *known - 1};
  const auto a = bounds(*node->left);
  const auto b = a ? bounds(*node->right) : std::nullopt;
  if (!b) return std::nullopt;
  if (node->op == BinaryOp::Add) return within_int({a->least + b->least, a->most + b->most});
  if (node->op == BinaryOp::Sub) return within_int({a->least - b->most, a->most - b->least});
  if (node->op != BinaryOp::Mul) return std::nullopt;
  const auto [least, most] = std::minmax({a->least * b->least, a->least * b->most, a->most * b->least, a->most * b->most});
  return within_int({least, most});
}

}  // namespace ipos::compiler
