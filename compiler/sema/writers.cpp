// Main, each task and each interrupt routine is a root; a function belongs to all roots that reach it.
#include "compiler/sema/writers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {
namespace {

using checked::ExprPtr;

class Writers {
 public:
  explicit Writers(Context& context) : context_(context), roots_(context.program.functions.size()) {
    const CallGraph graph = call_graph(context.program);
    const std::vector<bool> alive = reachable(graph, context.program.main);
    reach(graph, context.program.main, context.program.main);
    for (size_t function = 0; function < graph.size(); ++function)
      for (const Reference& reference : graph[function])
        if (alive[function] && reference.kind == ReferenceKind::Start)
          reach(graph, reference.function, reference.function);
  }

  void run() {
    for (const Variable& variable : context_.scope.variables())
      if (variable.storage != Storage::Alias) several(variable);
    for (size_t n = 0; n < context_.program.functions.size(); ++n) {
      const checked::Stmt* body = context_.program.functions[n].body;
      if (body == nullptr || roots_[n].empty()) continue;
      checked::walk(*body, [&](const checked::Expr& expr) {
        if (const auto* node = std::get_if<checked::Assign>(&expr.node)) update(*node, expr.span, n);
      });
    }
  }

 private:
  void reach(const CallGraph& graph, size_t first, size_t root) {
    std::vector<size_t> open{first};
    while (!open.empty()) {
      const size_t function = open.back();
      open.pop_back();
      std::vector<size_t>& known = roots_[function];
      if (std::find(known.begin(), known.end(), root) != known.end()) continue;
      known.push_back(root);
      for (const Reference& reference : graph[function])
        if (reference.kind == ReferenceKind::Call) open.push_back(reference.function);
    }
  }

  // Until the next call.
  const std::vector<size_t>& writing_roots(uint32_t number) {
    std::vector<size_t>& all = writing_;
    all.clear();
    const auto found = context_.accesses.find(number);
    if (found == context_.accesses.end()) return all;
    for (const auto& [writer, span, into] : found->second.writers)
      if (writer < roots_.size()) all.insert(all.end(), roots_[writer].begin(), roots_[writer].end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  const std::string& name(size_t root) const { return context_.program.functions[root].name; }

  void several(const Variable& variable) {
    std::vector<size_t> roots;
    for (uint32_t n = variable.number; n < variable.number + variable.type.size(); ++n)
      if (const auto& more = writing_roots(n); more.size() > std::max<size_t>(roots.size(), 1)) roots = more;
    if (roots.empty()) return;
    std::string list;
    for (size_t n = 0; n < roots.size(); ++n)
      list += fmt::format("{}'{}'", n == 0 ? "" : n + 1 == roots.size() ? " and " : ", ", name(roots[n]));
    context_.diagnostics.report(Diag::SeveralWriters, variable.span, {variable.name, list});
  }

  // x = f(x) in several commands. One command reads and writes at once: x = x + 1.
  void update(const checked::Assign& node, Span span, size_t function) {
    if (node.op || node.target.offset != nullptr || node.value == nullptr) return;
    const auto reads_target = [&](const ExprPtr& part) {
      bool found = false;
      checked::walk(part, [&](const checked::Expr& inner) {
        const auto* load = std::get_if<checked::Load>(&inner.node);
        found = found || (load != nullptr && load->place.offset == nullptr &&
                          load->place.number == node.target.number);
      });
      return found;
    };
    if (!reads_target(node.value)) return;
    const auto* binary = std::get_if<checked::Binary>(&node.value->node);
    const auto* load = binary != nullptr ? std::get_if<checked::Load>(&binary->left->node) : nullptr;
    if (load != nullptr && reads_target(binary->left) && !reads_target(binary->right)) return;
    const auto number = static_cast<uint32_t>(node.target.number);
    for (const size_t root : writing_roots(number)) {
      const auto& own = roots_[function];
      if (own.size() == 1 && own.front() == root) continue;
      context_.diagnostics.report(Diag::LostUpdate, span, {variable_name(number), name(root)});
      return;
    }
  }

  std::string variable_name(uint32_t number) const {
    for (const Variable& variable : context_.scope.variables())
      if (number >= variable.number && number < variable.number + variable.type.size()) return variable.name;
    return fmt::format("H{}", number);
  }

  Context& context_;
  std::vector<std::vector<size_t>> roots_;  // of each function
  std::vector<size_t> writing_;
};

}  // namespace

void check_writers(Context& context) { Writers(context).run(); }

}  // namespace ipos::compiler
