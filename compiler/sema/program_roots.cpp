// Roots follow from the references that start something; a function belongs to all roots that reach it by calls.
#include "compiler/sema/program_roots.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/context.hpp"

namespace ipos::compiler {

ProgramRoots::ProgramRoots(const Context& context)
    : graph(context.graph), alive(reachable(graph, context.program.main)), of(graph.size()) {
  roots.push_back({context.program.main, vm::Opcode::End, 0, {}});
  for (size_t function = 0; function < graph.size(); ++function)
    for (const Reference& reference : graph[function]) {
      if (!alive[function] || reference.kind != ReferenceKind::Start) continue;
      const int32_t keyword = reference.opcode == vm::Opcode::SetInt ? reference.keyword : 0;
      const bool known = std::any_of(roots.begin(), roots.end(), [&](const ProgramRoot& root) {
        return root.function == reference.function && root.start == reference.opcode && root.keyword == keyword;
      });
      if (!known) roots.push_back({reference.function, reference.opcode, keyword, reference.span});
    }
  for (size_t root = 0; root < roots.size(); ++root) {
    std::vector<size_t> open{roots[root].function};
    while (!open.empty()) {
      const size_t function = open.back();
      open.pop_back();
      if (!of[function].empty() && of[function].back() == root) continue;
      of[function].push_back(root);
      for (const Reference& reference : graph[function])
        if (reference.kind == ReferenceKind::Call) open.push_back(reference.function);
    }
  }
}

std::string ProgramRoots::name(const ProgramRoot& root, const checked::Program& program) {
  const std::string& function = program.functions[root.function].name;
  if (root.start == vm::Opcode::End) return "main";
  if (root.is_interrupt()) return fmt::format("the interrupt routine '{}'", function);
  return fmt::format("task {} '{}'", *root.task(), function);
}

}  // namespace ipos::compiler
