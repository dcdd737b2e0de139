// t[i].c = t[i].b * 2; computes 3 * i once: a temporary holds the number of the element, and one ADD moves it from one member to
// the next. Only where the index is the same for all uses: nobody else writes its variables, nor does the statement before its end.
#include <algorithm>
#include <cstddef>

#include "compiler/codegen/generator.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {

using checked::BinaryOp;
using checked::Expr;

namespace {

bool equal(const Expr& a, const Expr& b) {
  if (as_constant(a) != nullptr && as_constant(b) != nullptr) return *as_constant(a) == *as_constant(b);
  if (as_variable(a) != nullptr && as_variable(b) != nullptr) return *as_variable(a) == *as_variable(b);
  const auto* left = std::get_if<checked::Binary>(&a.node);
  const auto* right = std::get_if<checked::Binary>(&b.node);
  return left != nullptr && right != nullptr && left->op == right->op && equal(*left->left, *right->left) &&
         equal(*left->right, *right->right);
}

// Sums and products of constants and variables: nothing that could fault, or have an effect.
bool is_plain(const Expr& expr) {
  if (is_simple(expr)) return true;
  const auto* node = std::get_if<checked::Binary>(&expr.node);
  return node != nullptr && (node->op == BinaryOp::Mul || node->op == BinaryOp::Add || node->op == BinaryOp::Sub || node->op == BinaryOp::Shl) &&
         is_plain(*node->left) && is_plain(*node->right);
}

// Its number is computed: of *p it is what p holds.
bool is_computed(const checked::Place& place) { return place.offset != nullptr && (place.number != 0 || !is_simple(*place.offset)); }

const checked::Place* place_of(const Expr& expr) {
  if (const auto* load = std::get_if<checked::Load>(&expr.node)) return &load->place;
  const auto* assign = std::get_if<checked::Assign>(&expr.node);
  return assign == nullptr ? nullptr : &assign->target;
}

}  // namespace

void FunctionGenerator::find_pointers(const Expr& expr) {
  const auto* whole = std::get_if<checked::Assign>(&expr.node);
  if (options_.as_written || whole == nullptr) return;
  std::vector<checked::ExprPtr> offsets;
  bool is_straight = true;  // each of its parts is executed once, and only the last one writes
  checked::walk(expr, [&](const Expr& part) {
    const auto* binary = std::get_if<checked::Binary>(&part.node);
    is_straight &= &part == &expr || std::holds_alternative<checked::Constant>(part.node) ||
                   std::holds_alternative<checked::Load>(part.node) || std::holds_alternative<checked::Unary>(part.node) ||
                   (binary != nullptr && binary->op != BinaryOp::LogicalAnd && binary->op != BinaryOp::LogicalOr);
    const checked::Place* place = place_of(part);
    if (place != nullptr && is_computed(*place) && held(*place) == nullptr) offsets.push_back(place->offset);
  });
  if (!is_straight) return;
  for (size_t n = 0; n < offsets.size(); ++n) {
    const Expr& offset = *offsets[n];
    const auto same = [&](checked::ExprPtr other) { return equal(offset, *other); };
    const auto here = offsets.begin() + static_cast<std::ptrdiff_t>(n);
    if (!is_plain(offset) || as_constant(offset) != nullptr || std::any_of(offsets.begin(), here, same)) continue;
    if (std::none_of(here + 1, offsets.end(), same)) continue;
    bool same_for_all = true;
    checked::walk(offset, [&](const Expr& part) {
      const int32_t* variable = as_variable(part);
      same_for_all &= variable == nullptr || (stays(*variable) && (whole->target.offset != nullptr || whole->target.number != *variable));
    });
    if (same_for_all) pointers_.push_back({offsets[n], temporary(), std::nullopt});
  }
}

FunctionGenerator::Pointer* FunctionGenerator::pointer_to(const checked::Place& place) {
  const auto found = std::find_if(pointers_.begin(), pointers_.end(), [&](const Pointer& pointer) {
    return is_computed(place) && equal(*pointer.offset, *place.offset);
  });
  return found == pointers_.end() ? nullptr : &*found;
}

int32_t FunctionGenerator::moved_to(Pointer& pointer, int32_t number, Span span) {
  // Modulo 2^32, as the unit adds.
  if (pointer.number)
    operate(BinaryOp::Add, pointer.variable, {true, static_cast<int32_t>(static_cast<uint32_t>(number) - static_cast<uint32_t>(*pointer.number))}, span);
  else
    number_into({number, pointer.offset}, pointer.variable, span);
  pointer.number = number;
  return pointer.variable;
}

}  // namespace ipos::compiler
