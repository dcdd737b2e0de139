// Statements of the tree.
#include <algorithm>

#include "compiler/parse/builder.hpp"

namespace ipos::compiler {
namespace {

unsigned depth(const ast::Stmt* stmt) { return stmt == nullptr ? 0 : stmt->depth; }

}  // namespace

bool Builder::too_deep(Span span, unsigned depth_below) {
  if (depth_below < ast::kMaxDepth) return false;
  if (!too_deep_reported_) diagnostics_.report(Diag::NestingTooDeep, span, {std::to_string(ast::kMaxDepth)});
  too_deep_reported_ = true;
  return true;
}

ast::StmtPtr Builder::whole(ast::StmtPtr stmt, Span span) {
  return stmt == nullptr ? simple<ast::Empty>(span) : stmt;
}

ast::ExprPtr Builder::whole(ast::ExprPtr expr, Span span) {
  return expr == nullptr ? number(span, {0}) : expr;
}

ast::StmtPtr Builder::block(Span span, std::vector<ast::StmtPtr>* items) {
  std::erase(*items, nullptr);  // declarations and what was skipped
  unsigned deepest = 0;
  for (const ast::Stmt* item : *items) deepest = std::max(deepest, depth(item));
  return make_stmt(span, ast::Block{program_.arena.list(*items)}, deepest);
}

ast::StmtPtr Builder::expression_statement(Span span, ast::ExprPtr expr) {
  return make_stmt(span, ast::ExprStmt{expr}, 0);
}

ast::StmtPtr Builder::if_statement(Span span, ast::ExprPtr condition, ast::StmtPtr then,
                                   ast::StmtPtr otherwise) {
  const unsigned below = std::max(depth(then), depth(otherwise));
  return make_stmt(span, ast::If{whole(condition, span), whole(then, span), otherwise}, below);
}

ast::StmtPtr Builder::while_statement(Span span, ast::ExprPtr condition, ast::StmtPtr body) {
  const unsigned below = depth(body);
  return make_stmt(span, ast::While{whole(condition, span), whole(body, span)}, below);
}

ast::StmtPtr Builder::do_while(Span span, ast::StmtPtr body, ast::ExprPtr condition) {
  const unsigned below = depth(body);
  return make_stmt(span, ast::DoWhile{whole(body, span), whole(condition, span)}, below);
}

ForHead Builder::for_head(ast::ExprPtr init, ast::ExprPtr condition, ast::ExprPtr step) {
  return {init, condition, step};
}

ast::StmtPtr Builder::for_statement(Span span, ForHead head, ast::StmtPtr body) {
  const unsigned below = depth(body);
  return make_stmt(span, ast::For{head.init, head.condition, head.step, whole(body, span)}, below);
}

ast::StmtPtr Builder::switch_statement(Span span, ast::ExprPtr value, ast::StmtPtr body) {
  const unsigned below = depth(body);
  return make_stmt(span, ast::Switch{whole(value, span), whole(body, span)}, below);
}

ast::StmtPtr Builder::case_label(Span span, ast::ExprPtr value) {
  return make_stmt(span, ast::Case{value}, 0);
}

}  // namespace ipos::compiler
