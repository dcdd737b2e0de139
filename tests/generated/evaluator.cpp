// Arithmetic is done in 64 bits and cut to 32, unlike in the VM, so that the two have no formula in common.
#include "tests/generated/evaluator.hpp"

namespace ipos::tests {
namespace {

int32_t cut(int64_t wide) { return static_cast<int32_t>(static_cast<uint32_t>(static_cast<uint64_t>(wide))); }

int64_t floor_of_power(int64_t value, int count) {
  const int64_t power = int64_t{1} << count;
  return value >= 0 ? value / power : -((-value + power - 1) / power);
}

enum class Flow : uint8_t { Next, Break, Continue, Return };

class Evaluator {
 public:
  Evaluator(const Program& program, uint64_t steps) : program_(program), steps_(steps) {
    outcome_.variables.resize(static_cast<size_t>(program.variables));
  }

  Outcome run() {
    run(program_.functions[program_.main].body);
    outcome_.ended = steps_ != 0;
    return std::move(outcome_);
  }

 private:
  bool stopped() const { return outcome_.fault != 0 || steps_ == 0; }

  void fail() {
    if (stopped()) return;
    outcome_.fault = 10;
    outcome_.line = roots_.back()->line;
    outcome_.open.resize(outcome_.variables.size());
  }

  // The target of an assignment that the fault has interrupted.
  void leave_open(int32_t number) {
    if (number >= 0 && number < program_.variables) outcome_.open[static_cast<size_t>(number)] = true;
  }

  int32_t load(int32_t number) {
    if (number < 0 || number >= program_.variables) fail();
    return stopped() ? 0 : outcome_.variables[static_cast<size_t>(number)];
  }
  void store(int32_t number, int32_t value) {
    if (number < 0 || number >= program_.variables) fail();
    if (!stopped()) outcome_.variables[static_cast<size_t>(number)] = value;
  }

  // The number of the variable an expression names; it need not exist.
  int32_t place(const Expr& expr) {
    if (expr.kind == ExprKind::Element) return cut(int64_t{expr.value} + value(expr.parts[0]));
    if (expr.kind == ExprKind::Deref) return value(expr.parts[0]);
    return expr.value;
  }

  int32_t root(const Expr& expr) {
    roots_.push_back(&expr);
    const int32_t result = value(expr);
    roots_.pop_back();
    return result;
  }

  int32_t value(const Expr& expr) {
    if (steps_ != 0) --steps_;
    if (stopped()) return 0;
    switch (expr.kind) {
      case ExprKind::Nothing: return 1;
      case ExprKind::Number:
      case ExprKind::Numof: return expr.value;
      case ExprKind::Variable:
      case ExprKind::Element:
      case ExprKind::Deref: return load(place(expr));
      case ExprKind::Unary: {
        const int32_t operand = value(expr.parts[0]);
        if (expr.op == Op::Plus) return operand;
        if (expr.op == Op::Not) return operand == 0;
        return cut(expr.op == Op::Minus ? -int64_t{operand} : -1 - int64_t{operand});
      }
      case ExprKind::Step: {
        const int32_t number = place(expr.parts[0]);
        const int32_t old = load(number);
        const int32_t moved = cut(int64_t{old} + expr.value);
        store(number, moved);
        return expr.prefix ? moved : old;
      }
      case ExprKind::Binary: return binary(expr);
      case ExprKind::Conditional: return value(expr.parts[value(expr.parts[0]) != 0 ? 1 : 2]);
      case ExprKind::Comma: value(expr.parts[0]); return value(expr.parts[1]);
      case ExprKind::Assign: {
        const int32_t number = place(expr.parts[0]);
        const int32_t old = expr.compound ? load(number) : 0;
        int32_t result = value(expr.parts[1]);
        if (outcome_.fault != 0) leave_open(number);
        if (expr.compound) result = operate(expr.op, old, result);
        store(number, result);
        return result;
      }
      case ExprKind::Call: run(program_.functions[static_cast<size_t>(expr.value)].body); return 0;
      case ExprKind::Macro: return value(expr.parts[0]);
      case ExprKind::CopyBlock: copy(expr); return 0;
      case ExprKind::Bits: bits(expr); return 0;
    }
    return 0;
  }

  int32_t operate(Op op, int32_t a, int32_t b) {
    const Applied applied = apply(op, a, b);
    if (applied.fault) fail();
    return applied.value;
  }

  int32_t binary(const Expr& expr) {
    const int32_t left = value(expr.parts[0]);
    if (expr.op == Op::LogicalAnd) return left != 0 && value(expr.parts[1]) != 0;
    if (expr.op == Op::LogicalOr) return left != 0 || value(expr.parts[1]) != 0;
    return operate(expr.op, left, value(expr.parts[1]));
  }

  void copy(const Expr& expr) {
    std::vector<int32_t> block;
    for (int32_t i = 0; i < expr.numbers[2]; ++i) block.push_back(load(expr.numbers[1] + i));
    for (int32_t i = 0; i < expr.numbers[2]; ++i) store(expr.numbers[0] + i, block[static_cast<size_t>(i)]);
  }

