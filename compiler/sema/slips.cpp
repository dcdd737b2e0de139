// Looks at the syntax tree and at the columns in which statements stand. What a macro gives is left alone: its text is not
// what stands there.
#include "compiler/sema/slips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "compiler/ast/print.hpp"
#include "compiler/ast/walk.hpp"
#include "compiler/sema/fold.hpp"
#include "compiler/sema/scope.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

using ast::BinaryOp;

// The same place or value, by its text. With `macros`, what the same macro gives is the same, too.
bool same(const ast::Expr& a, const ast::Expr& b, const SourceMap* macros = nullptr) {
  if (a.node.index() != b.node.index() || a.span.begin.in_macro() != b.span.begin.in_macro()) return false;
  if (a.span.begin.in_macro() &&
      (macros == nullptr || macros->expansion(a.span.begin).macro != macros->expansion(b.span.begin).macro))
    return false;
  return std::visit(
      ast::Overloaded{
          [&](const ast::Number& left) { return left.value == std::get<ast::Number>(b.node).value; },
          [&](const ast::Name& left) { return left.text == std::get<ast::Name>(b.node).text; },
          [&](const ast::Member& left) {
            const auto& right = std::get<ast::Member>(b.node);
            return left.member.text == right.member.text && same(*left.base, *right.base, macros);
          },
          [&](const ast::Index& left) {
            const auto& right = std::get<ast::Index>(b.node);
            return same(*left.base, *right.base, macros) && same(*left.index, *right.index, macros);
          },
          [&](const ast::Deref& left) { return same(*left.number, *std::get<ast::Deref>(b.node).number, macros); },
          [&](const ast::Unary& left) {
            const auto& right = std::get<ast::Unary>(b.node);
            return left.op == right.op && same(*left.operand, *right.operand, macros);
          },
          [&](const ast::Binary& left) {
            const auto& right = std::get<ast::Binary>(b.node);
            return left.op == right.op && same(*left.left, *right.left, macros) && same(*left.right, *right.right, macros);
          },
          [](const auto&) { return false; }},
      a.node);
}

// Statements that do the same: assignments, alone or in a block.
bool same(const ast::Stmt& a, const ast::Stmt& b) {
  const auto* left = std::get_if<ast::Block>(&a.node);
  const auto* right = std::get_if<ast::Block>(&b.node);
  if (left != nullptr && left->body.size() == 1) return same(*left->body.front(), b);
  if (right != nullptr && right->body.size() == 1) return same(a, *right->body.front());
  if (left != nullptr && right != nullptr)
    return !left->body.empty() && std::equal(left->body.begin(), left->body.end(), right->body.begin(), right->body.end(),
                                             [](const ast::Stmt* one, const ast::Stmt* other) { return same(*one, *other); });
  const auto* one = std::get_if<ast::ExprStmt>(&a.node);
  const auto* other = std::get_if<ast::ExprStmt>(&b.node);
  const auto* mine = one == nullptr ? nullptr : std::get_if<ast::Assign>(&one->expr->node);
  const auto* theirs = other == nullptr ? nullptr : std::get_if<ast::Assign>(&other->expr->node);
  return mine != nullptr && theirs != nullptr && mine->op == theirs->op && same(*mine->target, *theirs->target) &&
         same(*mine->value, *theirs->value);
}

bool is_constant(const ast::Expr& expr) {
  bool constant = true;
  const auto visit = [&constant](const ast::Expr& part) {
    constant = constant && !std::holds_alternative<ast::Name>(part.node) && !std::holds_alternative<ast::Deref>(part.node);
  };
  ast::walk(&expr, visit);
  return constant;
}

// What comparing or joining a value with itself gives; nothing where that is of use, as in a + a.
std::optional<std::string_view> with_itself(BinaryOp op) {
  switch (op) {
    case BinaryOp::Eq:
    case BinaryOp::Le:
    case BinaryOp::Ge: return "always true";
    case BinaryOp::Ne:
    case BinaryOp::Lt:
    case BinaryOp::Gt: return "never true";
    case BinaryOp::Sub:
    case BinaryOp::Xor: return "always 0";
    case BinaryOp::And:
    case BinaryOp::Or:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: return "the same as one of them";
    default: return std::nullopt;
  }
}

