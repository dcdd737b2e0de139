// Generates the functions that are used, cleans them up and lays them out.
#include "compiler/codegen/codegen.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/codegen/generator.hpp"
#include "compiler/codegen/peephole.hpp"

namespace ipos::compiler {
namespace {

std::string name_of(const checked::Program& program, int32_t variable) {
  for (const vm::Symbol& symbol : program.symbols) {
    const int32_t element = variable - symbol.variable;
    if (element < 0 || element >= symbol.count) continue;
    return symbol.count == 1 ? symbol.name : fmt::format("{}[{}]", symbol.name, element);
  }
  return fmt::format("H{}", variable);
}

void report_steps(const checked::Program& program, const SeenSteps& steps, Diagnostics& diagnostics) {
  const Diag diag = steps.observer.by_number ? Diag::StepsByNumber : Diag::SeenSteps;
  Diagnostic& message =
      diagnostics.report(diag, steps.span, {name_of(program, steps.variable), steps.observer.who});
  message.notes.push_back({steps.observer.span, steps.observer.note});
}

std::vector<FunctionCode> generate_all(const checked::Program& program, const std::vector<bool>& used, bool main_called, const GenerateOptions& options) {
  std::vector<FunctionCode> functions(program.functions.size());
  int32_t variable_interrupts = 0;
  for (size_t n = 0; n < functions.size(); ++n) {
    if (!used[n]) continue;
    functions[n] = FunctionGenerator(program, n, n == program.main && !main_called, options).generate();
    optimize(functions[n]);
    // Which interrupt a VARINT installs is known at run time only: each call in the source counts as one.
    for (Command& command : functions[n].commands)
      if (command.reference && command.instruction.opcode == vm::Opcode::VarInt)
        command.reference->keyword = ++variable_interrupts;
  }
  return functions;
}

// What is tried while there is no room for more.
constexpr size_t kLoopsThatHold[] = {6, 1, 0};

}  // namespace

std::optional<GeneratedProgram> generate(const checked::Program& program, const stdlib::UnitType& unit,
                                         const SourceMap& sources, GenerateOptions options, Diagnostics& diagnostics) {
  const CallGraph graph = call_graph(program);
  const std::vector<bool> used = reachable(graph, program.main);
  // END would end the task also where somebody waits for the return.
  bool main_called = false;
  for (size_t n = 0; n < graph.size(); ++n)
    for (const Reference& reference : graph[n]) main_called |= used[n] && reference.function == program.main;

  for (const size_t most : kLoopsThatHold) {
    options.most_held = most;
    const std::vector<FunctionCode> functions = generate_all(program, used, main_called, options);
    Diagnostics tried;
    auto laid_out = lay_out(program, functions, unit, sources, tried);
    const bool holds = std::any_of(functions.begin(), functions.end(), [](const FunctionCode& one) { return one.holds_numbers; });
    if (holds && tried.has_errors()) continue;
    for (const FunctionCode& function : functions)
      for (const SeenSteps& steps : function.seen_steps) report_steps(program, steps, diagnostics);
    if (tried.has_errors()) return lay_out(program, functions, unit, sources, diagnostics);
    return laid_out;
  }
  return std::nullopt;  // never: without them nothing is held
}

}  // namespace ipos::compiler
