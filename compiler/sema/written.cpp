// Assignments, copies and the blocks that commands write; calls by what their functions write.
#include "compiler/sema/written.hpp"

#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {
namespace {

void mark(Numbers& numbers, uint32_t first, uint32_t count) {
  for (uint32_t n = first; n < first + count && n < kMaxNumbers; ++n) numbers.set(n);
}

void mark(Numbers& numbers, const checked::Place& place, const std::optional<NumberRange>& within) {
  if (place.offset == nullptr) return mark(numbers, static_cast<uint32_t>(place.number), 1);
  if (within) mark(numbers, within->low, within->size());
}

std::optional<size_t> called_by(const checked::Expr& expr) {
  const auto reference = reference_of(expr);
  if (!reference || reference->kind != ReferenceKind::Call) return std::nullopt;
  return reference->function;
}

}  // namespace

// Each function by itself, then what those write that it calls, until nothing is new: functions may call each other in a circle.
Written::Written(const Context& context) : of_(context.contents.size()) {
  for (size_t n = 0; n < of_.size(); ++n)
    for (const checked::Expr* expr : context.contents[n].expressions) add_own(*expr, of_[n]);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t n = of_.size(); n-- > 0;) {
      const Numbers before = of_[n];
      for (const Reference& reference : context.graph[n])
        if (reference.kind == ReferenceKind::Call) of_[n] |= of_[reference.function];
      changed |= of_[n] != before;
    }
  }
}

void Written::add_own(const checked::Expr& expr, Numbers& numbers) {
  if (const auto* node = std::get_if<checked::Step>(&expr.node)) mark(numbers, node->place, node->within);
  if (const auto* node = std::get_if<checked::Assign>(&expr.node)) mark(numbers, node->target, node->within);
  if (const auto* node = std::get_if<checked::CopyBlock>(&expr.node)) mark(numbers, node->target, node->count);
  if (const auto* node = std::get_if<checked::SystemCall>(&expr.node))
    written_blocks(*node, [&](uint32_t first, uint32_t count) { mark(numbers, first, count); });
}

void Written::add_whole(const checked::Expr& expr, Numbers& numbers) const {
  add_own(expr, numbers);
  if (const auto called = called_by(expr)) numbers |= of(*called);
}

void Written::add(const checked::Expr& expr, Numbers& numbers) const {
  checked::walk(expr, [&](const checked::Expr& inner) { add_whole(inner, numbers); });
}

void Written::add(const checked::Stmt& stmt, Numbers& numbers) const {
  checked::walk(stmt, [&](const checked::Expr& inner) { add_whole(inner, numbers); });
}

}  // namespace ipos::compiler
