// Makes the tree for the grammar: one function for each rule. Reports what the grammar accepts only to
// explain it better than "expected ...": words of C that this language lacks, declarations inside functions,
// and so on.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"
#include "compiler/preprocess/word_filter.hpp"

namespace ipos::compiler {

// Names that are types where they stand: the standard structures and every typedef so far.
class TypeNames {
 public:
  void insert(std::string_view name) {
    filter_.add(name);
    names_.insert(name);
  }
  bool contains(std::string_view name) const { return filter_.may_have(name) && names_.contains(name); }

 private:
  WordFilter filter_;
  std::unordered_set<std::string_view> names_;
};

// A mistake in a declaration, held back until it is known what kind of declaration it is.
struct Problem {
  Diag diag;
  Span span;
  std::vector<std::string> args;
};
using Problems = std::vector<Problem>;

struct ParsedType {
  ast::Ident name;
  Problems problems;
};

struct ParsedDeclarator {
  ast::Declarator declarator;
  Problems problems;
};

struct ParsedVariables {
  ast::VariableDecl decl;
  Problems problems;
};

struct ForHead {
  ast::ExprPtr init = nullptr;
  ast::ExprPtr condition = nullptr;
  ast::ExprPtr step = nullptr;
};

// What a symbol of the grammar stands for, cheap to copy. What is pointed to belongs to the Builder or the
// tree.
union SemanticValue {
  SemanticValue() : expr(nullptr) {}
  ast::Number number;
  ast::Ident ident;
  ast::ExprPtr expr;
  ast::StmtPtr stmt;
  ForHead for_head;
  ParsedType* type;
  ParsedDeclarator* declarator;
  ParsedVariables* variables;
  std::vector<ast::ExprPtr>* exprs;
  std::vector<ast::StmtPtr>* stmts;
  std::vector<ParsedDeclarator>* declarators;
  std::vector<ParsedVariables>* members;
};

class Builder {
 public:
  // `open_brace`: a '}' is missing somewhere, so what looks local may be global.
  Builder(ast::Program& program, TypeNames& types, const SourceMap& map, Diagnostics& diagnostics,
          bool open_brace)
      : program_(program), types_(types), map_(map), diagnostics_(diagnostics), open_brace_(open_brace) {}

  // A value as long as the Builder lives.
  template <typename T>
  T* keep(T value) {
    return &std::get<std::deque<T>>(kept_).emplace_back(std::move(value));
  }
  template <typename T>
  std::vector<T>* list() {
    return keep(std::vector<T>());
  }
  template <typename T>
  std::vector<T>* append(std::vector<T>* items, T next) {
    items->push_back(std::move(next));
    return items;
  }
  template <typename T>
  std::vector<T>* append(std::vector<T>* items, T* next) {
    return append(items, std::move(*next));
  }

  // builder.cpp: declarations.
  void global(ParsedVariables* variables);
  void local(ParsedVariables* variables);
  void structure(Span span, ast::Ident name, std::vector<ParsedVariables>* members);
  void function(Span span, ast::Ident name, ast::StmtPtr body);
  void function_with_result(Span span, Span type, ast::Ident name, ast::StmtPtr body);
  void problem(Diag diag, Span span, std::string_view name = {});
  ast::Ident new_type(ast::Ident name);
  ParsedVariables* variables(Span span, bool initial, ParsedType* type,
                             std::vector<ParsedDeclarator>* declarators);
  ParsedType* type(ast::Ident word);
  ParsedType* qualified(ast::Ident qualifier, ParsedType* type);
  ParsedType* struct_type(Span span, ast::Ident name);
  ParsedType* foreign_type(Span span, ast::Ident word);
  ParsedType* two_types(ParsedType* first, ast::Ident second);
  ParsedDeclarator* declarator(ast::Ident name);
  ParsedDeclarator* declared_type(ast::Ident name);
  ParsedDeclarator* initialized(ParsedDeclarator* declarator, Span assign);
  ParsedDeclarator* array(ParsedDeclarator* declarator, Span bracket, ast::ExprPtr count);
  ParsedDeclarator* pointer(Span star, ParsedDeclarator* declarator);
  void pragma(Span span, ast::Ident kind);
  void pragma_range(Span span, ast::Ident kind, ast::ExprPtr low, ast::ExprPtr high);
  void alias(Span span, ast::Ident name, ast::Ident base);
  void alias_behind(Span span, ast::Ident name, ast::Ident base, Span plus, ast::ExprPtr offset);

