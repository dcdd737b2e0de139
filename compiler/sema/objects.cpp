// Objects: names, members, elements and *p, resolved to places; and the record of who uses which variable.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/sema/expressions.hpp"
#include "compiler/sema/fold.hpp"
#include "stdlib/header_names.hpp"
#include "stdlib/language_tables.hpp"
#include "stdlib/spelling.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

using checked::ExprPtr;

// "PO1, PO2, PO3", of a long structure the first ones.
std::string members_text(const StructType& type) {
  constexpr size_t kMost = 20;
  std::string text;
  for (size_t n = 0; n < std::min(type.members.size(), kMost); ++n)
    text += (n == 0 ? "" : ", ") + std::string(fmt::format("{}", fmt::join(type.members[n].names, "/")));
  return text + (type.members.size() > kMost ? ", ..." : "");
}

// Takes `+ K` and `- K` out of an expression: it becomes part of the fixed number.
ExprPtr split_constant(ExprPtr expr, int32_t& number) {
  auto* sum = std::get_if<checked::Binary>(&expr->node);
  if (sum == nullptr || (sum->op != ast::BinaryOp::Add && sum->op != ast::BinaryOp::Sub)) return expr;
  const int32_t* known = constant_value(sum->right);
  if (known == nullptr) return expr;
  number = *fold(sum->op, number, *known);
  return split_constant(sum->left, number);
}

}  // namespace

std::string Object::text() const {
  uint32_t number = 0;
  if (variable == nullptr && raw_number(name, number)) return std::string(name);
  if (!name.empty()) return fmt::format("'{}'", name);
  return place.offset != nullptr ? "the variable behind the '*'" : fmt::format("H{}", place.number);
}

ExprPtr ExpressionChecker::combine(ast::BinaryOp op, ExprPtr left, ExprPtr right) {
  return make_expr(right->span, checked::Binary{op, left, right});
}

std::optional<Object> ExpressionChecker::object(const ast::Expr& expr) {
  if (const auto* node = std::get_if<ast::Name>(&expr.node)) return object_of(*node, expr);
  if (const auto* node = std::get_if<ast::Member>(&expr.node)) return object_of(*node, expr);
  if (const auto* node = std::get_if<ast::Index>(&expr.node)) return object_of(*node, expr);
  if (const auto* node = std::get_if<ast::Deref>(&expr.node)) return object_of(*node, expr);
  // numof( 5 ), 5.x, (a + b)[1]: check what is inside for its own mistakes, then say what is wrong here.
  if (value(expr) != nullptr)
    context_.diagnostics.report(Diag::NotAssignable, expr.span, {"this expression is no variable and"});
  return std::nullopt;
}

// DO01 is an expression of the standard headers, which have SET_DO01 and CLEAR_DO01 for an output.
void ExpressionChecker::explain_port(Diagnostic& message, Location at) const {
  if (!at.in_macro()) return;
  const std::string name(context_.sources.expansion(at).macro);
  const bool b_headers = context_.unit.has(stdlib::Trait::NewVariables);
  std::vector<std::string> orders;
  for (const char* order : {"SET_", "CLEAR_"})
    if (stdlib::find_header_name(order + name, b_headers) != nullptr) orders.push_back(order + name);
  if (!orders.empty()) message.notes.push_back({{}, fmt::format("'{}' changes it", fmt::join(orders, "' or '"))});
}

std::optional<Object> ExpressionChecker::target(const ast::Expr& expr) {
  const bool place =
      std::holds_alternative<ast::Name>(expr.node) || std::holds_alternative<ast::Member>(expr.node) ||
      std::holds_alternative<ast::Index>(expr.node) || std::holds_alternative<ast::Deref>(expr.node);
  if (place) return object(expr);
  if (std::holds_alternative<ast::Number>(expr.node))
    context_.diagnostics.report(Diag::NotAssignable, expr.span, {"a constant"});
  else if (value(expr) != nullptr)
    explain_port(context_.diagnostics.report(Diag::NotAssignable, expr.span, {"the result of an expression"}), expr.span.begin);
  return std::nullopt;
}

std::optional<Object> ExpressionChecker::object_of(const ast::Name& node, const ast::Expr& expr) {
  uint32_t number = 0;
  if (raw_number(node.text, number)) {
    if (!context_.use_raw(number, expr.span, node.text)) return std::nullopt;
    return Object{
        {}, {static_cast<int32_t>(number), nullptr}, node.text, NumberRange{number, number}, nullptr};
  }
  const Entity* entity = context_.scope.find(node.text);
  if (entity == nullptr) {
    if (const auto* function = stdlib::find_system_function(node.text))
      context_.diagnostics.report(
          Diag::FunctionAsValue, expr.span,
          {std::string(node.text),
           fmt::format("'{}({})' calls it", node.text, function->arguments.empty() ? "" : " ... ")});
    else
      unknown_name(node.text, expr.span, false);
    return std::nullopt;
  }
  if (const auto* function = std::get_if<const FunctionName*>(entity)) {
    context_.diagnostics.report(Diag::FunctionAsValue, expr.span,
                                {(*function)->name, fmt::format("'{}()' calls it", (*function)->name)});
    return std::nullopt;
  }
  const auto* found = std::get_if<const Variable*>(entity);
  if (found == nullptr) {
    context_.diagnostics.report(Diag::TypeAsValue, expr.span, {std::string(node.text)});
    return std::nullopt;
  }
  const Variable& variable = **found;
  if (variable.order > context_.order)
    context_.diagnostics.report(Diag::UsedBeforeDeclaration, expr.span, {std::string(node.text)})
        .notes.push_back({variable.span, "declared here"});
  const NumberRange extent{variable.number, variable.number + variable.type.size() - 1};
  return Object{
      variable.type, {static_cast<int32_t>(variable.number), nullptr}, node.text, extent, &variable};
}

