// Expressions: syntax tree to checked tree. Every function returns nothing (null) for an expression with an
// error in it, after reporting it, so that one mistake gives one message.
#pragma once

#include <optional>
#include <string>

#include "compiler/ast/ast.hpp"
#include "compiler/sema/context.hpp"

namespace ipos::compiler {

// Something with a place: a variable, a member, an element, or what *p stands for.
struct Object {
  Type type;
  checked::Place place;
  std::string_view name;               // of the variable or member, for messages; empty after a '*'
  std::optional<NumberRange> extent;   // variables it may be, when they are known
  const Variable* variable = nullptr;  // declared one it is (part of)

  std::string text() const;  // for messages
};

class ExpressionChecker {
 public:
  explicit ExpressionChecker(Context& context) : context_(context) {}

  // An expression whose value is used.
  checked::ExprPtr value(const ast::Expr& expr);
  // The same, in a place where an assignment is probably meant to be a comparison.
  checked::ExprPtr condition(const ast::Expr& expr);
  // An expression whose value is not used.
  checked::ExprPtr effect(const ast::Expr& expr);
  // A value known now. `what` is the subject of the message when it is not.
  std::optional<int32_t> constant(const ast::Expr& expr, const char* what);

  std::optional<Object> object(const ast::Expr& expr);

 private:
  friend class SystemCallChecker;

  checked::ExprPtr value_of(const ast::Number& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Name& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Member& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Index& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Deref& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Numof& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Unary& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Step& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Binary& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Conditional& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Assign& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Comma& node, const ast::Expr& expr);
  checked::ExprPtr value_of(const ast::Call& node, const ast::Expr& expr);

  std::optional<Object> object_of(const ast::Name& node, const ast::Expr& expr);
  std::optional<Object> object_of(const ast::Member& node, const ast::Expr& expr);
  std::optional<Object> object_of(const ast::Index& node, const ast::Expr& expr);
  std::optional<Object> object_of(const ast::Deref& node, const ast::Expr& expr);

  template <typename Node>
  checked::ExprPtr make_expr(Span span, const Node& node) {
    return context_.program.arena.make(checked::Expr{span, node});
  }
  checked::ExprPtr combine(ast::BinaryOp op, checked::ExprPtr left, checked::ExprPtr right);
  checked::ExprPtr load(const ast::Expr& expr);
  // The object on the left of an assignment; reports what cannot be assigned to.
  std::optional<Object> target(const ast::Expr& expr);
  void explain_port(Diagnostic& message, Location at) const;
  checked::ExprPtr assign(const ast::Assign& node, std::optional<Object> target, Span span);
  checked::ExprPtr copy_structure(const ast::Assign& node, Object target, Span span);
  checked::ExprPtr call(const ast::Call& node, Span span);
  void check_constants(const ast::Binary& node, int32_t left, int32_t right, Span span);
  void check_divisor(ast::BinaryOp op, checked::Expr& right);

  void unknown_name(std::string_view name, Span span, bool function);
  void record_read(const Object& object, Span span);
  void record_write(const Object& object, Span span);
  void record_take(const Object& object, Span span);
  void record(const Object& object, Span span, std::vector<AccessPlace> Access::*list);

  Context& context_;
  uint32_t taken_into_ = UINT32_MAX;  // variable that the numof() being checked is assigned to
  bool in_constant_ = false;          // where division by zero is an error of its own
};

// The value of a constant expression.
const int32_t* constant_value(const checked::ExprPtr& expr);
// True when evaluating may change something (or call, or fault on purpose).
bool has_effect(const checked::Expr& expr);

// system_call.cpp: checks the arguments of a system function against its command.
checked::ExprPtr check_system_call(Context& context, ExpressionChecker& expressions, const ast::Call& call,
                                   Span span);

}  // namespace ipos::compiler
