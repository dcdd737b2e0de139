// Who writes a variable is counted by what runs beside each other: the three tasks, whichever functions they run one after
// the other, and the interrupt routines. A function belongs to all that run it.
#include "compiler/sema/writers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/program_roots.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {
namespace {

using checked::ExprPtr;

class Writers {
 public:
  Writers(Context& context, const ProgramRoots& roots) : context_(context), roots_(roots) {
    for (const ProgramRoot& root : roots_.roots) beside_.push_back(lane(root));
  }

  void run() {
    for (const Variable& variable : context_.scope.variables())
      if (variable.storage != Storage::Alias) several(variable);
    for (size_t n = 0; n < context_.program.functions.size(); ++n) {
      if (roots_.of[n].empty()) continue;
      for (const checked::Expr* expr : context_.contents[n].expressions)
        if (const auto* node = std::get_if<checked::Assign>(&expr->node)) update(*node, expr->span, n);
    }
  }

 private:
  // Equal for roots that never run beside each other: functions that a task runs one after the other. A routine that is
  // installed for several interrupts is one.
  size_t lane(const ProgramRoot& root) const {
    constexpr size_t kTasks = 3;
    return root.is_interrupt() ? kTasks + 1 + root.function : static_cast<size_t>(*root.task());
  }

  // Until the next call.
  const std::vector<size_t>& writing_roots(uint32_t number) {
    std::vector<size_t>& all = writing_;
    all.clear();
    const auto found = context_.accesses.find(number);
    if (found == context_.accesses.end()) return all;
    for (const auto& [writer, span, into] : found->second.writers)
      if (writer < roots_.of.size()) all.insert(all.end(), roots_.of[writer].begin(), roots_.of[writer].end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  size_t lanes(const std::vector<size_t>& roots) const {
    size_t count = 0;
    for (auto root = roots.begin(); root != roots.end(); ++root)
      count += std::none_of(roots.begin(), root, [&](size_t earlier) { return beside_[earlier] == beside_[*root]; }) ? 1 : 0;
    return count;
  }

  const std::string& function(size_t root) const { return context_.program.functions[roots_.roots[root].function].name; }

  // By name, in the order of the functions; with its task where one function runs on two.
  std::string list(std::vector<size_t> roots) const {
    std::stable_sort(roots.begin(), roots.end(), [&](size_t a, size_t b) {
      return roots_.roots[a].function < roots_.roots[b].function;
    });
    std::vector<std::string> names;
    for (const size_t root : roots) {
      const bool twice = std::any_of(roots.begin(), roots.end(), [&](size_t other) {
        return beside_[other] != beside_[root] && roots_.roots[other].function == roots_.roots[root].function;
      });
      const std::string name = twice ? ProgramRoots::name(roots_.roots[root], context_.program) : fmt::format("'{}'", function(root));
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    std::string out;
    for (size_t n = 0; n < names.size(); ++n)
      out += (n == 0 ? "" : n + 1 == names.size() ? " and " : ", ") + names[n];
    return out;
  }

  void several(const Variable& variable) {
    std::vector<size_t> roots;
    size_t most = 1;
    for (uint32_t n = variable.number; n < variable.number + variable.type.size(); ++n)
      if (const auto& more = writing_roots(n); lanes(more) > most) {
        roots = more;
        most = lanes(more);
      }
    if (roots.empty()) return;
    Diagnostic& message = context_.diagnostics.report(Diag::SeveralWriters, variable.span, {variable.name, list(roots)});
    message.notes.push_back({{}, "what one of them writes may be lost: give each a variable of its own, or let one of them write it"});
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
      const auto& own = roots_.of[function];
      if (std::all_of(own.begin(), own.end(), [&](size_t one) { return beside_[one] == beside_[root]; })) continue;
      context_.diagnostics.report(Diag::LostUpdate, span, {variable_name(number), this->function(root)});
      return;
    }
  }

  std::string variable_name(uint32_t number) const {
    for (const Variable& variable : context_.scope.variables())
      if (number >= variable.number && number < variable.number + variable.type.size()) return variable.name;
    return fmt::format("H{}", number);
  }

  Context& context_;
  const ProgramRoots& roots_;
  std::vector<size_t> beside_;  // the lane of each root
  std::vector<size_t> writing_;
};

}  // namespace

void check_writers(Context& context, const ProgramRoots& roots) { Writers(context, roots).run(); }

}  // namespace ipos::compiler
