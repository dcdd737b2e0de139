// Needs gcc's -fwrapv; right shifts of negative numbers fill the sign in gcc.
#include "tests/generated/c_text.hpp"

#include <algorithm>
#include <limits>

namespace ipos::tests {
namespace {

constexpr const char* kPrelude = R"(#include <setjmp.h>
#include <stdio.h>
#include <string.h>
static int H[1024], limit, fault, fault_line;
static jmp_buf out;
static void fail(int line) { fault = 10; fault_line = line; longjmp(out, 1); }
static int at(int n, int line) { if (n < 0 || n >= limit) fail(line); return n; }
static int divisor(int n, int line) { if (n == 0) fail(line); return n; }
static void run(void (*program)(void), int variables) {
  int i;
  memset(H, 0, sizeof H);
  limit = variables;
  fault = fault_line = 0;
  if (!setjmp(out)) program();
  printf("%d %d", fault, fault_line);
  for (i = 0; i < limit; ++i) if (H[i]) printf(" %d=%d", i, H[i]);
  printf("\n");
}
)";

std::string literal(int32_t value) {
  return value == std::numeric_limits<int32_t>::min() ? "(-2147483647 - 1)"
                                                      : "(" + std::to_string(value) + ")";
}

class FunctionText {
 public:
  explicit FunctionText(std::string prefix) : prefix_(std::move(prefix)) {}

  std::string text(const Function& function, size_t index) {
    statement(function.body);
    std::string out = "static void " + prefix_ + std::to_string(index) + "(void) {\n";
    for (int i = 1; i <= temporaries_; ++i) out += "int t" + std::to_string(i) + ";\n";
    return out + body_ + "(void)0; }  /* " + function.name + " */\n";
  }

 private:
  void emit(const std::string& text) { body_ += text + "\n"; }

  std::string temporary(const std::string& value) {
    const std::string name = "t" + std::to_string(++temporaries_);
    emit(name + " = " + value + ";");
    return name;
  }

  std::string root(const Expr& expr) {
    line_ = std::to_string(expr.line);
    return value(expr);
  }

  // The number of the variable that an expression names, in a temporary.
  std::string place(const Expr& expr) {
    if (expr.kind == ExprKind::Element)
      return temporary(std::to_string(expr.value) + " + " + value(expr.parts[0]));
    if (expr.kind == ExprKind::Deref) return temporary(value(expr.parts[0]));
    return std::to_string(expr.value);
  }
  std::string cell(const std::string& number) const { return "H[at(" + number + ", " + line_ + ")]"; }

  std::string value(const Expr& expr) {
    switch (expr.kind) {
      case ExprKind::Nothing: return "1";
      case ExprKind::Number:
      case ExprKind::Numof: return literal(expr.value);
      case ExprKind::Variable:
      case ExprKind::Element:
      case ExprKind::Deref: return temporary(cell(place(expr)));
      case ExprKind::Unary: return temporary(std::string(row(expr.op).text) + value(expr.parts[0]));
      case ExprKind::Step: {
        const std::string number = place(expr.parts[0]);
        const std::string sign = expr.value > 0 ? "++" : "--";
        return temporary(expr.prefix ? sign + cell(number) : cell(number) + sign);
      }
      case ExprKind::Binary: return binary(expr);
      case ExprKind::Conditional: {
        const std::string result = temporary("0");
        emit("if (" + value(expr.parts[0]) + ") {");
        emit(result + " = " + value(expr.parts[1]) + ";");
        emit("} else {");
        emit(result + " = " + value(expr.parts[2]) + ";");
        emit("}");
        return result;
      }
      case ExprKind::Comma: value(expr.parts[0]); return value(expr.parts[1]);
      case ExprKind::Assign: {
        const std::string number = place(expr.parts[0]);
        const std::string old = expr.compound ? temporary(cell(number)) : "";
        const std::string right = value(expr.parts[1]);
        const std::string result = expr.compound ? operate(expr.op, old, right) : temporary(right);
        emit(cell(number) + " = " + result + ";");
        return result;
      }
      case ExprKind::Call: emit(prefix_ + std::to_string(expr.value) + "();"); return "0";
      case ExprKind::Macro: return value(expr.parts[0]);
      case ExprKind::CopyBlock:
        emit("memmove(H + " + std::to_string(expr.numbers[0]) + ", H + " + std::to_string(expr.numbers[1]) +
             ", " + std::to_string(expr.numbers[2]) + " * sizeof *H);");
        return "0";
      case ExprKind::Bits: bits(expr); return "0";
    }
    return "0";
  }

