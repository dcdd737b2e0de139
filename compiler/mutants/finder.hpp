// Walks through a checked program and notes what could be wrong in it. docs/guide/testing.md has the list.
#pragma once

#include <map>
#include <optional>
#include <set>

#include "compiler/mutants/change.hpp"
#include "compiler/mutants/text.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::compiler::mutants {

class Finder {
 public:
  Finder(checked::Program& program, const SourceMap& sources) : program_(program), texts_(sources) {}

  std::vector<Change> run();

 private:
  // What a constant is used as. A Divisor, and a factor, is not 0.
  enum class Role : uint8_t { Plain, Truth, Mask, Shift, Divisor, Wait };
  struct Edits {
    std::vector<std::pair<checked::Expr*, checked::Expr>> exprs{};
    std::vector<std::pair<checked::Stmt*, checked::Stmt>> stmts{};
  };

  // finder.cpp: statements
  void statement(checked::Stmt& stmt);
  void find_in(checked::Stmt& stmt, checked::ExprStmt& node);
  void find_in(checked::Stmt& stmt, checked::Block& node);
  void find_in(checked::Stmt& stmt, checked::If& node);
  void find_in(checked::Stmt& stmt, checked::While& node);
  void find_in(checked::Stmt& stmt, checked::DoWhile& node);
  void find_in(checked::Stmt& stmt, checked::For& node);
  void find_in(checked::Stmt& stmt, checked::Switch& node);
  void find_in(checked::Stmt& stmt, checked::CaseLabel& node);
  void find_in(checked::Stmt& stmt, checked::Break& node);
  void find_in(checked::Stmt& stmt, checked::Continue& node);
  void find_in(checked::Stmt& stmt, checked::Return& node);
  void part_of_for(checked::Stmt& stmt, checked::ExprPtr checked::For::*part);
  void remove(checked::Stmt& stmt, Kind kind);
  void at_head(Location begin, Location end);
  void add(Kind kind, Span span, std::string text, Edits edits);

  // expressions.cpp
  void part(checked::Expr& expr);             // for its effect or its value, with its variables
  void condition_part(checked::Expr& expr);   // likewise
  void value(checked::Expr& expr, Role role = Role::Plain);
  void condition(checked::Expr& expr);
  void find_in(checked::Expr& expr, checked::Constant& node, Role role);
  void find_in(checked::Expr& expr, checked::Load& node, Role role);
  void find_in(checked::Expr& expr, checked::Unary& node, Role role);
  void find_in(checked::Expr& expr, checked::Step& node, Role role);
  void find_in(checked::Expr& expr, checked::Binary& node, Role role);
  void find_in(checked::Expr& expr, checked::Conditional& node, Role role);
  void find_in(checked::Expr& expr, checked::Assign& node, Role role);
  void find_in(checked::Expr& expr, checked::Comma& node, Role role);
  void find_in(checked::Expr& expr, checked::CopyBlock& node, Role role);
  void find_in(checked::Expr& expr, checked::Call& node, Role role);
  void find_in(checked::Expr& expr, checked::SystemCall& node, Role role);
  void argument(checked::Expr& expr, const checked::SystemCall& node, size_t n);
  void place(const checked::Place& place);
  bool is_built_in(Span span) const;
  void operate(checked::Expr& expr, checked::BinaryOp op, Span op_span);
  void take_off(checked::Expr& expr, const checked::Expr& operand, Kind kind);
  static Role role_beside(checked::BinaryOp op);  // of a constant on its right side
  static int32_t changed(int32_t value, Role role);
  int32_t changed_at(Span span, int32_t value, Role role);

  // variables.cpp
  void swap_variables(checked::Expr& part, bool is_condition);
  std::string name_of(int32_t variable) const;

  checked::Program& program_;
  Texts texts_;
  Site site_;                            // of the statement that is looked at
  std::vector<checked::Stmt*> switches_;  // around it
  std::vector<Span> heads_;               // of these
  std::vector<Change> changes_;
  std::map<std::pair<uint32_t, std::string>, size_t> in_macros_;  // by place and text: those in the text of a macro
  std::map<std::pair<uint32_t, int32_t>, int32_t> macro_values_;   // by place and value: what a constant there becomes
  std::set<uint32_t> built_in_;                                    // uses of macros of built-in headers that have a change
};

}  // namespace ipos::compiler::mutants