class Slips {
 public:
  Slips(const SourceMap& sources, Diagnostics& diagnostics) : sources_(sources), diagnostics_(diagnostics) {}

  void operator()(const ast::Expr& expr) {
    if (const auto* node = std::get_if<ast::Binary>(&expr.node)) check(*node);
    if (const auto* node = std::get_if<ast::Assign>(&expr.node)) check(*node, expr.span);
  }

  void operator()(const ast::Stmt& stmt) {
    if (const auto* node = std::get_if<ast::If>(&stmt.node)) check_else(stmt, *node), check_branches(*node);
    if (const auto* node = std::get_if<ast::Block>(&stmt.node))
      for (size_t n = 0; n + 1 < node->body.size(); ++n) check_next(*node->body[n], *node->body[n + 1]);
  }

 private:
  void check(const ast::Binary& node) {
    if (const auto result = with_itself(node.op); result && !is_constant(*node.left) && same(*node.left, *node.right))
      diagnostics_.report(Diag::SameOperands, node.op_span,
                          {std::string(ast::spelling(node.op)), std::string(*result)});
    const auto* pointer = std::get_if<ast::Deref>(&node.right->node);
    if (node.op != BinaryOp::Mul || pointer == nullptr || node.right->parenthesized) return;
    const auto* number = std::get_if<ast::Number>(&pointer->number->node);
    const Location star = node.right->span.begin;
    if (number == nullptr || star.in_macro() || node.op_span.end != star) return;
    diagnostics_.report(Diag::DoubleAsterisk, {node.op_span.begin, node.right->span.end},
                        {fmt::format("{}", number->value)});
  }

  // A system variable may act on what is written, or give another value each time.
  static bool of_the_unit(const ast::Expr& expr) {
    const auto* name = std::get_if<ast::Name>(&expr.node);
    uint32_t number = 0;
    return name != nullptr && raw_number(name->text, number) && number >= stdlib::kFirstSystemVariable;
  }

  void check(const ast::Assign& node, Span span) {
    if (!node.op && same(*node.target, *node.value) && !of_the_unit(*node.target))
      diagnostics_.report(Diag::SelfAssignment, span);
    const auto* step = node.op ? nullptr : std::get_if<ast::Step>(&node.value->node);
    if (step != nullptr && same(*node.target, *step->operand) && !of_the_unit(*node.target)) check_step(*step, *node.value, span);
  }

  // i = i++: the old value comes last.
  void check_step(const ast::Step& step, const ast::Expr& value, Span span) {
    const bool up = step.op == ast::StepOp::PostIncrement;
    if (!up && step.op != ast::StepOp::PostDecrement) return;
    diagnostics_.report(Diag::SelfAssignment, span)
        .notes.push_back({value.span, up ? "'++' alone is the statement that adds 1" : "'--' alone is the statement that takes 1 away"});
  }

  // The blanks before a statement that is the first of its line.
  std::optional<std::string_view> margin(Location at) const {
    const SourceFile* file = at.in_macro() ? nullptr : sources_.file_of(at);
    if (file == nullptr) return std::nullopt;
    const uint32_t end = at.value - file->base;
    uint32_t begin = end;
    while (begin > 0 && (file->text[begin - 1] == ' ' || file->text[begin - 1] == '\t')) --begin;
    if (begin > 0 && file->text[begin - 1] != '\n') return std::nullopt;
    return std::string_view(file->text).substr(begin, end - begin);
  }

  std::string line(Location at) const { return fmt::format("{}", sources_.position(at).line); }

