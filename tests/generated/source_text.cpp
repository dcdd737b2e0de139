// Precedence levels are C's: 1 comma, 2 assignment, 3 conditional, 4..13 binary, 14 prefix, 15 postfix, 16
// primary.
#include "tests/generated/source_text.hpp"

#include <algorithm>
#include <cctype>

namespace ipos::tests {
namespace {

constexpr OperatorRow kOperators[] = {
#define OPERATOR(name, text, precedence) {Op::name, text, precedence},
#include "tests/generated/operators.def"
};

constexpr int kComma = 1, kAssign = 2, kConditional = 3, kPrefix = 14, kPostfix = 15, kPrimary = 16;

int precedence(const Expr& expr) {
  switch (expr.kind) {
    case ExprKind::Comma: return kComma;
    case ExprKind::Assign:
    case ExprKind::CopyBlock: return kAssign;
    case ExprKind::Conditional: return kConditional;
    case ExprKind::Binary: return row(expr.op).precedence;
    case ExprKind::Unary:
    case ExprKind::Deref: return kPrefix;
    case ExprKind::Step: return expr.prefix ? kPrefix : kPostfix;
    case ExprKind::Element: return kPostfix;
    default: return kPrimary;
  }
}

std::string text_of(const Expr& expr);

// An expression where at least `level` is needed.
std::string at_level(const Expr& expr, int level) {
  const std::string text = text_of(expr);
  return expr.parentheses || precedence(expr) < level ? "(" + text + ")" : text;
}

// `- -a` and `+ ++a` need the space.
std::string prefixed(const std::string& sign, const std::string& operand) {
  return operand.front() == sign.back() ? sign + " " + operand : sign + operand;
}

std::string infix(const std::string& left, const std::string& sign, const std::string& right, bool compact) {
  const bool joins =
      compact && (std::isalnum(static_cast<unsigned char>(right.front())) || right.front() == '(');
  return joins ? left + sign + right : left + " " + sign + " " + right;
}

std::string text_of(const Expr& expr) {
  const auto part = [&](size_t index, int level) { return at_level(expr.parts[index], level); };
  switch (expr.kind) {
    case ExprKind::Nothing: return "";
    case ExprKind::Number:
    case ExprKind::Variable:
    case ExprKind::Macro:
    case ExprKind::CopyBlock:
    case ExprKind::Bits:
    case ExprKind::Call: return expr.text;
    case ExprKind::Element: return expr.text + "[" + part(0, kComma) + "]";
    case ExprKind::Deref: return prefixed("*", part(0, kPrefix));
    case ExprKind::Numof: return "numof(" + expr.text + ")";
    case ExprKind::Unary: return prefixed(row(expr.op).text, part(0, kPrefix));
    case ExprKind::Step: {
      const std::string sign = expr.value > 0 ? "++" : "--";
      return expr.prefix ? prefixed(sign, part(0, kPrefix)) : part(0, kPostfix) + sign;
    }
    case ExprKind::Binary: {
      const OperatorRow& op = row(expr.op);
      return infix(part(0, op.precedence), op.text, part(1, op.precedence + 1), expr.compact);
    }
    case ExprKind::Conditional:
      return part(0, kConditional + 1) + " ? " + part(1, kComma) + " : " + part(2, kConditional);
    case ExprKind::Comma: return part(0, kComma) + ", " + part(1, kAssign);
    case ExprKind::Assign: {
      const std::string sign = expr.compound ? std::string(row(expr.op).text) + "=" : "=";
      return infix(part(0, kPrefix), sign, part(1, kAssign), expr.compact);
    }
  }
  return "";
}

class Printer {
 public:
  std::string print(Program& program) {
    for (const std::string& text : program.head) line(text);
    for (Function& function : program.functions) {
      for (const std::string& text : function.before) line(text);
      line(function.name + "()");
      statement(function.body);
    }
    return std::move(out_);
  }

 private:
  void line(const std::string& text) {
    out_ += std::string(static_cast<size_t>(indent_) * 2, ' ') + text + "\n";
    line_ += 1 + static_cast<uint32_t>(std::count(text.begin(), text.end(), '\n'));
  }

  // Text of an outermost expression; it stands in the line being written.
  std::string root(Expr& expr) {
    expr.line = line_;
    return at_level(expr, kComma);
  }

  void nested(Stmt& stmt) {
    indent_ += stmt.kind != StmtKind::Block;
    statement(stmt);
    indent_ -= stmt.kind != StmtKind::Block;
  }

  void braces(std::vector<Stmt>& body) {
    line("{");
    ++indent_;
    for (Stmt& stmt : body) statement(stmt);
    --indent_;
    line("}");
  }

  void statement(Stmt& stmt) {
    switch (stmt.kind) {
      case StmtKind::Empty: return line(";");
      case StmtKind::Effect: return line(root(stmt.exprs[0]) + ";");
      case StmtKind::Block: return braces(stmt.body);
      case StmtKind::If:
        line("if (" + root(stmt.exprs[0]) + ")");
        nested(stmt.body[0]);
        if (stmt.body.size() < 2) return;
        line("else");
        return nested(stmt.body[1]);
      case StmtKind::While: line("while (" + root(stmt.exprs[0]) + ")"); return nested(stmt.body[0]);
      case StmtKind::DoWhile:
        line("do");
        nested(stmt.body[0]);
        return line("while (" + root(stmt.exprs[0]) + ");");
      case StmtKind::For:
        line("for (" + root(stmt.exprs[0]) + "; " + root(stmt.exprs[1]) + "; " + root(stmt.exprs[2]) + ")");
        return nested(stmt.body[0]);
      case StmtKind::Switch: line("switch (" + root(stmt.exprs[0]) + ")"); return braces(stmt.body);
      case StmtKind::Case: return line("case " + root(stmt.exprs[0]) + ":");
      case StmtKind::Default: return line("default:");
      case StmtKind::Break: return line("break;");
      case StmtKind::Continue: return line("continue;");
      case StmtKind::Return: return line("return;");
    }
  }

  std::string out_;
  uint32_t line_ = 1;
  int indent_ = 0;
};

}  // namespace

const OperatorRow& row(Op op) { return kOperators[static_cast<size_t>(op)]; }

std::string expression_text(const Expr& expr) { return at_level(expr, kComma); }

std::string source_text(Program& program) { return Printer().print(program); }

}  // namespace ipos::tests
