// Calls of system functions: arguments against the table of stdlib/system_functions.def, the command from
// vm/isa/opcodes.def.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/block_check.hpp"
#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/variable_use.hpp"
#include "stdlib/language_tables.hpp"

namespace ipos::compiler {
namespace {

using checked::ExprPtr;
using vm::OperandKind;

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(' ', at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

std::vector<std::string_view> constants_of(std::string_view set) {
  std::vector<std::string_view> out;
  for (const vm::KeywordInfo& row : vm::keyword_table())
    if (row.set == set) out.push_back(row.constant);
  return out;
}

}  // namespace

class SystemCallChecker {
 public:
  SystemCallChecker(Context& context, ExpressionChecker& expressions, const ast::Call& call, Span span)
      : context_(context),
        expressions_(expressions),
        call_(call),
        span_(span),
        function_(*stdlib::find_system_function(call.function.text)),
        kinds_(split(function_.arguments)) {}

  ExprPtr run() {
    if (call_.arguments.size() != kinds_.size()) {
      Diagnostic& message =
          context_.diagnostics.report(Diag::ArgumentCount, span_,
                                      {std::string(call_.function.text), count_text(kinds_.size()),
                                       fmt::format("{}", call_.arguments.size())});
      message.notes.push_back(
          {{}, fmt::format("the form is {}( {} )", function_.name, fmt::join(kinds_, ", "))});
      for (size_t n = 0; n < kinds_.size(); ++n)
        if (kinds_[n] == "keyword")
          message.notes.push_back(
              {{}, fmt::format("the keyword is one of {}", fmt::join(constants_of(keyword_set(n)), ", "))});
      return nullptr;
    }
    bool good = task_exists();
    for (size_t n = 0; n < kinds_.size(); ++n) good = argument(n) && good;
    if (!good) return nullptr;
    const vm::OpcodeInfo* row = command();
    for (const Given& given : given_) good = block(row->opcode, given) && good;
    if (!good) return nullptr;
    std::vector<Span> places;
    for (const ast::Expr* argument : call_.arguments) places.push_back(argument->span);
    Arena& arena = context_.program.arena;
    return expressions_.make_expr(span_, checked::SystemCall{row->opcode, arena.list(arguments_), arena.list(places)});
  }

 private:
  static std::string count_text(size_t count) {
    if (count == 0) return "no arguments";
    return fmt::format("{} argument{}", count, count == 1 ? "" : "s");
  }

  // The first command of the mnemonic whose operands take these arguments; `value` arguments choose between
  // the form with a constant and the one with a variable.
  const vm::OpcodeInfo* command() const {
    for (const vm::OpcodeInfo& row : vm::opcode_table()) {
      if (row.mnemonic() != function_.mnemonic) continue;
      bool fits = true;
      for (size_t n = 0; n < kinds_.size(); ++n)
        if (kinds_[n] == "value")
          fits = fits && (row.operands[n].kind == OperandKind::Constant) ==
                             std::holds_alternative<int32_t>(arguments_[n]);
      if (fits) return &row;
    }
    return nullptr;  // a test walks through all functions: each has its command
  }

  std::string_view keyword_set(size_t n) const {
    for (const vm::OpcodeInfo& row : vm::opcode_table())
      if (row.mnemonic() == function_.mnemonic) return row.operands[n].keyword_set;
    return {};
  }

  bool task_exists() {
    std::string missing;
    if (function_.mnemonic == "TASK" && context_.unit.tasks < 3) missing = "task 3";
    if (function_.mnemonic == "TASK2" && context_.unit.tasks < 2) missing = "task 2";
    if (function_.mnemonic == "VARINT" && context_.unit.tasks < 3) missing = "variable interrupts";
    if (missing.empty()) return true;
    const stdlib::UnitType& other = stdlib::unit_with(stdlib::Trait::NewVariables);
    context_.diagnostics
        .report(Diag::MissingTask, call_.function.span, {std::string(call_.function.text), missing, std::string(context_.unit.name)})
        .notes.push_back({{}, fmt::format("{} has it: '--unit {}', or '#include <constb.h>'", other.title, other.name)});
    return false;
  }

  // A variable or structure among the arguments.
  struct Given {
    size_t argument;
    Object object;
    Span span;
  };

  bool argument(size_t n) {
    const std::string_view kind = kinds_[n];
    const ast::Expr& expr = *call_.arguments[n];
    if (kind == "structure" || kind == "variable") return variable(n, expr);
    if (kind == "function") return function(n, expr);
    ExprPtr value = expressions_.value(expr);
    if (value == nullptr) return false;
    const int32_t* known = constant_value(value);
    if (kind == "value" && known == nullptr) {
      arguments_.emplace_back(value);
      return true;
    }
    if (kind == "keyword") return keyword(n, known, expr);
    if (known == nullptr) {
      context_.diagnostics.report(Diag::NotConstant, expr.span,
                                  {fmt::format("argument {} of '{}'", n + 1, call_.function.text)});
      return false;
    }
    if (kind == "bit") return in_range(n, *known, 0, 31, expr.span);
    if (kind == "count") return in_range(n, *known, 1, highest_count(), expr.span);
    arguments_.emplace_back(*known);
    return true;
  }

