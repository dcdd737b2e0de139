// Variables of one statement or condition that are taken for each other. Where the order of two does not matter, as in a sum,
// this cannot be seen, and is no mistake.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/ast/print.hpp"
#include "compiler/mutants/finder.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/walk.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler::mutants {
namespace {

using checked::BinaryOp;
using checked::Expr;
using checked::Place;

// The place that a node reads or writes by itself.
const Place* place_of(const Expr& expr) {
  if (const auto* load = std::get_if<checked::Load>(&expr.node)) return &load->place;
  if (const auto* step = std::get_if<checked::Step>(&expr.node)) return &step->place;
  if (const auto* assign = std::get_if<checked::Assign>(&expr.node)) return &assign->target;
  return nullptr;
}
Place* place_of(Expr& expr) { return const_cast<Place*>(place_of(std::as_const(expr))); }

// One of the program's own: a system variable is not taken for one of them.
bool is_own(const Place& place) {
  return place.offset == nullptr && stdlib::find_system_variable(static_cast<uint16_t>(place.number)) == nullptr;
}

bool is_symmetric(BinaryOp op) {
  switch (op) {
    case BinaryOp::Mul:
    case BinaryOp::Add:
    case BinaryOp::Eq:
    case BinaryOp::Ne:
    case BinaryOp::And:
    case BinaryOp::Xor:
    case BinaryOp::Or:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: return true;
    default: return false;
  }
}

// What an expression computes, as a text that is the same for expressions that cannot be told apart: sides of symmetric
// operators are in the order of their texts, and a > b is b < a. Empty where it does more than compute.
class Meaning {
 public:
  Meaning(int32_t one, int32_t other) : one_(one), other_(other) {}

  // Of a condition only whether it is 0 is seen: a - b says the same as a != b.
  std::string of_condition(const Expr& expr) const {
    const auto* node = std::get_if<checked::Binary>(&expr.node);
    if (node == nullptr || node->op != BinaryOp::Sub) return of(expr);
    checked::Binary difference = *node;
    difference.op = BinaryOp::Ne;
    return of(difference);
  }

  std::string of(const Expr& expr) const {
    if (const auto* node = std::get_if<checked::Constant>(&expr.node)) return std::to_string(node->value);
    if (const auto* node = std::get_if<checked::Load>(&expr.node))
      return fmt::format("H{}[{}]", renamed(node->place.number), node->place.offset == nullptr ? "" : of(*node->place.offset));
    if (const auto* node = std::get_if<checked::Unary>(&expr.node))
      return fmt::format("({} {})", static_cast<int>(node->op), of(*node->operand));
    if (const auto* node = std::get_if<checked::Binary>(&expr.node)) return of(*node);
    if (const auto* node = std::get_if<checked::Conditional>(&expr.node))
      return fmt::format("({} ? {} : {})", of(*node->condition), of(*node->then), of(*node->otherwise));
    if (const auto* node = std::get_if<checked::Assign>(&expr.node); node != nullptr && node->target.offset == nullptr)
      return of(*node);
    return fmt::format("{}", static_cast<const void*>(&expr));  // like itself only, whatever its variables are
  }

 private:
  int32_t renamed(int32_t variable) const { return variable == one_ ? other_ : variable == other_ ? one_ : variable; }

  // a = b = 5 gives both the same.
  std::string of(const checked::Assign& node) const {
    if (node.op) return fmt::format("(H{} {}= {})", renamed(node.target.number), ast::spelling(*node.op), of(*node.value));
    std::vector<int32_t> targets{renamed(node.target.number)};
    const Expr* value = node.value;
    for (const auto* inner = std::get_if<checked::Assign>(&value->node);
         inner != nullptr && !inner->op && inner->target.offset == nullptr; inner = std::get_if<checked::Assign>(&value->node)) {
      targets.push_back(renamed(inner->target.number));
      value = inner->value;
    }
    std::sort(targets.begin(), targets.end());
    return fmt::format("(H{} = {})", fmt::join(targets, " = H"), of(*value));
  }

  std::string of(const checked::Binary& node) const {
    std::vector<std::string> sides;
    if (is_symmetric(node.op))
      collect(node, node.op, sides);
    else
      sides = {of(*node.left), of(*node.right)};
    BinaryOp op = node.op;
    if (op == BinaryOp::Gt || op == BinaryOp::Ge) {
      std::swap(sides[0], sides[1]);
      op = op == BinaryOp::Gt ? BinaryOp::Lt : BinaryOp::Le;
    }
    if (is_symmetric(op)) std::sort(sides.begin(), sides.end());
    return fmt::format("({})", fmt::join(sides, fmt::format(" {} ", ast::spelling(op))));
  }

  // a + (b + c) has three sides; a == (b == c) has two.
  void collect(const checked::Binary& node, BinaryOp op, std::vector<std::string>& sides) const {
    for (const Expr* side : {node.left, node.right}) {
      const auto* inner = std::get_if<checked::Binary>(&side->node);
      const bool chained = op != BinaryOp::Eq && op != BinaryOp::Ne;
      if (chained && inner != nullptr && inner->op == op)
        collect(*inner, op, sides);
      else
        sides.push_back(of(*side));
    }
  }

  int32_t one_;
  int32_t other_;
};

}  // namespace

std::string Finder::name_of(int32_t variable) const {
  for (const vm::Symbol& symbol : program_.symbols) {
    const int32_t element = variable - symbol.variable;
    if (element < 0 || element >= symbol.count) continue;
    return symbol.count == 1 ? symbol.name : fmt::format("{}[{}]", symbol.name, element);
  }
  return fmt::format("H{}", variable);
}

void Finder::swap_variables(Expr& part, bool is_condition) {
  std::vector<Expr*> users;
  std::vector<int32_t> variables;  // each once, as they come
  checked::walk(part, [&](const Expr& expr) {
    const Place* place = place_of(expr);
    if (place == nullptr || !is_own(*place)) return;
    users.push_back(const_cast<Expr*>(&expr));  // the tree is ours to change
    if (std::find(variables.begin(), variables.end(), place->number) == variables.end()) variables.push_back(place->number);
  });
  for (size_t n = 1; n < variables.size(); ++n) {
    const int32_t one = variables[n - 1];
    const int32_t other = variables[n];
    const auto meaning = [&](int32_t first, int32_t second) {
      const Meaning text(first, second);
      return is_condition ? text.of_condition(part) : text.of(part);
    };
    if (meaning(one, other) == meaning(one, one)) continue;
    Edits edits;
    for (Expr* user : users) {
      Expr changed = *user;
      Place& place = *place_of(changed);
      if (place.number != one && place.number != other) continue;
      place.number = place.number == one ? other : one;
      edits.exprs.emplace_back(user, changed);
    }
    add(Kind::Variables, part.span, fmt::format("{} and {} swapped", name_of(one), name_of(other)), std::move(edits));
  }
}

}  // namespace ipos::compiler::mutants