  std::string operate(Op op, const std::string& a, const std::string& b) {
    if (op == Op::Shl || op == Op::Shr) return temporary(a + " " + row(op).text + " (" + b + " & 31)");
    if (op == Op::Div || op == Op::Mod) {
      const std::string by = temporary("divisor(" + b + ", " + line_ + ")");
      const std::string minus_one = op == Op::Div ? "-" + a : "0";
      return temporary(by + " == -1 ? " + minus_one + " : " + a + " " + row(op).text + " " + by);
    }
    return temporary(a + " " + row(op).text + " " + b);
  }

  std::string binary(const Expr& expr) {
    if (expr.op != Op::LogicalAnd && expr.op != Op::LogicalOr) {
      const std::string left = value(expr.parts[0]);
      return operate(expr.op, left, value(expr.parts[1]));
    }
    const std::string result = temporary("!!" + value(expr.parts[0]));
    emit("if (" + std::string(expr.op == Op::LogicalAnd ? "" : "!") + result + ") {");
    emit(result + " = !!" + value(expr.parts[1]) + ";");
    emit("}");
    return result;
  }

  void bits(const Expr& expr) {
    const auto mask = [&](size_t i) { return "(1u << " + std::to_string(expr.numbers[i]) + ")"; };
    const std::string target = "H[" + std::to_string(expr.numbers[0]) + "]";
    const std::string source = "(H[" + std::to_string(expr.numbers[2]) + "] & " + mask(3) + ")";
    const std::string on = expr.op == Op::BitSet     ? "1"
                           : expr.op == Op::BitClear ? "0"
                           : expr.op == Op::BitMove  ? source
                                                     : "!" + source;
    emit("if (" + on + ") " + target + " |= " + mask(1) + "; else " + target + " &= ~" + mask(1) + ";");
  }

  void loop(const Stmt& stmt, const Expr* step, bool test_first) {
    const Expr& condition = stmt.exprs[stmt.kind == StmtKind::For ? 1 : 0];
    const std::string label = "next" + std::to_string(++labels_);
    const auto test = [&] { emit("if (!" + root(condition) + ") break;"); };
    continues_.push_back(label);
    emit("for (;;) {");
    if (test_first) test();
    statement(stmt.body[0]);
    emit(label + ":;");
    if (!test_first) test();
    if (step != nullptr) root(*step);
    emit("}");
    continues_.pop_back();
  }

  void statement(const Stmt& stmt) {
    switch (stmt.kind) {
      case StmtKind::Empty: return;
      case StmtKind::Effect: root(stmt.exprs[0]); return;
      case StmtKind::Block:
        emit("{");
        for (const Stmt& inner : stmt.body) statement(inner);
        return emit("}");
      case StmtKind::If:
        emit("if (" + root(stmt.exprs[0]) + ") {");
        statement(stmt.body[0]);
        if (stmt.body.size() > 1) {
          emit("} else {");
          statement(stmt.body[1]);
        }
        return emit("}");
      case StmtKind::While: return loop(stmt, nullptr, true);
      case StmtKind::DoWhile: return loop(stmt, nullptr, false);
      case StmtKind::For: root(stmt.exprs[0]); return loop(stmt, &stmt.exprs[2], true);
      case StmtKind::Switch:
        emit("switch (" + root(stmt.exprs[0]) + ") {");
        for (const Stmt& inner : stmt.body) statement(inner);
        return emit("}");
      case StmtKind::Case: return emit("case " + literal(stmt.value) + ":;");
      case StmtKind::Default: return emit("default:;");
      case StmtKind::Break: return emit("break;");
      case StmtKind::Continue: return emit("goto " + continues_.back() + ";");
      case StmtKind::Return: return emit("return;");
    }
  }

  std::string prefix_;
  std::string body_;
  std::string line_ = "0";
  int temporaries_ = 0;
  int labels_ = 0;
  std::vector<std::string> continues_;
};

}  // namespace

std::string c_text(const std::vector<Program>& programs) {
  std::string functions;
  std::string main = "int main(void) {\n";
  for (size_t p = 0; p < programs.size(); ++p) {
    const std::string prefix = "p" + std::to_string(p) + "_";
    for (size_t f = 0; f < programs[p].functions.size(); ++f)
      functions += "static void " + prefix + std::to_string(f) + "(void);\n";
    for (size_t f = 0; f < programs[p].functions.size(); ++f)
      functions += FunctionText(prefix).text(programs[p].functions[f], f);
    main += "run(" + prefix + std::to_string(programs[p].main) + ", " +
            std::to_string(programs[p].variables) + ");\n";
  }
  return kPrelude + functions + main + "return 0; }\n";
}

}  // namespace ipos::tests