  bool keyword(size_t n, const int32_t* value, const ast::Expr& expr) {
    const std::string_view set = keyword_set(n);
    if (const vm::KeywordInfo* row = value != nullptr ? vm::find_keyword(set, *value) : nullptr) {
      if (std::holds_alternative<ast::Number>(expr.node))
        check_family(context_, expr.span, constants_of(set), *value, fmt::format("'{}'", call_.function.text),
                     std::string(row->constant));
      arguments_.emplace_back(*value);
      return true;
    }
    context_.diagnostics.report(Diag::ArgumentKeyword, expr.span,
                                {fmt::format("{}", n + 1), std::string(call_.function.text),
                                 fmt::format("{}", fmt::join(constants_of(set), ", "))});
    return false;
  }

  bool in_range(size_t n, int32_t value, int32_t low, int32_t high, Span span) {
    if (value < low || value > high) {
      context_.diagnostics.report(
          Diag::ArgumentRange, span,
          {fmt::format("{}", n + 1), std::string(call_.function.text), fmt::format("{}", low),
           fmt::format("{}", high), fmt::format("{}", value)});
      return false;
    }
    arguments_.emplace_back(value);
    return true;
  }

  // A block must end at the last variable of the unit.
  int32_t highest_count() const {
    int32_t first = 0;
    for (const checked::Argument& argument : arguments_)
      if (const int32_t* number = std::get_if<int32_t>(&argument)) first = std::max(first, *number);
    return context_.unit.variables - first;
  }

  bool variable(size_t n, const ast::Expr& expr) {
    const bool named =
        std::holds_alternative<ast::Name>(expr.node) || std::holds_alternative<ast::Member>(expr.node) ||
        std::holds_alternative<ast::Index>(expr.node) || std::holds_alternative<ast::Deref>(expr.node);
    auto object = named ? expressions_.object(expr) : std::nullopt;
    if (named && !object) return false;
    if (!object || object->place.offset != nullptr) {
      context_.diagnostics.report(Diag::ArgumentVariable, expr.span,
                                  {fmt::format("{}", n + 1), std::string(call_.function.text)});
      return false;
    }
    arguments_.emplace_back(object->place.number);
    given_.push_back({n, std::move(*object), expr.span});
    return true;
  }

  // The variables that the command works on, when all arguments are known.
  bool block(vm::Opcode opcode, const Given& given) {
    const auto constant = [&](std::string_view kind, int32_t otherwise) {
      const auto at = std::find(kinds_.begin(), kinds_.end(), kind);
      return at == kinds_.end() ? otherwise
                                : std::get<int32_t>(arguments_[static_cast<size_t>(at - kinds_.begin())]);
    };
    const auto rows = vm::blocks_of(opcode, given.argument, constant("keyword", vm::kAnyKeyword));
    const BlockRequest request{rows, constant("count", 1), given.argument + 1, call_.function.text};
    const auto found = check_block(context_, request, given.object, given.span);
    if (!found) return false;
    Object all = given.object;
    all.extent = found->range;
    if (found->use != vm::BlockUse::Write) expressions_.record_read(all, given.span);
    if (found->use == vm::BlockUse::Lasting) expressions_.record_take(all, given.span);
    const bool whole = given.object.extent && all.extent && given.object.extent->high >= all.extent->high;
    if (takes_orders(opcode) && whole) all.extent->low = all.extent->high;  // its result alone
    if (found->use != vm::BlockUse::Read) expressions_.record_write(all, given.span);
    return true;
  }

  bool function(size_t n, const ast::Expr& expr) {
    const auto* name = std::get_if<ast::Name>(&expr.node);
    const Entity* entity = name != nullptr ? context_.scope.find(name->text) : nullptr;
    const auto* found = std::get_if<const FunctionName*>(entity);
    if (found != nullptr) {
      arguments_.emplace_back(checked::FunctionRef{(*found)->index});
      return true;
    }
    uint32_t number = 0;
    if (name != nullptr && entity == nullptr && !raw_number(name->text, number))
      expressions_.unknown_name(name->text, expr.span, true);
    else
      context_.diagnostics.report(Diag::ArgumentFunction, expr.span,
                                  {fmt::format("{}", n + 1), std::string(call_.function.text)});
    return false;
  }

  Context& context_;
  ExpressionChecker& expressions_;
  const ast::Call& call_;
  Span span_;
  const stdlib::SystemFunction& function_;
  std::vector<std::string_view> kinds_;
  std::vector<checked::Argument> arguments_;
  std::vector<Given> given_;
};

ExprPtr check_system_call(Context& context, ExpressionChecker& expressions, const ast::Call& call,
                          Span span) {
  return SystemCallChecker(context, expressions, call, span).run();
}

}  // namespace ipos::compiler
