// Expressions of the tree.
#include <algorithm>

#include "compiler/parse/builder.hpp"

namespace ipos::compiler {
namespace {

unsigned depth(const ast::Expr* expr) { return expr->depth; }

unsigned depth(const ast::Expr* a, const ast::Expr* b) { return std::max(depth(a), depth(b)); }

}  // namespace

ast::ExprPtr Builder::number(Span span, ast::Number number) { return make_expr(span, number, 0); }

ast::ExprPtr Builder::name(ast::Ident ident) { return make_expr(ident.span, ast::Name{ident.text}, 0); }

ast::ExprPtr Builder::call(Span span, ast::Ident function, std::vector<ast::ExprPtr>* arguments) {
  std::span<const ast::ExprPtr> listed;
  if (arguments != nullptr) listed = program_.arena.list(*arguments);
  unsigned deepest = 0;
  for (const ast::Expr* argument : listed) deepest = std::max(deepest, depth(argument));
  return make_expr(span, ast::Call{function, listed}, deepest);
}

ast::ExprPtr Builder::parenthesized(Span span, ast::ExprPtr inner) {
  inner->span = span;
  inner->parenthesized = true;
  return inner;
}

ast::ExprPtr Builder::numof(Span span, ast::ExprPtr object) {
  const unsigned below = depth(object);
  return make_expr(span, ast::Numof{object}, below);
}

ast::ExprPtr Builder::index(Span span, ast::ExprPtr base, ast::ExprPtr index) {
  const unsigned below = depth(base, index);
  return make_expr(span, ast::Index{base, index}, below);
}

ast::ExprPtr Builder::member(Span span, ast::ExprPtr base, ast::Ident member) {
  const unsigned below = depth(base);
  return make_expr(span, ast::Member{base, member}, below);
}

ast::ExprPtr Builder::arrow(Span span, ast::ExprPtr base, Span arrow, ast::Ident member_name) {
  diagnostics_.report(Diag::ArrowOperator, arrow);
  return member(span, base, member_name);
}

ast::ExprPtr Builder::step(Span span, ast::StepOp op, ast::ExprPtr operand) {
  const unsigned below = depth(operand);
  return make_expr(span, ast::Step{op, operand}, below);
}

ast::ExprPtr Builder::unary(Span span, ast::UnaryOp op, ast::ExprPtr operand) {
  const unsigned below = depth(operand);
  return make_expr(span, ast::Unary{op, operand}, below);
}

ast::ExprPtr Builder::deref(Span span, ast::ExprPtr number) {
  const unsigned below = depth(number);
  return make_expr(span, ast::Deref{number}, below);
}

ast::ExprPtr Builder::binary(Span span, ast::BinaryOp op, ast::ExprPtr left, Span op_span,
                             ast::ExprPtr right) {
  const unsigned below = depth(left, right);
  return make_expr(span, ast::Binary{op, left, right, op_span}, below);
}

ast::ExprPtr Builder::conditional(Span span, ast::ExprPtr condition, ast::ExprPtr then,
                                  ast::ExprPtr otherwise) {
  const unsigned below = std::max(depth(condition), depth(then, otherwise));
  return make_expr(span, ast::Conditional{condition, then, otherwise}, below);
}

ast::ExprPtr Builder::assign(Span span, std::optional<ast::BinaryOp> op, ast::ExprPtr target, Span op_span,
                             ast::ExprPtr value) {
  const unsigned below = depth(target, value);
  return make_expr(span, ast::Assign{op, target, value, op_span}, below);
}

ast::ExprPtr Builder::comma(Span span, ast::ExprPtr left, ast::ExprPtr right) {
  const unsigned below = depth(left, right);
  return make_expr(span, ast::Comma{left, right}, below);
}

ast::ExprPtr Builder::replaced(Diag diag, Span first, Span last, ast::ExprPtr operand) {
  diagnostics_.report(diag, {first.begin, last.end});
  return operand;
}

ast::ExprPtr Builder::missing(Diag diag, Span span) {
  diagnostics_.report(diag, span);
  return number(span, {0});
}

}  // namespace ipos::compiler
