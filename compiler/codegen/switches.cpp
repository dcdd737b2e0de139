// The way to a case: halves of the cases in the order of their numbers, so that 50 of them take 7 comparisons at most.
#include <algorithm>

#include "compiler/codegen/generator.hpp"

namespace ipos::compiler {

using vm::Opcode;

namespace {

// As many comparisons for equality in a row take no longer than halves of them would.
constexpr size_t kMostInOrder = 3;

}  // namespace

// Read once: where a task, an interrupt or a bus may change the variable between two comparisons, a copy is compared.
FunctionGenerator::Operand FunctionGenerator::selector_of(const checked::Switch& node) {
  Operand selector = value(*node.value);
  if (selector.constant || is_temporary(selector.value) || node.cases.size() < 2) return selector;
  if (!options_.as_written && stays(selector.value)) return selector;
  const int32_t copy = temporary();
  set(copy, selector, node.value->span);
  return {false, copy};
}

void FunctionGenerator::compare_in_order(std::span<const Case> cases, int32_t selector, int otherwise, Span at, Span span) {
  for (const Case& one : cases) emit(Opcode::JmpEqHK, at, {selector, one.number}).label = one.label;
  jump(otherwise, span);
}

void FunctionGenerator::in_halves(std::vector<Case> cases, int32_t selector, int otherwise, Span at) {
  if (cases.size() > kMostInOrder) std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.number < b.number; });
  bisect(cases, selector, otherwise, at, INT32_MIN, INT32_MAX);
}

// `cases` in rising order, if they are many; the selector is known to be from `least` to `most`. What is left over when all other numbers of that
// range have been asked for needs no comparison.
void FunctionGenerator::bisect(std::span<const Case> cases, int32_t selector, int otherwise, Span at, int64_t least, int64_t most) {
  if (cases.size() > kMostInOrder) {
    const auto [left, right] = std::pair(cases.first(cases.size() / 2), cases.subspan(cases.size() / 2));
    const int lower = new_label();
    emit(Opcode::JmpLtHK, at, {selector, right.front().number}).label = lower;
    bisect(right, selector, otherwise, at, right.front().number, most);
    place(lower);
    return bisect(left, selector, otherwise, at, least, int64_t{right.front().number} - 1);
  }
  for (const Case& one : cases) {
    if (least == one.number && most == one.number) return jump(one.label, at);
    emit(Opcode::JmpEqHK, at, {selector, one.number}).label = one.label;
    if (least == one.number) ++least;
  }
  jump(otherwise, at);
}

}  // namespace ipos::compiler
