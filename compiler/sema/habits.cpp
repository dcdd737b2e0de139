// Looks at the syntax tree alone: what the operands mean does not matter here.
#include "compiler/sema/habits.hpp"

#include <fmt/format.h>

#include "compiler/ast/print.hpp"
#include "compiler/ast/walk.hpp"
#include "compiler/sema/fold.hpp"

namespace ipos::compiler {
namespace {

using ast::BinaryOp;

bool is_bitwise(BinaryOp op) { return op == BinaryOp::And || op == BinaryOp::Xor || op == BinaryOp::Or; }

const ast::Binary* binary(const ast::Expr& expr) { return std::get_if<ast::Binary>(&expr.node); }

const ast::Binary* bare_binary(const ast::Expr& expr) { return expr.parenthesized ? nullptr : binary(expr); }

bool bare_comparison(const ast::Expr& expr) {
  const ast::Binary* node = bare_binary(expr);
  return node != nullptr && is_comparison(node->op);
}

bool bare_not(const ast::Expr& expr) {
  const auto* node = std::get_if<ast::Unary>(&expr.node);
  return node != nullptr && node->op == ast::UnaryOp::Not && !expr.parenthesized;
}

// Something that is 0 or 1 by its form.
bool is_truth(const ast::Expr& expr) {
  if (const auto* node = std::get_if<ast::Unary>(&expr.node)) return node->op == ast::UnaryOp::Not;
  if (const auto* number = std::get_if<ast::Number>(&expr.node))
    return number->value == 0 || number->value == 1;
  const ast::Binary* node = binary(expr);
  if (node == nullptr) return false;
  if (is_bitwise(node->op)) {
    if (is_truth(*node->left) && is_truth(*node->right)) return true;
    const auto* one = std::get_if<ast::Number>(&node->right->node);  // (H483 >> 3) & 1
    return node->op == BinaryOp::And && one != nullptr && one->value == 1;
  }
  return is_comparison(node->op) || node->op == BinaryOp::LogicalAnd || node->op == BinaryOp::LogicalOr;
}

bool has_comparison(const ast::Binary& node) { return bare_comparison(*node.left) || bare_comparison(*node.right); }

class Habits {
 public:
  Habits(const SourceMap& sources, Diagnostics& diagnostics) : sources_(sources), diagnostics_(diagnostics) {}

  void operator()(const ast::Expr& expr) {
    if (const auto* node = std::get_if<ast::Binary>(&expr.node)) check(*node);
    if (const auto* node = std::get_if<ast::Assign>(&expr.node)) check(*node);
  }

  void operator()(const ast::Stmt& stmt) {
    const auto* block = std::get_if<ast::Block>(&stmt.node);
    if (block == nullptr) return;
    for (size_t n = 0; n + 1 < block->body.size(); ++n)
      if (std::holds_alternative<ast::Block>(block->body[n + 1]->node)) check_loop(*block->body[n]);
  }

 private:
  void check(const ast::Binary& node) {
    const bool shift = node.op == BinaryOp::Shl || node.op == BinaryOp::Shr;
    // `a == 1 & b == 2` means what it says: both sides are 0 or 1.
    const bool bits = is_bitwise(node.op) && !(is_truth(*node.left) && is_truth(*node.right));
    for (const ast::Expr* side : {node.left, node.right}) {
      const ast::Binary* inner = bare_binary(*side);
      const bool sum = inner != nullptr && (inner->op == BinaryOp::Add || inner->op == BinaryOp::Sub);
      if ((bits && bare_comparison(*side)) || (shift && sum)) return weaker(node, *inner);
      // `a == 1 | b == 2 & c == 3`: read from the left, it is not what it is.
      const bool mixed = inner != nullptr && side == node.right && is_bitwise(node.op) && is_bitwise(inner->op) && inner->op != node.op;
      if (mixed && has_comparison(*inner)) return weaker(node, *inner);
    }
    if (is_comparison(node.op) && bare_comparison(*node.left)) {
      const ast::Binary& inner = *bare_binary(*node.left);
      diagnostics_.report(Diag::ChainedComparison, node.op_span,
                          {std::string(ast::spelling(node.op)), std::string(ast::spelling(inner.op))});
    }
    const bool negated = bare_not(*node.left) && !is_truth(*node.right);
    if (negated && (bits || is_comparison(node.op)))
      diagnostics_.report(Diag::Precedence, node.left->span,
                          {std::string(ast::spelling(node.op)), "!",
                           fmt::format("!a {0} b is (!a) {0} b", ast::spelling(node.op))});
  }

  void weaker(const ast::Binary& outer, const ast::Binary& inner) {
    const bool left = outer.left->span.begin == inner.left->span.begin;
    const std::string form = left ? fmt::format("a {0} b {1} c is (a {0} b) {1} c", ast::spelling(inner.op),
                                                ast::spelling(outer.op))
                                  : fmt::format("a {0} b {1} c is a {0} (b {1} c)", ast::spelling(outer.op),
                                                ast::spelling(inner.op));
    diagnostics_.report(Diag::Precedence, outer.op_span,
                        {std::string(ast::spelling(outer.op)), std::string(ast::spelling(inner.op)), form});
  }

  // `a =+ 5`: the sign touches the '=' and not what follows it.
  void check(const ast::Assign& node) {
    const Location sign_at = node.op_span.end;
    if (node.op || sign_at.in_macro() || node.value->parenthesized || node.value->span.begin != sign_at)
      return;
    const auto* unary = std::get_if<ast::Unary>(&node.value->node);
    const auto* pointer = std::get_if<ast::Deref>(&node.value->node);
    const ast::Expr* operand = unary != nullptr     ? unary->operand
                               : pointer != nullptr ? pointer->number
                                                    : nullptr;
    if (operand == nullptr || operand->span.begin.in_macro()) return;
    if (operand->span.begin.value == sign_at.value + 1) return;
    const SourceFile* file = sources_.file_of(sign_at);
    const char c = file->text[sign_at.value - file->base];
    if (c == '~') return;  // there is no ~=
    diagnostics_.report(Diag::SignBehindAssign, {node.op_span.begin, {sign_at.value + 1}},
                        {std::string(1, c), std::string(1, c), c == '!' ? "!=" : fmt::format("{}=", c)});
  }

  void check_loop(const ast::Stmt& stmt) {
    const auto* with_while = std::get_if<ast::While>(&stmt.node);
    const auto* with_for = std::get_if<ast::For>(&stmt.node);
    const ast::Stmt* body = with_while != nullptr ? with_while->body
                            : with_for != nullptr ? with_for->body
                                                  : nullptr;
    if (body == nullptr || !std::holds_alternative<ast::Empty>(body->node)) return;
    diagnostics_.report(Diag::EmptyLoop, body->span, {with_while != nullptr ? "while" : "for"});
  }

  const SourceMap& sources_;
  Diagnostics& diagnostics_;
};

}  // namespace

void check_habits(const ast::Stmt& body, const SourceMap& sources, Diagnostics& diagnostics) {
  Habits habits(sources, diagnostics);
  ast::walk(&body, habits);
}

}  // namespace ipos::compiler
