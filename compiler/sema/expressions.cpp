// Values, conditions and effects: operators, assignments and calls.
#include "compiler/sema/expressions.hpp"

#include <fmt/format.h>

#include "compiler/ast/print.hpp"
#include "compiler/sema/decided.hpp"
#include "compiler/sema/fold.hpp"
#include "stdlib/language_tables.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::compiler {

using checked::ExprPtr;

constexpr uint32_t kMostExplained = 100;  // ours

const int32_t* constant_value(const ExprPtr& expr) {
  if (expr == nullptr) return nullptr;
  const auto* constant = std::get_if<checked::Constant>(&expr->node);
  return constant == nullptr ? nullptr : &constant->value;
}

bool has_effect(const checked::Expr& expr) {
  const auto in = [](const ExprPtr& part) { return part != nullptr && has_effect(*part); };
  struct Visitor {
    decltype(in)& part;
    bool operator()(const checked::Constant&) { return false; }
    bool operator()(const checked::Load& node) { return part(node.place.offset); }
    bool operator()(const checked::Unary& node) { return part(node.operand); }
    bool operator()(const checked::Step&) { return true; }
    bool operator()(const checked::Binary& node) { return part(node.left) || part(node.right); }
    bool operator()(const checked::Conditional& node) {
      return part(node.condition) || part(node.then) || part(node.otherwise);
    }
    bool operator()(const checked::Assign&) { return true; }
    bool operator()(const checked::Comma& node) { return part(node.left) || part(node.right); }
    bool operator()(const checked::CopyBlock&) { return true; }
    bool operator()(const checked::Call&) { return true; }
    bool operator()(const checked::SystemCall&) { return true; }
  };
  return std::visit(Visitor{in}, expr.node);
}

ExprPtr ExpressionChecker::value(const ast::Expr& expr) {
  return std::visit([&](const auto& node) { return value_of(node, expr); }, expr.node);
}

ExprPtr ExpressionChecker::condition(const ast::Expr& expr) {
  const auto* assign = std::get_if<ast::Assign>(&expr.node);
  if (assign != nullptr && !assign->op && !expr.parenthesized)
    context_.diagnostics.report(Diag::AssignmentInCondition, expr.span);
  return value(expr);
}

ExprPtr ExpressionChecker::effect(const ast::Expr& expr) {
  if (const auto* node = std::get_if<ast::Call>(&expr.node)) return call(*node, expr.span);
  if (const auto* node = std::get_if<ast::Comma>(&expr.node)) {
    ExprPtr left = effect(*node->left);
    ExprPtr right = effect(*node->right);
    if (!left || !right) return nullptr;
    return make_expr(expr.span, checked::Comma{left, right});
  }
  if (const auto* node = std::get_if<ast::Conditional>(&expr.node)) {
    ExprPtr when = condition(*node->condition);
    check_decided(*node->condition, when, ConditionOf::Choice, context_);
    ExprPtr then = effect(*node->then);
    ExprPtr otherwise = effect(*node->otherwise);
    if (!when || !then || !otherwise) return nullptr;
    return make_expr(expr.span, checked::Conditional{when, then, otherwise});
  }
  if (const auto* node = std::get_if<ast::Assign>(&expr.node); node != nullptr && !node->op) {
    auto left = target(*node->target);
    if (left && !left->type.scalar()) return copy_structure(*node, std::move(*left), expr.span);
    return assign(*node, left, expr.span);
  }
  ExprPtr result = value(expr);
  if (result != nullptr && !has_effect(*result)) context_.diagnostics.report(Diag::UnusedValue, expr.span);
  return result;
}

std::optional<int32_t> ExpressionChecker::constant(const ast::Expr& expr, const char* what) {
  in_constant_ = true;
  const ExprPtr result = value(expr);
  in_constant_ = false;
  if (result == nullptr) return std::nullopt;
  if (const int32_t* known = constant_value(result)) return *known;
  const auto* division = std::get_if<checked::Binary>(&result->node);
  if (division != nullptr && constant_value(division->left) && constant_value(division->right))
    context_.diagnostics.report(Diag::ConstantDivision, expr.span);
  else
    context_.diagnostics.report(Diag::NotConstant, expr.span, {what});
  return std::nullopt;
}

ExprPtr ExpressionChecker::value_of(const ast::Number& node, const ast::Expr& expr) {
  return make_expr(expr.span, checked::Constant{node.value});
}

