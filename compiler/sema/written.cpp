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

}  // namespace

void Written::add_one(const checked::Expr& expr, Numbers& numbers) {
  if (const auto* node = std::get_if<checked::Step>(&expr.node)) mark(numbers, node->place, node->within);
  if (const auto* node = std::get_if<checked::Assign>(&expr.node)) mark(numbers, node->target, node->within);
  if (const auto* node = std::get_if<checked::CopyBlock>(&expr.node)) mark(numbers, node->target, node->count);
  if (const auto* node = std::get_if<checked::SystemCall>(&expr.node))
    written_blocks(*node, [&](uint32_t first, uint32_t count) { mark(numbers, first, count); });
  if (const auto reference = reference_of(expr); reference && reference->kind == ReferenceKind::Call)
    numbers |= of(reference->function);
}

void Written::add(const checked::Expr& expr, Numbers& numbers) {
  checked::walk(expr, [&](const checked::Expr& inner) { add_one(inner, numbers); });
}

void Written::add(const checked::Stmt& stmt, Numbers& numbers) {
  checked::walk(stmt, [&](const checked::Expr& inner) { add_one(inner, numbers); });
}

// Of functions that call each other in a circle, each knows what those behind it write.
const Numbers& Written::of(size_t function) {
  if (of_[function].known) return of_[function].numbers;
  of_[function].known = true;
  Numbers numbers;
  if (program_.functions[function].body != nullptr) add(*program_.functions[function].body, numbers);
  of_[function].numbers = numbers;
  return of_[function].numbers;
}

}  // namespace ipos::compiler