  // The word `else` between two statements.
  std::optional<Location> else_between(Location from, Location to) const {
    if (from.in_macro() || to.in_macro()) return std::nullopt;
    const SourceFile* file = sources_.file_of(from);
    if (file == nullptr || file != sources_.file_of(to) || to.value < from.value) return std::nullopt;
    const std::string_view between = std::string_view(file->text).substr(from.value - file->base, to.value - from.value);
    const size_t at = between.find("else");
    if (at == std::string_view::npos || between.find("//") < at || between.find("/*") < at) return std::nullopt;
    return Location{from.value + static_cast<uint32_t>(at)};
  }

  // `if (a) if (b) x; else y;` with the `else` under the first `if`.
  void check_else(const ast::Stmt& outer, const ast::If& node) {
    if (node.otherwise != nullptr) return;
    const ast::Stmt* inner = node.then;
    for (const auto* next = std::get_if<ast::If>(&inner->node); next != nullptr;
         next = std::get_if<ast::If>(&inner->node)) {
      if (next->otherwise != nullptr) {
        const auto at = else_between(next->then->span.end, next->otherwise->span.begin);
        if (!at) return;
        const auto own = margin(*at), wrong = margin(outer.span.begin), right = margin(inner->span.begin);
        if (own && wrong && right && *own == *wrong && *own != *right)
          diagnostics_.report(Diag::DanglingElse, {*at, {at->value + 4}},
                              {line(inner->span.begin), line(outer.span.begin)});
        return;
      }
      inner = next->then;
    }
  }

  // `if (a) x; else if (a) y;` and `if (a) x; else x;`
  void check_branches(const ast::If& node) {
    if (node.otherwise == nullptr) return;
    if (same(*node.then, *node.otherwise))
      diagnostics_.report(Diag::SameOperands, node.otherwise->span, {"else", "the same, whatever the condition is"});
    const auto* next = std::get_if<ast::If>(&node.otherwise->node);
    for (; next != nullptr; next = next->otherwise == nullptr ? nullptr : std::get_if<ast::If>(&next->otherwise->node))
      if (same(*node.condition, *next->condition, &sources_)) {
        diagnostics_.report(Diag::DecidedCondition, next->condition->span, {"never"})
            .notes.push_back({node.condition->span, "it stands here, too, and is not true any more behind that 'else'"});
        return;
      }
  }

  struct Body {
    const ast::Stmt* stmt;
    const char* word;
  };
  // The statement that comes last of what depends on a condition.
  static std::optional<Body> last_body(const ast::Stmt& stmt) {
    if (const auto* node = std::get_if<ast::If>(&stmt.node))
      return node->otherwise != nullptr ? Body{node->otherwise, "else"} : Body{node->then, "if"};
    if (const auto* node = std::get_if<ast::While>(&stmt.node)) return Body{node->body, "while"};
    if (const auto* node = std::get_if<ast::For>(&stmt.node)) return Body{node->body, "for"};
    return std::nullopt;
  }

  // A statement behind `if (a) x;` in the column of x.
  void check_next(const ast::Stmt& stmt, const ast::Stmt& next) {
    auto body = last_body(stmt);
    const auto column = body ? margin(next.span.begin) : std::nullopt;
    if (!column || std::holds_alternative<ast::Case>(next.node) || std::holds_alternative<ast::Default>(next.node)) return;
    const ast::Stmt* guard = &stmt;
    for (; body; body = last_body(*guard)) {
      const auto outer = margin(guard->span.begin);
      const auto own = margin(body->stmt->span.begin);
      const bool plain = !std::holds_alternative<ast::Block>(body->stmt->node) &&
                         !std::holds_alternative<ast::Empty>(body->stmt->node);
      if (plain && outer && own && *own == *column && own->size() > outer->size() && own->starts_with(*outer)) {
        diagnostics_.report(Diag::MisleadingIndentation, next.span, {body->word, line(guard->span.begin)});
        return;
      }
      guard = body->stmt;
    }
  }

  const SourceMap& sources_;
  Diagnostics& diagnostics_;
};

}  // namespace

void check_slips(const ast::Stmt& body, const SourceMap& sources, Diagnostics& diagnostics) {
  Slips slips(sources, diagnostics);
  ast::walk(&body, slips);
}

}  // namespace ipos::compiler