ExprPtr ExpressionChecker::value_of(const ast::Name&, const ast::Expr& expr) { return load(expr); }
ExprPtr ExpressionChecker::value_of(const ast::Member&, const ast::Expr& expr) { return load(expr); }
ExprPtr ExpressionChecker::value_of(const ast::Index&, const ast::Expr& expr) { return load(expr); }
ExprPtr ExpressionChecker::value_of(const ast::Deref&, const ast::Expr& expr) { return load(expr); }

ExprPtr ExpressionChecker::load(const ast::Expr& expr) {
  auto from = object(expr);
  if (!from) return nullptr;
  if (!from->type.scalar()) {
    const char* advice = from->type.count != 0 ? "one of its elements has" : "one of its members has";
    const bool named = std::holds_alternative<ast::Name>(expr.node);
    context_.diagnostics.report(
        Diag::NotAValue, expr.span,
        {from->text(),
         named ? fmt::format("{}, and numof( {} ) is its number", advice, from->name) : advice});
    return nullptr;
  }
  record_read(*from, expr.span);
  return make_expr(expr.span, checked::Load{from->place});
}

ExprPtr ExpressionChecker::value_of(const ast::Numof& node, const ast::Expr& expr) {
  if (const auto* name = std::get_if<ast::Name>(&node.object->node)) {
    const Entity* entity = context_.scope.find(name->text);
    if (entity != nullptr && std::holds_alternative<const FunctionName*>(*entity)) {
      context_.diagnostics.report(Diag::FunctionAsValue, node.object->span,
                                  {std::string(name->text), "numof( ... ) takes variables"});
      return nullptr;
    }
  }
  auto of = object(*node.object);
  if (!of) return nullptr;
  record_take(*of, expr.span);
  ExprPtr number = make_expr(expr.span, checked::Constant{of->place.number});
  if (of->place.offset == nullptr) return number;
  if (of->place.number == 0) return of->place.offset;
  return make_expr(expr.span, checked::Binary{ast::BinaryOp::Add, of->place.offset, number});
}

ExprPtr ExpressionChecker::value_of(const ast::Unary& node, const ast::Expr& expr) {
  ExprPtr operand = value(*node.operand);
  if (operand == nullptr || node.op == ast::UnaryOp::Plus) return operand;
  if (const int32_t* known = constant_value(operand)) {
    const int32_t result = node.op == ast::UnaryOp::Minus    ? *fold(ast::BinaryOp::Sub, 0, *known)
                           : node.op == ast::UnaryOp::BitNot ? ~*known
                                                             : *known == 0;
    return make_expr(expr.span, checked::Constant{result});
  }
  const checked::UnaryOp op = node.op == ast::UnaryOp::Minus    ? checked::UnaryOp::Minus
                              : node.op == ast::UnaryOp::BitNot ? checked::UnaryOp::BitNot
                                                                : checked::UnaryOp::Not;
  return make_expr(expr.span, checked::Unary{op, operand});
}

ExprPtr ExpressionChecker::value_of(const ast::Step& node, const ast::Expr& expr) {
  auto what = target(*node.operand);
  if (!what) return nullptr;
  if (!what->type.scalar()) {
    context_.diagnostics.report(Diag::NotAValue, expr.span, {what->text(), "++ and -- need one"});
    return nullptr;
  }
  record_read(*what, node.operand->span);
  record_write(*what, node.operand->span);
  const bool up = node.op == ast::StepOp::PreIncrement || node.op == ast::StepOp::PostIncrement;
  const bool prefix = node.op == ast::StepOp::PreIncrement || node.op == ast::StepOp::PreDecrement;
  return make_expr(expr.span, checked::Step{what->place, up ? 1 : -1, prefix, what->extent});
}

// A constant result that is not what the operator says. Hexadecimal numbers are bits, which may run over.
void ExpressionChecker::check_constants(const ast::Binary& node, int32_t left, int32_t right, Span span) {
  using ast::BinaryOp;
  const auto* a = std::get_if<ast::Number>(&node.left->node);
  const auto* b = std::get_if<ast::Number>(&node.right->node);
  if (node.op == BinaryOp::Div) {
    const auto macro = [&](Location at) { return at.in_macro() ? context_.sources.expansion(at).macro : std::string_view(); };
    const bool written = a != nullptr && b != nullptr && macro(span.begin) == macro(node.right->span.begin);
    if (written && left != 0 && right != 0 && left / int64_t{right} == 0)
      context_.diagnostics.report(Diag::ConstantQuotient, span, {fmt::format("{}", left), fmt::format("{}", right)});
    return;
  }
  const int64_t exact = node.op == BinaryOp::Mul   ? int64_t{left} * right
                        : node.op == BinaryOp::Add ? int64_t{left} + right
                        : node.op == BinaryOp::Sub ? int64_t{left} - right
                                                   : 0;
  const bool bits = (a != nullptr && a->hex) || (b != nullptr && b->hex);
  if (bits || (exact >= INT32_MIN && exact <= INT32_MAX)) return;
  context_.diagnostics.report(
      Diag::ConstantOverflow, span,
      {fmt::format("{} {} {}", left, ast::spelling(node.op), right), fmt::format("{}", exact),
       fmt::format("{}", *fold(node.op, left, right))});
}

