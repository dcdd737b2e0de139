// Follows the operators as far as constants decide them.
#include "compiler/sema/decided.hpp"

#include <vector>

#include "compiler/ast/walk.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/fold.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

using checked::BinaryOp;
using checked::ExprPtr;

struct Outcome {
  bool truth = false;
  bool plain = false;  // by the value of a constant, which may be a switch; else by the form of the condition
  const char* meant = nullptr;  // a question: what is likely to be meant
};

// The bits a value may have set: those of a mask, or bit 0 of what is 0 or 1.
std::optional<int32_t> bits_of(const checked::Expr& expr) {
  if (const auto* unary = std::get_if<checked::Unary>(&expr.node))
    return unary->op == checked::UnaryOp::Not ? std::optional(1) : std::nullopt;
  const auto* node = std::get_if<checked::Binary>(&expr.node);
  if (node == nullptr) return std::nullopt;
  if (is_comparison(node->op) || node->op == BinaryOp::LogicalAnd || node->op == BinaryOp::LogicalOr)
    return 1;
  if (node->op != BinaryOp::And) return std::nullopt;
  if (const int32_t* mask = constant_value(node->right)) return *mask;
  if (const int32_t* mask = constant_value(node->left)) return *mask;
  return std::nullopt;
}

std::optional<bool> compared(BinaryOp op, int32_t bits, int32_t value) {
  const bool never_equal = (value & ~bits) != 0;
  if (op == BinaryOp::Eq && never_equal) return false;
  if (op == BinaryOp::Ne && never_equal) return true;
  if (bits < 0) return std::nullopt;  // between 0 and the mask from here on
  const auto same = [&](int32_t edge) { return *fold(op, 0, value) == *fold(op, edge, value); };
  const bool order = op == BinaryOp::Lt || op == BinaryOp::Le || op == BinaryOp::Gt || op == BinaryOp::Ge;
  return order && same(bits) ? std::optional(*fold(op, 0, value) != 0) : std::nullopt;
}

BinaryOp mirrored(BinaryOp op) {
  switch (op) {
    case BinaryOp::Lt: return BinaryOp::Gt;
    case BinaryOp::Le: return BinaryOp::Ge;
    case BinaryOp::Gt: return BinaryOp::Lt;
    case BinaryOp::Ge: return BinaryOp::Le;
    default: return op;
  }
}

// A variable compared with a constant.
struct Compared {
  int32_t number;
  BinaryOp op;
  int32_t value;

  bool holds(int64_t at) const {
    switch (op) {
      case BinaryOp::Lt: return at < value;
      case BinaryOp::Le: return at <= value;
      case BinaryOp::Gt: return at > value;
      case BinaryOp::Ge: return at >= value;
      case BinaryOp::Eq: return at == value;
      default: return at != value;
    }
  }
};

std::optional<Compared> comparison(const ExprPtr& expr) {
  const auto* node = std::get_if<checked::Binary>(&expr->node);
  if (node == nullptr || !is_comparison(node->op)) return std::nullopt;
  const int32_t* left = constant_value(node->left);
  const int32_t* right = constant_value(node->right);
  if ((left == nullptr) == (right == nullptr)) return std::nullopt;
  const auto* load = std::get_if<checked::Load>(&(right != nullptr ? node->left : node->right)->node);
  // A system variable may give another value each time.
  if (load == nullptr || load->place.offset != nullptr ||
      load->place.number >= static_cast<int32_t>(stdlib::kFirstSystemVariable))
    return std::nullopt;
  return Compared{load->place.number, right != nullptr ? node->op : mirrored(node->op), right != nullptr ? *right : *left};
}

// Comparisons joined by one operator.
void collect(const ExprPtr& expr, BinaryOp joint, std::vector<Compared>& all) {
  const auto* node = std::get_if<checked::Binary>(&expr->node);
  if (node != nullptr && node->op == joint) {
    collect(node->left, joint, all);
    collect(node->right, joint, all);
  } else if (const auto found = comparison(expr)) {
    all.push_back(*found);
  }
}

