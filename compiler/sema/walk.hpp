// Visits all expressions of a checked statement, outer ones first, in the order of the source.
#pragma once

#include "compiler/sema/checked.hpp"

namespace ipos::compiler::checked {

template <typename Visit>
void walk(const Expr& expr, Visit&& visit);
template <typename Visit>
void walk(const ExprPtr& expr, Visit&& visit);

namespace detail {

template <typename Visit>
struct ExprWalker {
  Visit& visit;
  void operator()(const Constant&) {}
  void operator()(const Load& node) { walk(node.place.offset, visit); }
  void operator()(const Unary& node) { walk(node.operand, visit); }
  void operator()(const Step& node) { walk(node.place.offset, visit); }
  void operator()(const Binary& node) { walk(node.left, visit), walk(node.right, visit); }
  void operator()(const Conditional& node) {
    walk(node.condition, visit);
    walk(node.then, visit);
    walk(node.otherwise, visit);
  }
  void operator()(const Assign& node) { walk(node.target.offset, visit), walk(node.value, visit); }
  void operator()(const Comma& node) { walk(node.left, visit), walk(node.right, visit); }
  void operator()(const CopyBlock&) {}
  void operator()(const Call&) {}
  void operator()(const SystemCall& node) {
    for (const Argument& argument : node.arguments)
      if (const ExprPtr* value = std::get_if<ExprPtr>(&argument)) walk(*value, visit);
  }
};

template <typename Visit>
struct StmtWalker {
  Visit& visit;
  void stmt(const StmtPtr& node) {
    if (node != nullptr) std::visit(*this, node->node);
  }
  void operator()(const ExprStmt& node) { walk(node.expr, visit); }
  void operator()(const Block& node) {
    for (const StmtPtr& part : node.body) stmt(part);
  }
  void operator()(const If& node) { walk(node.condition, visit), stmt(node.then), stmt(node.otherwise); }
  void operator()(const While& node) { walk(node.condition, visit), stmt(node.body); }
  void operator()(const DoWhile& node) { stmt(node.body), walk(node.condition, visit); }
  void operator()(const For& node) {
    walk(node.init, visit);
    walk(node.condition, visit);
    walk(node.step, visit);
    stmt(node.body);
  }
  void operator()(const Switch& node) { walk(node.value, visit), stmt(node.body); }
  void operator()(const CaseLabel&) {}
  void operator()(const Break&) {}
  void operator()(const Continue&) {}
  void operator()(const Return&) {}
};

}  // namespace detail

// Null expressions (left out, or with an error) are skipped.
template <typename Visit>
void walk(const ExprPtr& expr, Visit&& visit) {
  if (expr != nullptr) walk(*expr, visit);
}

template <typename Visit>
void walk(const Expr& expr, Visit&& visit) {
  visit(expr);
  std::visit(detail::ExprWalker<std::remove_reference_t<Visit>>{visit}, expr.node);
}

template <typename Visit>
void walk(const Stmt& stmt, Visit&& visit) {
  std::visit(detail::StmtWalker<std::remove_reference_t<Visit>>{visit}, stmt.node);
}

// Visits a statement and all within it, outer ones first, in the order of the source.
template <typename Visit>
void walk_statements(const StmtPtr& stmt, Visit&& visit) {
  if (stmt == nullptr) return;
  visit(*stmt);
  const auto inner = [&](const StmtPtr& part) { walk_statements(part, visit); };
  if (const auto* node = std::get_if<Block>(&stmt->node))
    for (const StmtPtr& part : node->body) inner(part);
  if (const auto* node = std::get_if<If>(&stmt->node)) inner(node->then), inner(node->otherwise);
  if (const auto* node = std::get_if<While>(&stmt->node)) inner(node->body);
  if (const auto* node = std::get_if<DoWhile>(&stmt->node)) inner(node->body);
  if (const auto* node = std::get_if<For>(&stmt->node)) inner(node->body);
  if (const auto* node = std::get_if<Switch>(&stmt->node)) inner(node->body);
}

}  // namespace ipos::compiler::checked
