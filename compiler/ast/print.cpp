// Prints the tree. Recursion is safe: the parser bounds the depth.
#include "compiler/ast/print.hpp"

#include <fmt/format.h>

#include "compiler/ast/walk.hpp"

namespace ipos::compiler::ast {
namespace {

std::string_view spelling(StepOp op) {
  switch (op) {
    case StepOp::PreIncrement: return "++ before";
    case StepOp::PreDecrement: return "-- before";
    case StepOp::PostIncrement: return "++ behind";
    case StepOp::PostDecrement: return "-- behind";
  }
  return "";
}

class Printer {
 public:
  explicit Printer(const SourceMap& map) : map_(map) {}

  void decl(const VariableDecl& decl) {
    line(decl.span, "{}{}", decl.initial ? "initial " : "", decl.type.text);
    ++level_;
    for (const Declarator& one : decl.declarators) {
      line(one.name.span, "variable {}", one.name.text);
      child(one.count);
    }
    --level_;
  }
  void decl(const StructDecl& decl) {
    line(decl.span, "structure {}", decl.name.text);
    ++level_;
    for (const VariableDecl& member : decl.members) this->decl(member);
    --level_;
  }
  void decl(const FunctionDecl& decl) {
    line(decl.span, "function {}", decl.name.text);
    child(decl.body);
  }
  void decl(const AliasDecl& decl) {
    line(decl.span, "declare {}", decl.name.text);
    child(decl.base);
  }
  void decl(const PragmaDecl& decl) {
    line(decl.span, "pragma {}", decl.kind.text);
    if (decl.range) {
      child(decl.range->first);
      child(decl.range->second);
    }
  }

  std::string take() { return std::move(out_); }

 private:
  template <typename... Args>
  void line(Span span, fmt::format_string<Args...> format, Args&&... args) {
    const Position at = map_.position(span.begin);
    out_ += fmt::format("{:{}}{}:{} ", "", 2 * level_, at.line, at.column);
    out_ += fmt::format(format, std::forward<Args>(args)...);
    out_.push_back('\n');
  }

  template <typename Node>
  void child(const Node* node) {
    if (node == nullptr) return;
    ++level_;
    print(*node);
    --level_;
  }

  // A part that may be absent: the heads of for.
  void part(Span span, const ExprPtr& expr) {
    if (expr != nullptr) return child(expr);
    ++level_;
    line(span, "none");
    --level_;
  }

  void print(const Expr& expr) {
    std::visit(Overloaded{
                   [&](const Number& n) {
                     if (n.hex)
                       line(expr.span, "number 0x{:X}", static_cast<uint32_t>(n.value));
                     else
                       line(expr.span, "number {}", n.value);
                   },
                   [&](const Name& n) { line(expr.span, "name {}", n.text); },
                   [&](const Member& n) { line(expr.span, "member {}", n.member.text), child(n.base); },
                   [&](const Index& n) { line(expr.span, "index"), child(n.base), child(n.index); },
                   [&](const Deref& n) { line(expr.span, "pointer"), child(n.number); },
                   [&](const Numof& n) { line(expr.span, "numof"), child(n.object); },
                   [&](const Unary& n) { line(expr.span, "unary {}", spelling(n.op)), child(n.operand); },
                   [&](const Step& n) { line(expr.span, "step {}", spelling(n.op)), child(n.operand); },
                   [&](const Binary& n) {
                     line(expr.span, "binary {}", spelling(n.op)), child(n.left), child(n.right);
                   },
                   [&](const Conditional& n) {
                     line(expr.span, "conditional"), child(n.condition), child(n.then), child(n.otherwise);
                   },
                   [&](const Assign& n) {
                     line(expr.span, "assign {}=", n.op ? spelling(*n.op) : ""), child(n.target),
                         child(n.value);
                   },
                   [&](const Comma& n) { line(expr.span, "comma"), child(n.left), child(n.right); },
                   [&](const Call& n) {
                     line(expr.span, "call {}", n.function.text);
                     for (const ExprPtr& argument : n.arguments) child(argument);
                   },
               },
               expr.node);
  }

  void print(const Stmt& stmt) {
    std::visit(Overloaded{
                   [&](const Empty&) { line(stmt.span, "empty"); },
                   [&](const ExprStmt& n) { line(stmt.span, "expression"), child(n.expr); },
                   [&](const Block& n) {
                     line(stmt.span, "block");
                     for (const StmtPtr& one : n.body) child(one);
                   },
                   [&](const If& n) {
                     line(stmt.span, "if"), child(n.condition), child(n.then), child(n.otherwise);
                   },
                   [&](const While& n) { line(stmt.span, "while"), child(n.condition), child(n.body); },
                   [&](const DoWhile& n) { line(stmt.span, "do while"), child(n.body), child(n.condition); },
                   [&](const For& n) {
                     line(stmt.span, "for");
                     part(stmt.span, n.init), part(stmt.span, n.condition), part(stmt.span, n.step),
                         child(n.body);
                   },
                   [&](const Switch& n) { line(stmt.span, "switch"), child(n.value), child(n.body); },
                   [&](const Case& n) { line(stmt.span, "case"), child(n.value); },
                   [&](const Default&) { line(stmt.span, "default"); },
                   [&](const Break&) { line(stmt.span, "break"); },
                   [&](const Continue&) { line(stmt.span, "continue"); },
                   [&](const Return&) { line(stmt.span, "return"); },
               },
               stmt.node);
  }

  const SourceMap& map_;
  std::string out_;
  int level_ = 0;
};

}  // namespace

std::string_view spelling(BinaryOp op) {
  switch (op) {
    case BinaryOp::Mul: return "*";
    case BinaryOp::Div: return "/";
    case BinaryOp::Mod: return "%";
    case BinaryOp::Add: return "+";
    case BinaryOp::Sub: return "-";
    case BinaryOp::Shl: return "<<";
    case BinaryOp::Shr: return ">>";
    case BinaryOp::Lt: return "<";
    case BinaryOp::Le: return "<=";
    case BinaryOp::Gt: return ">";
    case BinaryOp::Ge: return ">=";
    case BinaryOp::Eq: return "==";
    case BinaryOp::Ne: return "!=";
    case BinaryOp::And: return "&";
    case BinaryOp::Xor: return "^";
    case BinaryOp::Or: return "|";
    case BinaryOp::LogicalAnd: return "&&";
    case BinaryOp::LogicalOr: return "||";
  }
  return "";
}

std::string_view spelling(UnaryOp op) {
  switch (op) {
    case UnaryOp::Plus: return "+";
    case UnaryOp::Minus: return "-";
    case UnaryOp::Not: return "!";
    case UnaryOp::BitNot: return "~";
  }
  return "";
}

std::string print(const Program& program, const SourceMap& map) {
  Printer printer(map);
  for (const Decl& decl : program.declarations)
    std::visit([&printer](const auto& one) { printer.decl(one); }, decl);
  return printer.take();
}

}  // namespace ipos::compiler::ast
