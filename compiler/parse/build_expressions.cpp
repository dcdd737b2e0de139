// Expressions of the tree.
#include <algorithm>

#include "compiler/parse/builder.hpp"

namespace ipos::compiler {
namespace {

unsigned depth(const ast::ExprPtr& expr) { return expr->depth; }

unsigned depth(const ast::ExprPtr& a, const ast::ExprPtr& b) { return std::max(depth(a), depth(b)); }

}  // namespace

ast::ExprPtr Builder::make_expr(Span span, decltype(ast::Expr::node) node, unsigned depth_below) {
  if (too_deep(span, depth_below)) return number(span, {0});
  auto expr = std::make_unique<ast::Expr>();
  expr->span = span;
  expr->node = std::move(node);
  expr->depth = static_cast<uint16_t>(depth_below + 1);
  return expr;
}

ast::ExprPtr Builder::number(Span span, ast::Number number) { return make_expr(span, number, 0); }

ast::ExprPtr Builder::name(ast::Ident ident) {
  return make_expr(ident.span, ast::Name{std::move(ident.text)}, 0);
}

ast::ExprPtr Builder::call(Span span, ast::Ident function, std::vector<ast::ExprPtr> arguments) {
  unsigned deepest = 0;
  for (const ast::ExprPtr& argument : arguments) deepest = std::max(deepest, depth(argument));
  return make_expr(span, ast::Call{std::move(function), std::move(arguments)}, deepest);
}

ast::ExprPtr Builder::parenthesized(Span span, ast::ExprPtr inner) {
  inner->span = span;
  inner->parenthesized = true;
  return inner;
}

ast::ExprPtr Builder::numof(Span span, ast::ExprPtr object) {
  const unsigned below = depth(object);
  return make_expr(span, ast::Numof{std::move(object)}, below);
}

ast::ExprPtr Builder::index(Span span, ast::ExprPtr base, ast::ExprPtr index) {
  const unsigned below = depth(base, index);
  return make_expr(span, ast::Index{std::move(base), std::move(index)}, below);
}

ast::ExprPtr Builder::member(Span span, ast::ExprPtr base, ast::Ident member) {
  const unsigned below = depth(base);
  return make_expr(span, ast::Member{std::move(base), std::move(member)}, below);
}

ast::ExprPtr Builder::arrow(Span span, ast::ExprPtr base, Span arrow, ast::Ident member_name) {
  diagnostics_.report(Diag::ArrowOperator, arrow);
  return member(span, std::move(base), std::move(member_name));
}

ast::ExprPtr Builder::step(Span span, ast::StepOp op, ast::ExprPtr operand) {
  const unsigned below = depth(operand);
  return make_expr(span, ast::Step{op, std::move(operand)}, below);
}

ast::ExprPtr Builder::unary(Span span, ast::UnaryOp op, ast::ExprPtr operand) {
  const unsigned below = depth(operand);
  return make_expr(span, ast::Unary{op, std::move(operand)}, below);
}

ast::ExprPtr Builder::deref(Span span, ast::ExprPtr number) {
  const unsigned below = depth(number);
  return make_expr(span, ast::Deref{std::move(number)}, below);
}

ast::ExprPtr Builder::binary(Span span, ast::BinaryOp op, ast::ExprPtr left, Span op_span,
                             ast::ExprPtr right) {
  const unsigned below = depth(left, right);
  return make_expr(span, ast::Binary{op, std::move(left), std::move(right), op_span}, below);
}

ast::ExprPtr Builder::conditional(Span span, ast::ExprPtr condition, ast::ExprPtr then,
                                  ast::ExprPtr otherwise) {
  const unsigned below = std::max(depth(condition), depth(then, otherwise));
  return make_expr(span, ast::Conditional{std::move(condition), std::move(then), std::move(otherwise)},
                   below);
}

ast::ExprPtr Builder::assign(Span span, std::optional<ast::BinaryOp> op, ast::ExprPtr target, Span op_span,
                             ast::ExprPtr value) {
  const unsigned below = depth(target, value);
  return make_expr(span, ast::Assign{op, std::move(target), std::move(value), op_span}, below);
}

ast::ExprPtr Builder::comma(Span span, ast::ExprPtr left, ast::ExprPtr right) {
  const unsigned below = depth(left, right);
  return make_expr(span, ast::Comma{std::move(left), std::move(right)}, below);
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
