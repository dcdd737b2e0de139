// Statements: syntax tree to checked tree, with the place rules of break, continue and case, and the warnings
// about statements that are never reached or do nothing.
#pragma once

#include "compiler/ast/ast.hpp"
#include "compiler/sema/context.hpp"
#include "compiler/sema/expressions.hpp"

namespace ipos::compiler {

class StatementChecker {
 public:
  explicit StatementChecker(Context& context) : context_(context), expressions_(context) {}

  checked::StmtPtr function_body(const ast::Stmt& body) { return statement(body).stmt; }

 private:
  // A checked statement, and whether what stands after it can be reached.
  struct Result {
    checked::StmtPtr stmt = nullptr;
    bool falls_through = true;
  };

  // A loop or switch around the statement.
  struct Frame {
    checked::Switch* target = nullptr;  // null: a loop
    bool left_by_break = false;
    std::vector<std::pair<int32_t, size_t>> cases = {};  // of the switch: value and label
    std::vector<Span> places = {};                       // of these
    Span otherwise = {};
  };

  template <typename Node>
  checked::StmtPtr make_stmt(Span span, const Node& node) {
    return context_.program.arena.make(checked::Stmt{span, node});
  }
  Result statement(const ast::Stmt& stmt);
  Result check(const ast::Empty& node, Span span);
  Result check(const ast::ExprStmt& node, Span span);
  Result check(const ast::Block& node, Span span);
  Result check(const ast::If& node, Span span);
  Result check(const ast::While& node, Span span);
  Result check(const ast::DoWhile& node, Span span);
  Result check(const ast::For& node, Span span);
  Result check(const ast::Switch& node, Span span);
  Result check(const ast::Case& node, Span span);
  Result check(const ast::Default& node, Span span);
  Result check(const ast::Break& node, Span span);
  Result check(const ast::Continue& node, Span span);
  Result check(const ast::Return& node, Span span);

  Result block(const ast::Block& node, Span span, bool reached);
  bool meant(const ast::Stmt& before, const ast::Stmt& label) const;
  Frame* innermost_switch();

  Context& context_;
  ExpressionChecker expressions_;
  std::vector<Frame> frames_;
};

}  // namespace ipos::compiler
