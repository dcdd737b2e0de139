// Call graph and the checks on it.
#include "compiler/sema/call_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "compiler/sema/context.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {
namespace {

// Shortest way over calls from a function back to itself: the references in order, empty when there is none.
std::vector<Reference> cycle_through(const CallGraph& graph, size_t start) {
  struct Step {
    const Reference* reference = nullptr;
    size_t from = 0;
  };
  std::vector<Step> steps(graph.size());
  std::deque<size_t> open{start};
  while (!open.empty()) {
    const size_t at = open.front();
    open.pop_front();
    for (const Reference& reference : graph[at]) {
      if (reference.kind != ReferenceKind::Call || steps[reference.function].reference != nullptr) continue;
      steps[reference.function] = {&reference, at};
      open.push_back(reference.function);
    }
  }
  std::vector<Reference> chain;
  if (steps[start].reference == nullptr) return chain;
  size_t at = start;
  do {
    chain.push_back(*steps[at].reference);
    at = steps[at].from;
  } while (at != start);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

// Functions from which calls come to an end: those that call nothing, or nothing but such.
std::vector<bool> outside_of_cycles(const CallGraph& graph) {
  std::vector<std::vector<size_t>> callers(graph.size());
  std::vector<size_t> open_calls(graph.size());
  std::vector<size_t> open;
  for (size_t n = 0; n < graph.size(); ++n) {
    for (const Reference& reference : graph[n]) {
      if (reference.kind != ReferenceKind::Call) continue;
      callers[reference.function].push_back(n);
      ++open_calls[n];
    }
    if (open_calls[n] == 0) open.push_back(n);
  }
  std::vector<bool> ends(graph.size());
  while (!open.empty()) {
    const size_t at = open.back();
    open.pop_back();
    ends[at] = true;
    for (const size_t caller : callers[at])
      if (--open_calls[caller] == 0) open.push_back(caller);
  }
  return ends;
}

}  // namespace

std::optional<Reference> reference_of(const checked::Expr& expr) {
  if (const auto* call = std::get_if<checked::Call>(&expr.node))
    return Reference{ReferenceKind::Call, call->function, vm::Opcode::Call, 0, expr.span};
  const auto* call = std::get_if<checked::SystemCall>(&expr.node);
  if (call == nullptr || call->arguments.empty()) return std::nullopt;
  const auto* function = std::get_if<checked::FunctionRef>(&call->arguments.back());
  if (function == nullptr) return std::nullopt;
  Reference out{ReferenceKind::Start, function->function, call->opcode, 0, expr.span};
  if (const int32_t* keyword = std::get_if<int32_t>(&call->arguments.front())) out.keyword = *keyword;
  switch (call->opcode) {
    case vm::Opcode::InputCall:
    case vm::Opcode::SystemCall: out.kind = ReferenceKind::Call; break;
    case vm::Opcode::Task:  // STOP is 0
    case vm::Opcode::Task2:
    case vm::Opcode::SetInt:  // DISABLE is 0
      if (out.keyword == 0) out.kind = ReferenceKind::Stop;
      break;
    default: break;
  }
  return out;
}

CallGraph call_graph(const checked::Program& program) {
  CallGraph graph(program.functions.size());
  for (size_t n = 0; n < graph.size(); ++n) {
    if (program.functions[n].body == nullptr) continue;
    checked::walk(*program.functions[n].body, [&](const checked::Expr& expr) {
      if (const auto reference = reference_of(expr)) graph[n].push_back(*reference);
    });
  }
  return graph;
}

std::vector<bool> reachable(const CallGraph& graph, size_t main) {
  std::vector<bool> reached(graph.size());
  std::vector<size_t> open{main};
  reached[main] = true;
  while (!open.empty()) {
    const size_t at = open.back();
    open.pop_back();
    for (const Reference& reference : graph[at]) {
      if (reached[reference.function]) continue;
      reached[reference.function] = true;
      open.push_back(reference.function);
    }
  }
  return reached;
}

void check_calls(Context& context) {
  const checked::Program& program = context.program;
  const CallGraph& graph = context.graph;
  const std::vector<bool> used = reachable(graph, program.main);
  // A header is a library: nobody uses all of it.
  const auto included = [&](const checked::Function& function) {
    const SourceFile* file = context.sources.file_of(function.span.begin);
    return file != nullptr && file->included_at.valid();
  };
  std::vector<bool> settled = outside_of_cycles(graph);
  for (size_t n = 0; n < graph.size(); ++n) {
    const checked::Function& function = program.functions[n];
    if (!used[n] && !included(function))
      context.diagnostics.report(Diag::UnusedFunction, function.span, {function.name});
    if (settled[n]) continue;
    const std::vector<Reference> chain = cycle_through(graph, n);
    if (chain.empty()) continue;
    std::string text = function.name;
    for (const Reference& step : chain) {
      text += " -> " + program.functions[step.function].name;
      settled[step.function] = true;
    }
    Diagnostic& message = context.diagnostics.report(Diag::Recursion, chain.front().span,
                                                     {function.name, text, fmt::format("{}", context.unit.call_depth)});
    for (size_t step = 1; step < chain.size(); ++step)
      message.notes.push_back({chain[step].span, fmt::format("'{}' is called here",
                                                             program.functions[chain[step].function].name)});
  }
}

}  // namespace ipos::compiler