std::optional<Object> ExpressionChecker::object_of(const ast::Member& node, const ast::Expr&) {
  auto base = object(*node.base);
  if (!base) return std::nullopt;
  const StructType* type = base->type.structure;
  if (type == nullptr || base->type.count != 0) {
    context_.diagnostics.report(Diag::NotAStructure, node.member.span,
                                {base->text(), std::string(node.member.text)});
    return std::nullopt;
  }
  const StructMember* member = type->find(node.member.text);
  if (member == nullptr) {
    Diagnostic& message = context_.diagnostics.report(Diag::UnknownMember, node.member.span,
                                                      {type->name, std::string(node.member.text)});
    std::vector<std::string_view> names;
    for (const StructMember& row : type->members)
      names.insert(names.end(), row.names.begin(), row.names.end());
    if (const std::string_view best = stdlib::nearest(node.member.text, names); !best.empty())
      message.notes.push_back({type->find(best)->span, fmt::format("did you mean '{}'?", best)});
    message.notes.push_back({type->span, fmt::format("{} has {}", type->name, members_text(*type))});
    return std::nullopt;
  }
  base->place.number += static_cast<int32_t>(member->offset);
  base->type = member->type;
  base->name = node.member.text;
  if (base->place.offset == nullptr) {
    const auto first = static_cast<uint32_t>(base->place.number);
    base->extent = NumberRange{first, first + member->type.size() - 1};
  }
  return base;
}

std::optional<Object> ExpressionChecker::object_of(const ast::Index& node, const ast::Expr&) {
  auto base = object(*node.base);
  ExprPtr index = value(*node.index);
  if (!base || !index) return std::nullopt;
  if (base->type.count == 0) {
    context_.diagnostics.report(Diag::NotAnArray, node.base->span, {base->text()});
    return std::nullopt;
  }
  const auto count = static_cast<int32_t>(base->type.count);
  base->type = base->type.element();
  const auto size = static_cast<int32_t>(base->type.size());
  if (const int32_t* known = constant_value(index)) {
    if (*known < 0 || *known >= count) {
      Diagnostic& message = context_.diagnostics.report(
          Diag::IndexRange, node.index->span,
          {fmt::format("{}", *known), base->text(), fmt::format("{}", count - 1)});
      if (base->variable != nullptr) message.notes.push_back({base->variable->span, "declared here"});
      return std::nullopt;
    }
    base->place.number += *known * size;
    if (base->place.offset == nullptr) {
      const auto first = static_cast<uint32_t>(base->place.number);
      base->extent = NumberRange{first, first + base->type.size() - 1};
    }
    return base;
  }
  int32_t shift = 0;
  index = split_constant(index, shift);
  base->place.number = *fold(ast::BinaryOp::Add, base->place.number, *fold(ast::BinaryOp::Mul, shift, size));
  if (size != 1) {
    const Span span = index->span;
    index = combine(ast::BinaryOp::Mul, index, make_expr(span, checked::Constant{size}));
  }
  if (base->place.offset != nullptr) index = combine(ast::BinaryOp::Add, base->place.offset, index);
  base->place.offset = index;
  return base;
}

std::optional<Object> ExpressionChecker::object_of(const ast::Deref& node, const ast::Expr& expr) {
  ExprPtr number = value(*node.number);
  if (number == nullptr) return std::nullopt;
  if (const int32_t* known = constant_value(number)) {
    if (*known < 0 || *known >= context_.unit.variables) {
      context_.diagnostics.report(Diag::InvalidVariable, expr.span,
                                  {fmt::format("{}", *known), std::string(context_.unit.name),
                                   fmt::format("{}", context_.unit.variables - 1)});
      return std::nullopt;
    }
    const auto fixed = static_cast<uint32_t>(*known);
    return Object{{}, {*known, nullptr}, {}, NumberRange{fixed, fixed}, nullptr};
  }
  int32_t shift = 0;
  number = split_constant(number, shift);
  return Object{{}, {shift, number}, {}, std::nullopt, nullptr};
}

void ExpressionChecker::record(const Object& object, Span span, std::vector<AccessPlace> Access::*list) {
  const AccessPlace place{context_.function, span, taken_into_};
  const auto add = [&](std::vector<AccessPlace>& places) {
    if (places.empty() || places.back().function != place.function || places.back().into != place.into)
      places.push_back(place);
  };
  if (!object.extent) return add(context_.indirect);
  for (uint32_t n = object.extent->low; n <= object.extent->high && n < kMaxNumbers; ++n)
    add(context_.accesses[n].*list);
}

void ExpressionChecker::record_read(const Object& object, Span span) {
  record(object, span, &Access::readers);
}
void ExpressionChecker::record_take(const Object& object, Span span) {
  record(object, span, &Access::takers);
}

void ExpressionChecker::record_write(const Object& object, Span span) {
  record(object, span, &Access::writers);
  if (object.place.offset != nullptr) return;
  if (object.variable != nullptr && !context_.has_room(*object.variable)) return;  // no number of its own
  const auto* row = stdlib::find_system_variable(static_cast<uint16_t>(object.place.number));
  if (row != nullptr && row->access == stdlib::VariableAccess::R)
    context_.diagnostics.report(Diag::ReadOnlyVariable, span,
                                {std::string(row->compiler_name), fmt::format("{}", row->number)});
}

}  // namespace ipos::compiler