ExprPtr ExpressionChecker::value_of(const ast::Binary& node, const ast::Expr& expr) {
  using ast::BinaryOp;
  ExprPtr left = value(*node.left);
  ExprPtr right = value(*node.right);
  if (!left || !right) return nullptr;
  check_divisor(node.op, *right);
  const int32_t* a = constant_value(left);
  const int32_t* b = constant_value(right);
  if (a != nullptr && b != nullptr) {
    check_constants(node, *a, *b, expr.span);
    if (const auto result = fold(node.op, *a, *b)) return make_expr(expr.span, checked::Constant{*result});
  } else if (a != nullptr && (node.op == BinaryOp::LogicalAnd || node.op == BinaryOp::LogicalOr)) {
    const bool decided = (*a != 0) == (node.op == BinaryOp::LogicalOr);
    if (decided) return make_expr(expr.span, checked::Constant{node.op == BinaryOp::LogicalOr});
    ExprPtr zero = make_expr(expr.span, checked::Constant{0});
    return make_expr(expr.span, checked::Binary{BinaryOp::Ne, right, zero});
  }
  return make_expr(expr.span, checked::Binary{node.op, left, right, node.op_span});
}

ExprPtr ExpressionChecker::value_of(const ast::Conditional& node, const ast::Expr& expr) {
  ExprPtr when = condition(*node.condition);
  check_decided(*node.condition, when, ConditionOf::Choice, context_);
  ExprPtr then = value(*node.then);
  ExprPtr otherwise = value(*node.otherwise);
  if (!when || !then || !otherwise) return nullptr;
  if (const int32_t* known = constant_value(when)) return *known != 0 ? then : otherwise;
  return make_expr(expr.span, checked::Conditional{when, then, otherwise});
}

ExprPtr ExpressionChecker::value_of(const ast::Assign& node, const ast::Expr& expr) {
  return assign(node, target(*node.target), expr.span);
}

ExprPtr ExpressionChecker::assign(const ast::Assign& node, std::optional<Object> left, Span span) {
  if (left && !node.op && left->place.offset == nullptr &&
      std::holds_alternative<ast::Numof>(node.value->node))
    taken_into_ = static_cast<uint32_t>(left->place.number);
  ExprPtr right = value(*node.value);
  taken_into_ = UINT32_MAX;
  if (!left || !right) return nullptr;
  if (!left->type.scalar()) {
    context_.diagnostics.report(Diag::NotAValue, node.target->span,
                                {left->text(), "it can be assigned as a statement of its own only"});
    return nullptr;
  }
  if (node.op) {
    check_divisor(*node.op, *right);
    record_read(*left, node.target->span);
  }
  record_write(*left, node.target->span);
  const int32_t* known = constant_value(right);
  if (!node.op && known != nullptr && left->place.offset == nullptr)
    context_.stores.push_back({static_cast<uint32_t>(left->place.number), *known, span});
  return make_expr(span, checked::Assign{node.op, left->place, right, node.op_span, left->extent});
}

ExprPtr ExpressionChecker::copy_structure(const ast::Assign& node, Object target, Span span) {
  const auto fixed = [&](const Object& object, Span at) {
    if (object.place.offset == nullptr) return true;
    context_.diagnostics.report(Diag::NotAValue, at,
                                {object.text(),
                                 "an element found by a computed index is copied member by member; with a "
                                 "constant index it is copied as a whole"});
    return false;
  };
  const bool whole = std::holds_alternative<ast::Name>(node.value->node) ||
                     std::holds_alternative<ast::Member>(node.value->node) ||
                     std::holds_alternative<ast::Index>(node.value->node);
  if (!whole) {
    context_.diagnostics.report(Diag::NotAValue, node.target->span,
                                {target.text(), "one of its members or elements has"});
    return nullptr;
  }
  auto source = object(*node.value);
  if (!source) return nullptr;
  if (source->type.structure != target.type.structure || source->type.count != target.type.count) {
    context_.diagnostics.report(Diag::StructureMismatch, span, {target.text(), source->text()});
    return nullptr;
  }
  if (!fixed(target, node.target->span) || !fixed(*source, node.value->span)) return nullptr;
  record_read(*source, node.value->span);
  record_write(target, node.target->span);
  return make_expr(span, checked::CopyBlock{static_cast<uint16_t>(target.place.number),
                                            static_cast<uint16_t>(source->place.number),
                                            static_cast<uint16_t>(target.type.size())});
}

