// Visits all nodes of a syntax tree, outer ones first, in the order of the source. Recursion is safe: the
// parser bounds the depth.
#pragma once

#include "compiler/ast/ast.hpp"

namespace ipos::compiler::ast {

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

// visit(const Expr&)
template <typename Visit>
void walk(const Expr* expr, Visit& visit) {
  if (expr == nullptr) return;
  visit(*expr);
  const auto inner = [&visit](auto... parts) { (walk(static_cast<const Expr*>(parts), visit), ...); };
  std::visit(
      Overloaded{
          [](const Number&) {}, [](const Name&) {}, [&](const Member& node) { inner(node.base); },
          [&](const Index& node) { inner(node.base, node.index); },
          [&](const Deref& node) { inner(node.number); }, [&](const Numof& node) { inner(node.object); },
          [&](const Unary& node) { inner(node.operand); }, [&](const Step& node) { inner(node.operand); },
          [&](const Binary& node) { inner(node.left, node.right); },
          [&](const Conditional& node) { inner(node.condition, node.then, node.otherwise); },
          [&](const Assign& node) { inner(node.target, node.value); },
          [&](const Comma& node) { inner(node.left, node.right); },
          [&](const Call& node) {
            for (const Expr* argument : node.arguments) walk(argument, visit);
          }},
      expr->node);
}

// visit(const Stmt&) and visit(const Expr&)
template <typename Visit>
void walk(const Stmt* stmt, Visit& visit) {
  if (stmt == nullptr) return;
  visit(*stmt);
  const auto expr = [&visit](const Expr* part) { walk(part, visit); };
  const auto inner = [&visit](const Stmt* part) { walk(part, visit); };
  std::visit(
      Overloaded{
          [&](const ExprStmt& node) { expr(node.expr); },
          [&](const Block& node) {
            for (const Stmt* part : node.body) inner(part);
          },
          [&](const If& node) { expr(node.condition), inner(node.then), inner(node.otherwise); },
          [&](const While& node) { expr(node.condition), inner(node.body); },
          [&](const DoWhile& node) { inner(node.body), expr(node.condition); },
          [&](const For& node) { expr(node.init), expr(node.condition), expr(node.step), inner(node.body); },
          [&](const Switch& node) { expr(node.value), inner(node.body); },
          [&](const Case& node) { expr(node.value); }, [](const auto&) {}},
      stmt->node);
}

}  // namespace ipos::compiler::ast