// `a == 1 && a == 2` is false whatever a is, `a != 1 || a != 2` is true. Between the values of two comparisons, and beside
// them, nothing changes.
std::optional<Outcome> contradiction(const ExprPtr& expr, BinaryOp joint) {
  std::vector<Compared> all;
  collect(expr, joint, all);
  const bool wanted = joint == BinaryOp::LogicalAnd;
  for (size_t n = 0; n < all.size(); ++n)
    for (size_t earlier = 0; earlier < n; ++earlier) {
      if (all[n].number != all[earlier].number) continue;
      bool possible = false;
      for (const int64_t value : {all[n].value, all[earlier].value})
        for (const int64_t at : {value - 1, value, value + 1})
          possible = possible || (at >= INT32_MIN && at <= INT32_MAX && all[n].holds(at) == wanted &&
                                  all[earlier].holds(at) == wanted);
      if (!possible) return Outcome{!wanted, false, wanted ? "is '||' meant?" : "is '&&' meant?"};
    }
  return std::nullopt;
}

std::optional<Outcome> outcome(const ExprPtr& expr) {
  if (const int32_t* value = constant_value(expr)) return Outcome{*value != 0, true};
  if (const auto* unary = std::get_if<checked::Unary>(&expr->node)) {
    auto inner = unary->op == checked::UnaryOp::Not ? outcome(unary->operand) : std::nullopt;
    if (inner) inner->truth = !inner->truth;
    return inner;
  }
  const auto* node = std::get_if<checked::Binary>(&expr->node);
  if (node == nullptr) return std::nullopt;
  if (node->op == BinaryOp::LogicalAnd || node->op == BinaryOp::LogicalOr) {
    const bool deciding = node->op == BinaryOp::LogicalOr;
    for (const ExprPtr& side : {node->left, node->right})
      if (const auto inner = outcome(side); inner && inner->truth == deciding) return inner;
    return contradiction(expr, node->op);
  }
  const int32_t* left = constant_value(node->left);
  const int32_t* right = constant_value(node->right);
  if (node->op == BinaryOp::And && ((left != nullptr && *left == 0) || (right != nullptr && *right == 0)))
    return Outcome{false, true};
  if (node->op == BinaryOp::Or && ((left != nullptr && *left != 0) || (right != nullptr && *right != 0)))
    return Outcome{true, true};
  if (!is_comparison(node->op) || (left == nullptr) == (right == nullptr)) return std::nullopt;
  const auto bits = bits_of(right != nullptr ? *node->left : *node->right);
  const BinaryOp op = right != nullptr ? node->op : mirrored(node->op);
  const auto truth = bits ? compared(op, *bits, right != nullptr ? *right : *left) : std::nullopt;
  return truth ? std::optional(Outcome{*truth, false}) : std::nullopt;
}

bool has_macro(const ast::Expr& text) {
  bool found = false;
  const auto visit = [&found](const ast::Expr& part) {
    found = found || (std::holds_alternative<ast::Number>(part.node) && part.span.begin.in_macro());
  };
  ast::walk(&text, visit);
  return found;
}

}  // namespace

void check_decided(const ast::Expr& text, const ExprPtr& condition, ConditionOf use, Context& context) {
  if (condition == nullptr) return;
  const auto known = outcome(condition);
  if (!known || (known->plain && has_macro(text))) return;
  const bool endless = known->truth && use != ConditionOf::Choice && constant_value(condition) != nullptr;
  const bool once = !known->truth && use == ConditionOf::LoopEnd && constant_value(condition) != nullptr;
  if (endless || once) return;
  Diagnostic& message = context.diagnostics.report(Diag::DecidedCondition, text.span, {known->truth ? "always" : "never"});
  if (known->meant != nullptr) message.notes.push_back({{}, known->meant});
}

}  // namespace ipos::compiler