  // build_statements.cpp
  ast::StmtPtr block(Span span, std::vector<ast::StmtPtr>* items);
  ast::StmtPtr expression_statement(Span span, ast::ExprPtr expr);
  ast::StmtPtr if_statement(Span span, ast::ExprPtr condition, ast::StmtPtr then, ast::StmtPtr otherwise);
  ast::StmtPtr while_statement(Span span, ast::ExprPtr condition, ast::StmtPtr body);
  ast::StmtPtr do_while(Span span, ast::StmtPtr body, ast::ExprPtr condition);
  ForHead for_head(ast::ExprPtr init, ast::ExprPtr condition, ast::ExprPtr step);
  ast::StmtPtr for_statement(Span span, ForHead head, ast::StmtPtr body);
  ast::StmtPtr switch_statement(Span span, ast::ExprPtr value, ast::StmtPtr body);
  ast::StmtPtr case_label(Span span, ast::ExprPtr value);
  template <typename Node>
  ast::StmtPtr simple(Span span) {
    return make_stmt(span, Node{}, 0);
  }

  // build_expressions.cpp
  ast::ExprPtr number(Span span, ast::Number number);
  ast::ExprPtr name(ast::Ident ident);
  // `arguments`: null when there are none.
  ast::ExprPtr call(Span span, ast::Ident function, std::vector<ast::ExprPtr>* arguments);
  ast::ExprPtr parenthesized(Span span, ast::ExprPtr inner);
  ast::ExprPtr numof(Span span, ast::ExprPtr object);
  ast::ExprPtr index(Span span, ast::ExprPtr base, ast::ExprPtr index);
  ast::ExprPtr member(Span span, ast::ExprPtr base, ast::Ident member);
  ast::ExprPtr arrow(Span span, ast::ExprPtr base, Span arrow, ast::Ident member);
  ast::ExprPtr step(Span span, ast::StepOp op, ast::ExprPtr operand);
  ast::ExprPtr unary(Span span, ast::UnaryOp op, ast::ExprPtr operand);
  ast::ExprPtr deref(Span span, ast::ExprPtr number);
  ast::ExprPtr binary(Span span, ast::BinaryOp op, ast::ExprPtr left, Span op_span, ast::ExprPtr right);
  ast::ExprPtr conditional(Span span, ast::ExprPtr condition, ast::ExprPtr then, ast::ExprPtr otherwise);
  ast::ExprPtr assign(Span span, std::optional<ast::BinaryOp> op, ast::ExprPtr target, Span op_span,
                      ast::ExprPtr value);
  ast::ExprPtr comma(Span span, ast::ExprPtr left, ast::ExprPtr right);
  // Reports a construct of C from `first` to `last` and goes on with its operand, or with 0.
  ast::ExprPtr replaced(Diag diag, Span first, Span last, ast::ExprPtr operand);
  ast::ExprPtr missing(Diag diag, Span span);

 private:
  void report(const Problems& problems);
  bool is_line_head(Span span) const;
  // Nodes over children of this depth; one that would be too deep is reported and replaced by a leaf.
  template <typename Node>
  ast::ExprPtr make_expr(Span span, const Node& node, unsigned depth_below) {
    if (too_deep(span, depth_below)) return number(span, {0});
    return program_.arena.make(ast::Expr{span, node, false, static_cast<uint16_t>(depth_below + 1)});
  }
  template <typename Node>
  ast::StmtPtr make_stmt(Span span, const Node& node, unsigned depth_below) {
    if (too_deep(span, depth_below)) return simple<ast::Empty>(span);
    return program_.arena.make(ast::Stmt{span, node, static_cast<uint16_t>(depth_below + 1)});
  }
  bool too_deep(Span span, unsigned depth_below);
  // What stands where recovery left nothing, so that the tree has no holes.
  ast::ExprPtr whole(ast::ExprPtr expr, Span span);
  ast::StmtPtr whole(ast::StmtPtr stmt, Span span);

  ast::Program& program_;
  TypeNames& types_;
  const SourceMap& map_;
  Diagnostics& diagnostics_;
  std::tuple<std::deque<ParsedType>, std::deque<ParsedDeclarator>, std::deque<ParsedVariables>,
             std::deque<std::vector<ast::ExprPtr>>, std::deque<std::vector<ast::StmtPtr>>,
             std::deque<std::vector<ParsedDeclarator>>, std::deque<std::vector<ParsedVariables>>>
      kept_;
  bool open_brace_;
  bool too_deep_reported_ = false;
};

}  // namespace ipos::compiler
