// What can be wrong in expressions: constants, operators, signs, arguments of system functions.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "compiler/ast/print.hpp"
#include "compiler/mutants/finder.hpp"
#include "compiler/sema/fold.hpp"
#include "vm/isa/blocks.hpp"

namespace ipos::compiler::mutants {
namespace {

using checked::BinaryOp;
using checked::Expr;

// What an operator is mistaken for. Of a comparison it is the limit that is missed: who notices this notices a comparison
// that is all wrong, too.
struct OperatorRow {
  BinaryOp op;
  BinaryOp other;
  Kind kind;
};
constexpr OperatorRow kOperators[] = {
    {BinaryOp::Mul, BinaryOp::Div, Kind::Sign},
    {BinaryOp::Div, BinaryOp::Mul, Kind::Sign},
    {BinaryOp::Mod, BinaryOp::Div, Kind::Sign},
    {BinaryOp::Add, BinaryOp::Sub, Kind::Sign},
    {BinaryOp::Sub, BinaryOp::Add, Kind::Sign},
    {BinaryOp::Shl, BinaryOp::Shr, Kind::Sign},
    {BinaryOp::Shr, BinaryOp::Shl, Kind::Sign},
    {BinaryOp::Lt, BinaryOp::Le, Kind::Comparison},
    {BinaryOp::Le, BinaryOp::Lt, Kind::Comparison},
    {BinaryOp::Gt, BinaryOp::Ge, Kind::Comparison},
    {BinaryOp::Ge, BinaryOp::Gt, Kind::Comparison},
    {BinaryOp::Eq, BinaryOp::Ne, Kind::Comparison},
    {BinaryOp::Ne, BinaryOp::Eq, Kind::Comparison},
    {BinaryOp::And, BinaryOp::Or, Kind::Mask},
    {BinaryOp::Xor, BinaryOp::Or, Kind::Mask},
    {BinaryOp::Or, BinaryOp::And, Kind::Mask},
    {BinaryOp::LogicalAnd, BinaryOp::LogicalOr, Kind::Condition},
    {BinaryOp::LogicalOr, BinaryOp::LogicalAnd, Kind::Condition},
};

const OperatorRow& row_of(BinaryOp op) {
  return *std::find_if(std::begin(kOperators), std::end(kOperators), [op](const OperatorRow& row) { return row.op == op; });
}

bool is_logical(BinaryOp op) { return op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr; }

// Whether the command works on blocks of the same form with another keyword.
bool same_blocks(vm::Opcode opcode, int32_t keyword, int32_t other) {
  for (size_t operand = 0; operand < vm::kMaxOperands; ++operand) {
    const auto alike = [](const vm::BlockInfo& a, const vm::BlockInfo& b) {
      return a.variables == b.variables && a.use == b.use && a.type == b.type;
    };
    if (!std::ranges::equal(vm::blocks_of(opcode, operand, keyword), vm::blocks_of(opcode, operand, other), alike))
      return false;
  }
  return true;
}

// The next word of the set with which the command takes the same; itself where there is none.
const vm::KeywordInfo& next_keyword(vm::Opcode opcode, const vm::KeywordInfo& keyword) {
  const auto table = vm::keyword_table();
  const auto at = static_cast<size_t>(&keyword - table.data());
  for (size_t n = 1; n < table.size(); ++n) {
    const vm::KeywordInfo& other = table[(at + n) % table.size()];
    if (other.set == keyword.set && same_blocks(opcode, keyword.value, other.value)) return other;
  }
  return keyword;
}

}  // namespace

void Finder::part(Expr& expr) {
  value(expr);
  swap_variables(expr, false);
}

void Finder::condition_part(Expr& expr) {
  condition(expr);
  swap_variables(expr, true);
}

void Finder::value(Expr& expr, Role role) {
  std::visit([&](auto& node) { find_in(expr, node, role); }, expr.node);
}

// Operators in the text of a macro of a built-in header are right.
bool Finder::is_built_in(Span span) const {
  const std::optional<MacroUse> macro = texts_.macro_of(span);
  return macro && macro->built_in;
}

// A value that is no comparison may be the opposite of what is meant.
void Finder::condition(Expr& expr) {
  if (auto* node = std::get_if<checked::Binary>(&expr.node)) {
    if (is_logical(node->op)) {
      operate(expr, node->op, node->op_span);
      condition(*node->left);
      return condition(*node->right);
    }
    if (is_comparison(node->op)) return value(expr);
  }
  if (std::holds_alternative<checked::Constant>(expr.node)) return value(expr, Role::Truth);
  const auto* unary = std::get_if<checked::Unary>(&expr.node);
  if (unary == nullptr || unary->op != checked::UnaryOp::Not) {
    Expr opposite{expr.span, checked::Unary{checked::UnaryOp::Not, program_.arena.make(expr)}};
    const std::optional<MacroUse> macro = texts_.macro_of(expr.span);
    const std::string text = macro && !macro->built_in ? texts_.written(expr.span) : texts_.used(expr.span);
    const bool simple = text.find_first_of(" &|+-*/<>=") == std::string::npos;
    add(Kind::Condition, expr.span, fmt::format("{0} became {1}{0}{2}", text, simple ? "!" : "!(", simple ? "" : ")"),
        {.exprs = {{&expr, opposite}}});
  }
  value(expr);
}

int32_t Finder::changed(int32_t value, Role role) {
  const auto bits = static_cast<uint32_t>(value);
  switch (role) {
    case Role::Truth: return value == 0;
    case Role::Mask: {
      const bool single = (bits & (bits - 1)) == 0;
      constexpr uint32_t kHighest = 1U << 31;
      if (bits == kHighest) return 1 << 30;
      return static_cast<int32_t>(value == 0 ? 1U : single ? bits << 1 : bits & (bits - 1));
    }
    case Role::Shift: return value < 31 ? value + 1 : value - 1;
    case Role::Wait: return value <= 0 ? 1 : *fold(BinaryOp::Mul, value, 2);
    case Role::Divisor:
      if (value == 1 || value == -1) return 2 * value;
      break;
    case Role::Plain: break;
  }
  if (value < 0) return *fold(BinaryOp::Sub, 0, value == std::numeric_limits<int32_t>::min() ? value + 1 : value);
  if (value < 2) return value == 0;
  const int32_t tenth = std::max(1, value / 10);
  return value > std::numeric_limits<int32_t>::max() - tenth ? value - tenth : value + tenth;
}

// In the text of a macro of the program: whatever its first use is for, all have the same mistake.
int32_t Finder::changed_at(Span span, int32_t value, Role role) {
  const std::optional<MacroUse> macro = texts_.macro_of(span);
  if (!macro || macro->built_in) return changed(value, role);
  return macro_values_.try_emplace({texts_.spelling(span.begin).value, value}, changed(value, role)).first->second;
}

void Finder::find_in(Expr& expr, checked::Constant& node, Role role) {
  const std::string written = texts_.written(expr.span);
  if (written.starts_with("numof")) return;  // the number of a variable is no constant of the program's author
  const int32_t other = changed_at(expr.span, node.value, role);
  if (other == 0 && role == Role::Divisor) return;
  const bool hex = written.find("0x") == 0 || written.find("0X") == 0;
  const auto number = [hex](int32_t value) { return hex ? fmt::format("{:#x}", static_cast<uint32_t>(value)) : std::to_string(value); };
  const bool literal = !written.empty() && written.find_first_not_of("-0123456789abcdefABCDEFxX") == std::string::npos;
  const Kind kind = role == Role::Mask ? Kind::Mask : node.value < 0 && role == Role::Plain ? Kind::Sign : Kind::Constant;
  add(kind, expr.span,
      fmt::format("{} became {}", literal ? written : fmt::format("{} ({})", written, node.value), number(other)),
      {.exprs = {{&expr, {expr.span, checked::Constant{other}}}}});
}

void Finder::find_in(Expr&, checked::Load& node, Role) { place(node.place); }

void Finder::find_in(Expr& expr, checked::Unary& node, Role) {
  switch (node.op) {
    case checked::UnaryOp::Minus: take_off(expr, *node.operand, Kind::Sign); break;
    case checked::UnaryOp::BitNot: take_off(expr, *node.operand, Kind::Mask); break;
    case checked::UnaryOp::Not: take_off(expr, *node.operand, Kind::Condition); break;
  }
  value(*node.operand);
}

void Finder::take_off(Expr& expr, const Expr& operand, Kind kind) {
  if (is_built_in(expr.span)) return;
  const bool in_macro = texts_.macro_of(expr.span).has_value();
  const auto text = [&](Span span) { return in_macro ? texts_.written(span) : texts_.used(span); };
  add(kind, expr.span, fmt::format("{} became {}", text(expr.span), text(operand.span)), {.exprs = {{&expr, operand}}});
}

void Finder::find_in(Expr& expr, checked::Step& node, Role) {
  checked::Step other = node;
  other.delta = -node.delta;
  const auto text = [](int32_t delta) { return delta > 0 ? "++" : "--"; };
  add(Kind::Sign, expr.span, fmt::format("{} became {}", text(node.delta), text(other.delta)),
      {.exprs = {{&expr, {expr.span, other}}}});
  place(node.place);
}

void Finder::find_in(Expr& expr, checked::Binary& node, Role) {
  if (!node.op_span.begin.valid()) {  // the compiler's own: only what the source has in it
    for (Expr* side : {node.left, node.right})
      if (!std::holds_alternative<checked::Constant>(side->node)) value(*side);
    return;
  }
  operate(expr, node.op, node.op_span);
  if (is_logical(node.op)) {
    condition(*node.left);
    return condition(*node.right);
  }
  const Role role = role_beside(node.op);
  value(*node.left, role == Role::Mask ? role : Role::Plain);
  value(*node.right, role);
}

Finder::Role Finder::role_beside(BinaryOp op) {
  switch (op) {
    case BinaryOp::And:
    case BinaryOp::Or:
    case BinaryOp::Xor: return Role::Mask;
    case BinaryOp::Shl:
    case BinaryOp::Shr: return Role::Shift;
    case BinaryOp::Mul:
    case BinaryOp::Div:
    case BinaryOp::Mod: return Role::Divisor;
    default: return Role::Plain;
  }
}

void Finder::operate(Expr& expr, BinaryOp op, Span op_span) {
  if (is_built_in(op_span)) return;
  const OperatorRow& row = row_of(op);
  Expr other = expr;
  if (auto* binary = std::get_if<checked::Binary>(&other.node)) binary->op = row.other;
  if (auto* assign = std::get_if<checked::Assign>(&other.node)) assign->op = row.other;
  const std::string_view end = std::holds_alternative<checked::Assign>(other.node) ? "=" : "";
  add(row.kind, op_span, fmt::format("{}{} became {}{}", ast::spelling(op), end, ast::spelling(row.other), end),
      {.exprs = {{&expr, other}}});
}

void Finder::find_in(Expr&, checked::Conditional& node, Role role) {
  condition(*node.condition);
  value(*node.then, role);
  value(*node.otherwise, role);
}

void Finder::find_in(Expr& expr, checked::Assign& node, Role) {
  if (node.op) operate(expr, *node.op, node.op_span);
  place(node.target);
  value(*node.value, node.op ? role_beside(*node.op) : Role::Plain);
}

void Finder::find_in(Expr&, checked::Comma& node, Role role) {
  value(*node.left);
  value(*node.right, role);
}

void Finder::find_in(Expr&, checked::CopyBlock&, Role) {}
void Finder::find_in(Expr&, checked::Call&, Role) {}

void Finder::find_in(Expr& expr, checked::SystemCall& node, Role) {
  for (size_t n = 0; n < node.arguments.size(); ++n) {
    if (const auto* inner = std::get_if<checked::ExprPtr>(&node.arguments[n]))
      value(**inner);
    else if (std::holds_alternative<int32_t>(node.arguments[n]))
      argument(expr, node, n);
  }
}

// What the compiler takes is within the ranges of the operand.
void Finder::argument(Expr& expr, const checked::SystemCall& node, size_t n) {
  const vm::OperandInfo& operand = vm::info(node.opcode).operands[n];
  const int32_t before = std::get<int32_t>(node.arguments[n]);
  std::vector<checked::Argument> arguments(node.arguments.begin(), node.arguments.end());
  const auto note = [&](Kind kind, int32_t after, std::string text) {
    if (after == before) return;
    arguments[n] = after;
    checked::SystemCall other = node;
    other.arguments = program_.arena.list(arguments);
    add(kind, node.places[n], std::move(text), {.exprs = {{&expr, {expr.span, other}}}});
  };
  if (operand.kind == vm::OperandKind::Bit) {
    const int32_t after = changed(before, Role::Shift);
    note(Kind::Mask, after, fmt::format("bit {} became bit {}", before, after));
  } else if (operand.kind == vm::OperandKind::Keyword) {
    const vm::KeywordInfo* keyword = vm::find_keyword(operand.keyword_set, before);
    if (keyword == nullptr) return;
    const vm::KeywordInfo& other = next_keyword(node.opcode, *keyword);
    const bool waits = operand.keyword_set == "go" || operand.keyword_set == "go0";
    note(waits ? Kind::Wait : Kind::Constant, other.value, fmt::format("{} became {}", keyword->constant, other.constant));
  } else if (operand.kind == vm::OperandKind::Constant) {
    const bool waits = node.opcode == vm::Opcode::WaitK;
    const bool mask = node.opcode == vm::Opcode::InputCall;
    const int32_t after = changed_at(node.places[n], before, waits ? Role::Wait : mask ? Role::Mask : Role::Plain);
    const bool spoken = waits && !texts_.macro_of(node.places[n]);
    note(waits ? Kind::Wait : mask ? Kind::Mask : Kind::Constant, after,
         spoken ? fmt::format("a wait of {} ms became one of {} ms", before, after) : fmt::format("{} became {}", before, after));
  }
}

// The number that is computed for it.
void Finder::place(const checked::Place& place) {
  if (place.offset != nullptr) value(*place.offset);
}

}  // namespace ipos::compiler::mutants
