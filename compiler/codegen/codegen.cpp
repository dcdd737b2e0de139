// Generates the functions that are used, cleans them up and lays them out.
#include "compiler/codegen/codegen.hpp"

#include <algorithm>

#include "compiler/codegen/generator.hpp"
#include "compiler/codegen/peephole.hpp"

namespace ipos::compiler {

std::optional<GeneratedProgram> generate(const checked::Program& program, const stdlib::UnitType& unit,
                                         const SourceMap& sources, Diagnostics& diagnostics) {
  const CallGraph graph = call_graph(program);
  const std::vector<bool> used = reachable(graph, program.main);
  // END would end the task also where somebody waits for the return.
  bool main_called = false;
  for (size_t n = 0; n < graph.size(); ++n)
    for (const Reference& reference : graph[n]) main_called |= used[n] && reference.function == program.main;

  std::vector<FunctionCode> functions(program.functions.size());
  int32_t variable_interrupts = 0;
  for (size_t n = 0; n < functions.size(); ++n) {
    if (!used[n]) continue;
    functions[n] = FunctionGenerator(n == program.main && !main_called).generate(program.functions[n]);
    optimize(functions[n]);
    // Which interrupt a VARINT installs is known at run time only: each call in the source counts as one.
    for (Command& command : functions[n].commands)
      if (command.reference && command.instruction.opcode == vm::Opcode::VarInt)
        command.reference->keyword = ++variable_interrupts;
  }
  return lay_out(program, functions, unit, sources, diagnostics);
}

}  // namespace ipos::compiler