ExprPtr ExpressionChecker::value_of(const ast::Comma& node, const ast::Expr& expr) {
  ExprPtr left = effect(*node.left);
  ExprPtr right = value(*node.right);
  if (!left || !right) return nullptr;
  return make_expr(expr.span, checked::Comma{left, right});
}

ExprPtr ExpressionChecker::value_of(const ast::Call& node, const ast::Expr& expr) {
  if (call(node, expr.span) != nullptr)
    context_.diagnostics.report(Diag::CallHasNoValue, expr.span, {std::string(node.function.text)});
  return nullptr;
}

ExprPtr ExpressionChecker::call(const ast::Call& node, Span span) {
  const Entity* entity = context_.scope.find(node.function.text);
  if (entity == nullptr) {
    if (stdlib::find_system_function(node.function.text) != nullptr)
      return check_system_call(context_, *this, node, span);
    uint32_t number = 0;
    if (raw_number(node.function.text, number))
      context_.diagnostics.report(Diag::NotAFunction, node.function.span, {std::string(node.function.text)});
    else
      unknown_name(node.function.text, node.function.span, true);
    return nullptr;
  }
  const auto* function = std::get_if<const FunctionName*>(entity);
  if (function == nullptr) {
    context_.diagnostics.report(Diag::NotAFunction, node.function.span, {std::string(node.function.text)});
    return nullptr;
  }
  if (!node.arguments.empty()) {
    context_.diagnostics.report(
        Diag::ArgumentCount, node.arguments.front()->span,
        {std::string(node.function.text), "no arguments", fmt::format("{}", node.arguments.size())});
    return nullptr;
  }
  return make_expr(span, checked::Call{(*function)->index});
}

// Division by a constant zero, and shift counts, which are brought into 0..31 here.
void ExpressionChecker::check_divisor(ast::BinaryOp op, checked::Expr& right) {
  auto* known = std::get_if<checked::Constant>(&right.node);
  if (known == nullptr) return;
  if ((op == ast::BinaryOp::Div || op == ast::BinaryOp::Mod) && known->value == 0 && !in_constant_)
    context_.diagnostics.report(Diag::DivisionByZero, right.span);
  if ((op == ast::BinaryOp::Shl || op == ast::BinaryOp::Shr) && (known->value < 0 || known->value > 31)) {
    context_.diagnostics.report(Diag::ShiftCount, right.span,
                                {fmt::format("{}", known->value), fmt::format("{}", known->value & 31)});
    known->value &= 31;
  }
}

void ExpressionChecker::unknown_name(std::string_view name, Span span, bool function) {
  if (!context_.reported_names.emplace(name).second) return;
  Diagnostic& message = context_.diagnostics.report(function ? Diag::UnknownFunction : Diag::UnknownName,
                                                    span, {std::string(name)});
  if (const auto place = context_.tree->left_out.find(name); place != context_.tree->left_out.end()) {
    message.notes.push_back({place->second.name, fmt::format("'{}' stands here, in a part that is left out", name)});
    message.notes.push_back({place->second.condition, "by this condition"});
    return;
  }
  const stdlib::Parameter* parameter =
      !function && name.starts_with('P') ? stdlib::parameter_table(context_.unit).find(name) : nullptr;
  if (parameter != nullptr && name.size() == 4 && parameter->number == name.substr(1)) {
    message.notes.push_back({{}, fmt::format("parameters are no variables: '_MoviLink' reads and writes {}, which has index {}",
                                             name, parameter->index)});
    return;
  }
  // A search of all names for each of many unknown ones would take long, and nobody reads it.
  if (context_.diagnostics.error_count() > kMostExplained) return;
  context_.scope.explain_unknown(message, name, function, context_.unit.has(stdlib::Trait::NewVariables));
}

}  // namespace ipos::compiler
