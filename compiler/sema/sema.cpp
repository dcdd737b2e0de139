// The order of the semantic check: declarations, function bodies, then what needs the whole program.
#include "compiler/sema/sema.hpp"

#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/command_check.hpp"
#include "compiler/sema/context.hpp"
#include "compiler/sema/declarations.hpp"
#include "compiler/sema/habits.hpp"
#include "compiler/sema/map.hpp"
#include "compiler/sema/observers.hpp"
#include "compiler/sema/program_roots.hpp"
#include "compiler/sema/sbus_check.hpp"
#include "compiler/sema/slips.hpp"
#include "compiler/sema/statements.hpp"
#include "compiler/sema/variable_use.hpp"
#include "compiler/sema/walk.hpp"
#include "compiler/sema/writers.hpp"
#include "stdlib/spelling.hpp"

namespace ipos::compiler {
namespace {

void check_bodies(const ast::Program& program, Context& context) {
  // Known by the name alone first, so that accesses can be told by function.
  std::vector<const ast::FunctionDecl*> bodies;
  std::vector<size_t> orders;
  for (size_t order = 0; order < program.declarations.size(); ++order) {
    const auto* function = std::get_if<ast::FunctionDecl>(&program.declarations[order]);
    if (function == nullptr) continue;
    // A second function of the same name, or one with a reserved name, has been reported.
    const Entity* entity = context.scope.find(function->name.text);
    const auto* name = std::get_if<const FunctionName*>(entity);
    if (name == nullptr || (*name)->span != function->name.span) continue;
    context.program.functions.push_back({std::string(function->name.text), function->name.span, nullptr});
    bodies.push_back(function);
    orders.push_back(order);
  }
  for (size_t n = 0; n < bodies.size(); ++n) {
    context.function = n;
    context.order = orders[n];
    check_habits(*bodies[n]->body, context.sources, context.diagnostics);
    check_slips(*bodies[n]->body, context.sources, context.diagnostics);
    context.program.functions[n].body = StatementChecker(context).function_body(*bodies[n]->body);
  }
}

// All bodies are checked, and stay as they are while the program as a whole is.
void list_contents(Context& context) {
  std::vector<const checked::Expr*> expressions;
  std::vector<const checked::Expr*> calls;
  for (const checked::Function& function : context.program.functions) {
    expressions.clear();
    calls.clear();
    checked::walk(*function.body, [&](const checked::Expr& expr) {
      expressions.push_back(&expr);
      if (std::holds_alternative<checked::Call>(expr.node) || std::holds_alternative<checked::SystemCall>(expr.node))
        calls.push_back(&expr);
    });
    context.contents.push_back({context.lists.list(expressions), context.lists.list(calls)});
    std::vector<Reference>& references = context.graph.emplace_back();
    for (const checked::Expr* call : calls)
      if (const auto reference = reference_of(*call)) references.push_back(*reference);
  }
}

void report_no_main(Context& context) {
  Diagnostic& message = context.diagnostics.report(Diag::NoMain, {});
  std::vector<std::string_view> names;
  for (const FunctionName& function : context.scope.functions()) names.push_back(function.name);
  const std::string_view best = stdlib::nearest("main", names);
  for (const FunctionName& function : context.scope.functions())
    if (!best.empty() && function.name == best)
      message.notes.push_back({function.span, "did you mean 'main' here?"});
}

}  // namespace

std::optional<checked::Program> check(
    const ast::Program& program, const stdlib::UnitType& unit, const SourceMap& sources, Diagnostics& diagnostics,
    const std::function<bool(const stdlib::UnitType& unit, std::string_view name)>& is_unit_value) {
  if (unit.tasks == 0) {
    diagnostics.report(Diag::NoProgram, {}, {std::string(unit.name)});
    return std::nullopt;
  }
  Context context{unit, sources, diagnostics, {}, {}, {}, {}, {}, {}};
  declare(program, context);
  check_bodies(program, context);
  check_numbers(context);

  const Entity* main = context.scope.find("main");
  const auto* function = std::get_if<const FunctionName*>(main);
  if (function == nullptr) report_no_main(context);
  // What follows looks at the program as a whole and would complain of the gaps that errors leave.
  if (diagnostics.has_errors()) return std::nullopt;
  context.program.main = (*function)->index;
  context.program.raw_names = context.raw_names;
  list_contents(context);
  const ProgramRoots roots(context);
  describe_variables(context);
  if (is_unit_value)
    for (const Variable& variable : context.scope.variables())
      if (is_unit_value(unit, variable.name)) diagnostics.report(Diag::HidesUnitValue, variable.span, {variable.name, variable.name});
  check_variable_use(program, context);
  check_writers(context, roots);
  check_calls(context);
  check_sbus_objects(context);
  check_commands(context, roots);
  if (diagnostics.has_errors()) return std::nullopt;
  context.program.observers = std::make_shared<const Observers>(context);
  return std::move(context.program);
}

}  // namespace ipos::compiler