  void bits(const Expr& expr) {
    const int64_t weight = int64_t{1} << expr.numbers[1];
    const auto bit_of = [](int32_t word, int32_t bit) { return floor_of_power(word, bit) % 2 != 0; };
    bool on = expr.op == Op::BitSet;
    if (expr.op == Op::BitMove) on = bit_of(load(expr.numbers[2]), expr.numbers[3]);
    if (expr.op == Op::BitMoveNeg) on = !bit_of(load(expr.numbers[2]), expr.numbers[3]);
    const int32_t old = load(expr.numbers[0]);
    const bool was = bit_of(old, expr.numbers[1]);
    store(expr.numbers[0], cut(old + (on && !was ? weight : was && !on ? -weight : 0)));
  }

  Flow run(const std::vector<Stmt>& body, size_t from = 0) {
    for (size_t i = from; i < body.size(); ++i)
      if (const Flow flow = run(body[i]); flow != Flow::Next) return flow;
    return Flow::Next;
  }

  Flow run(const Stmt& stmt) {
    if (stopped()) return Flow::Return;
    switch (stmt.kind) {
      case StmtKind::Empty:
      case StmtKind::Case:
      case StmtKind::Default: return Flow::Next;
      case StmtKind::Effect: root(stmt.exprs[0]); break;
      case StmtKind::Block: return run(stmt.body);
      case StmtKind::If: {
        const bool taken = root(stmt.exprs[0]) != 0;
        if (stopped()) break;
        if (taken) return run(stmt.body[0]);
        return stmt.body.size() > 1 ? run(stmt.body[1]) : Flow::Next;
      }
      case StmtKind::While: return loop(stmt, nullptr, true);
      case StmtKind::DoWhile: return loop(stmt, nullptr, false);
      case StmtKind::For: root(stmt.exprs[0]); return loop(stmt, &stmt.exprs[2], true);
      case StmtKind::Switch: return choose(stmt);
      case StmtKind::Break: return Flow::Break;
      case StmtKind::Continue: return Flow::Continue;
      case StmtKind::Return: return Flow::Return;
    }
    return stopped() ? Flow::Return : Flow::Next;
  }

  Flow loop(const Stmt& stmt, const Expr* step, bool test_first) {
    const Expr& condition = stmt.exprs[stmt.kind == StmtKind::For ? 1 : 0];
    for (bool test = test_first;; test = true) {
      if (test && root(condition) == 0) break;
      if (stopped()) break;
      const Flow flow = run(stmt.body[0]);
      if (flow == Flow::Break) break;
      if (flow == Flow::Return) return flow;
      if (step != nullptr) root(*step);
    }
    return stopped() ? Flow::Return : Flow::Next;
  }

  Flow choose(const Stmt& stmt) {
    const int32_t chosen = root(stmt.exprs[0]);
    if (stopped()) return Flow::Return;
    size_t from = stmt.body.size();
    for (size_t i = 0; i < stmt.body.size(); ++i)
      if (stmt.body[i].kind == StmtKind::Default) from = i;
    for (size_t i = 0; i < stmt.body.size(); ++i)
      if (stmt.body[i].kind == StmtKind::Case && stmt.body[i].value == chosen) from = i;
    const Flow flow = run(stmt.body, from);
    return flow == Flow::Break ? Flow::Next : flow;
  }

  const Program& program_;
  uint64_t steps_;
  Outcome outcome_;
  std::vector<const Expr*> roots_;
};

}  // namespace

Applied apply(Op op, int32_t a, int32_t b) {
  const int64_t x = a, y = b;
  const int count = b & 31;
  switch (op) {
    case Op::LogicalOr: return {false, a != 0 || b != 0};
    case Op::LogicalAnd: return {false, a != 0 && b != 0};
    case Op::Or: return {false, a | b};
    case Op::Xor: return {false, a ^ b};
    case Op::And: return {false, a & b};
    case Op::Eq: return {false, x - y == 0};
    case Op::Ne: return {false, x - y != 0};
    case Op::Lt: return {false, x - y < 0};
    case Op::Le: return {false, x - y <= 0};
    case Op::Gt: return {false, x - y > 0};
    case Op::Ge: return {false, x - y >= 0};
    case Op::Shl: return {false, cut(x * (int64_t{1} << count))};
    case Op::Shr: return {false, cut(floor_of_power(x, count))};
    case Op::Add: return {false, cut(x + y)};
    case Op::Sub: return {false, cut(x - y)};
    case Op::Mul: return {false, cut(x * y)};
    case Op::Div: return b == 0 ? Applied{true, 0} : Applied{false, cut(x / y)};
    case Op::Mod: return b == 0 ? Applied{true, 0} : Applied{false, cut(x % y)};
    default: return {};
  }
}

Outcome evaluate(const Program& program, uint64_t steps) { return Evaluator(program, steps).run(); }

}  // namespace ipos::tests
