// The reducer tries every cut in turn and starts over until none is left that keeps the difference.
#include "tests/generated/difference.hpp"

#include <algorithm>
#include <vector>

#include "tests/generated/evaluator.hpp"
#include "tests/generated/gcc_oracle.hpp"
#include "tests/generated/source_text.hpp"
#include "tests/generated/toolchain.hpp"

namespace ipos::tests {
namespace {

std::string fault_text(const Outcome& outcome) {
  if (!outcome.ended) return "no end";
  if (outcome.fault == 0) return "no fault";
  return "F" + std::to_string(outcome.fault) + " in line " + std::to_string(outcome.line);
}

enum class Line : uint8_t { Global, Initial, Range, Other };

Line kind_of(const std::string& line) {
  const auto begins = [&](const char* word) { return line.rfind(word, 0) == 0; };
  if (begins("initial")) return Line::Initial;
  if (begins("long") || begins("TYPE") || begins("SCTRCYCL")) return Line::Global;
  if (begins("#pragma") && !begins("#pragma list")) return Line::Range;
  return Line::Other;
}

// All ways to make a program smaller, numbered from 0: does the one with the number, if it exists.
class Cutter {
 public:
  Cutter(Program& program, size_t number) : left_(number) {
    for (Function& function : program.functions)
      if (list(function.body.body)) return;
    head(program.head);
    for (Function& function : program.functions) lines(function.before);
  }
  bool done() const { return done_; }

 private:
  bool now() {
    done_ = left_ == 0;
    if (!done_) --left_;
    return done_;
  }

  // The numbers of the variables must stay: of declarations, only the last one can go.
  void head(std::vector<std::string>& text) {
    bool later[4] = {};
    for (size_t i = text.size(); i-- > 0 && !done_;) {
      const Line kind = kind_of(text[i]);
      const bool fixed = kind == Line::Range || (kind != Line::Other && later[static_cast<size_t>(kind)]);
      later[static_cast<size_t>(kind)] = true;
      if (!fixed && now()) text.erase(text.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void lines(std::vector<std::string>& text) {
    for (size_t i = 0; i < text.size() && !done_; ++i)
      if (now()) text.erase(text.begin() + static_cast<std::ptrdiff_t>(i));
  }

  bool list(std::vector<Stmt>& body) {
    for (size_t i = 0; i < body.size(); ++i) {
      if (now()) {
        body.erase(body.begin() + static_cast<std::ptrdiff_t>(i));
        return true;
      }
      if (statement(body[i])) return true;
    }
    return false;
  }

  bool statement(Stmt& stmt) {
    for (size_t i = 0; i < stmt.body.size() && stmt.kind != StmtKind::Switch; ++i) {
      if (now()) {
        Stmt inner = std::move(stmt.body[i]);
        stmt = std::move(inner);
        return true;
      }
    }
    if (stmt.kind == StmtKind::Block || stmt.kind == StmtKind::Switch) {
      if (list(stmt.body)) return true;
    } else {
      for (Stmt& inner : stmt.body)
        if (statement(inner)) return true;
    }
    if (stmt.kind == StmtKind::Case) return false;
    for (Expr& expr : stmt.exprs)
      if (expression(expr, false)) return true;
    return false;
  }

  // A target has to stay one.
  bool expression(Expr& expr, bool target) {
    if (!target) {
      for (size_t i = 0; i < expr.parts.size(); ++i) {
        if (now()) {
          Expr part = std::move(expr.parts[i]);
          expr = std::move(part);
          return true;
        }
      }
      if (expr.kind != ExprKind::Number && expr.kind != ExprKind::Nothing && expr.kind != ExprKind::Call &&
          now()) {
        expr = {};
        expr.kind = ExprKind::Number;
        expr.value = 1;
        expr.text = "1";
        return true;
      }
    }
    if (expr.kind == ExprKind::Macro) return false;  // its text stands in the head
    const bool first_is_target = expr.kind == ExprKind::Assign || expr.kind == ExprKind::Step;
    for (size_t i = 0; i < expr.parts.size(); ++i)
      if (expression(expr.parts[i], i == 0 && first_is_target)) return true;
    return false;
  }

  size_t left_;
  bool done_ = false;
};

// What has no effect may be left out by the compiler with all faults in it, so a cut must not make such a
// thing.
bool is_effect(const Expr& expr) {
  switch (expr.kind) {
    case ExprKind::Nothing:
    case ExprKind::Assign:
    case ExprKind::Step:
    case ExprKind::Call:
    case ExprKind::Macro:
    case ExprKind::CopyBlock:
    case ExprKind::Bits: return true;
    case ExprKind::Comma: return is_effect(expr.parts[0]) && is_effect(expr.parts[1]);
    case ExprKind::Conditional: return is_effect(expr.parts[1]) && is_effect(expr.parts[2]);
    default: return false;
  }
}

bool commas_have_effect(const Expr& expr) {
  if (expr.kind == ExprKind::Comma && !is_effect(expr.parts[0])) return false;
  return std::all_of(expr.parts.begin(), expr.parts.end(), commas_have_effect);
}

bool every_part_counts(const Stmt& stmt) {
  for (size_t i = 0; i < stmt.exprs.size(); ++i) {
    const bool discarded = stmt.kind == StmtKind::Effect || (stmt.kind == StmtKind::For && i != 1);
    if (!commas_have_effect(stmt.exprs[i]) || (discarded && !is_effect(stmt.exprs[i]))) return false;
  }
  return std::all_of(stmt.body.begin(), stmt.body.end(), every_part_counts);
}

bool every_part_counts(const Program& program) {
  return std::all_of(program.functions.begin(), program.functions.end(),
                     [](const Function& function) { return every_part_counts(function.body); });
}

std::string compare(Program& program, const std::string& source, const Outcome& expected) {
  const ToolchainRun run = run_toolchain(program, source);
  return run.trouble.empty() ? difference(program, expected, run.outcome) : run.trouble;
}

}  // namespace

std::string difference(const Program& program, const Outcome& expected, const Outcome& got) {
  const std::string want = fault_text(expected), have = fault_text(got);
  if (want != have) return "expected " + want + ", got " + have;
  for (size_t n = 0; n < expected.variables.size(); ++n) {
    const auto number = static_cast<int32_t>(n);
    if (number >= program.first_temporary && number <= program.last_temporary) continue;
    if (!expected.open.empty() && expected.open[n]) continue;
    if (expected.variables[n] != got.variables[n])
      return "H" + std::to_string(n) + ": expected " + std::to_string(expected.variables[n]) + ", got " +
             std::to_string(got.variables[n]);
  }
  return "";
}

std::string difference_to_tree(Program& program) {
  const std::string source = source_text(program);
  const Outcome expected = evaluate(program);
  return expected.ended ? compare(program, source, expected) : "";
}

std::string difference_to_gcc(Program& program) {
  const std::string source = source_text(program);
  const Outcome by_tree = evaluate(program);
  if (!by_tree.ended) return "";
  GccRun run = run_with_gcc({program});
  if (!run.trouble.empty()) return run.trouble;
  run.outcomes[0].open = by_tree.open;
  return compare(program, source, run.outcomes[0]);
}

Program reduce(Program program, const std::function<bool(Program&)>& differs) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    for (size_t number = 0;; ++number) {
      Program candidate = program;
      if (!Cutter(candidate, number).done()) break;
      if (!every_part_counts(candidate) || !differs(candidate)) continue;
      program = std::move(candidate);
      smaller = true;
      --number;  // the next cut has this number now
    }
  }
  return program;
}

}  // namespace ipos::tests
