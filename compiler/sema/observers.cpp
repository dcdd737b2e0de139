// Roots run at once with each other: main, task 2, task 3, each interrupt of task 1, and each routine of a
// variable interrupt. Functions started on the same task replace one another.
#include "compiler/sema/observers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "compiler/sema/ranges.hpp"
#include "compiler/sema/walk.hpp"
#include "compiler/sema/watched.hpp"
#include "stdlib/index_areas.hpp"
#include "vm/isa/blocks.hpp"

namespace ipos::compiler {
namespace {

constexpr uint32_t kManyRoots = 63;  // all from here on share a bit and count as several

// Bits of roots by function, from the references that start something downwards.
std::vector<uint64_t> find_roots(const CallGraph& graph, size_t main, const std::vector<bool>& used) {
  std::vector<uint64_t> roots(graph.size());
  std::vector<size_t> open;
  const auto add = [&](size_t function, uint64_t bits) {
    if ((roots[function] | bits) == roots[function]) return;
    roots[function] |= bits;
    open.push_back(function);
  };
  std::map<std::pair<vm::Opcode, size_t>, uint32_t> numbers;
  add(main, 1);
  for (size_t n = 0; n < graph.size(); ++n) {
    for (const Reference& reference : graph[n]) {
      if (!used[n] || reference.kind != ReferenceKind::Start) continue;
      // Tasks and events by their command and keyword; which variable interrupt it is, the routine must tell.
      const size_t which = reference.opcode == vm::Opcode::VarInt ? reference.function
                                                                  : static_cast<size_t>(reference.keyword);
      const auto next = static_cast<uint32_t>(numbers.size() + 1);
      const uint32_t number = numbers.emplace(std::pair(reference.opcode, which), next).first->second;
      add(reference.function, uint64_t{1} << std::min(number, kManyRoots));
    }
  }
  while (!open.empty()) {
    const size_t at = open.back();
    open.pop_back();
    for (const Reference& reference : graph[at])
      if (reference.kind == ReferenceKind::Call) add(reference.function, roots[at]);
  }
  return roots;
}

// Begins something that runs beside the program: a task, an interrupt, telegrams, cams.
bool starts(const checked::Expr& expr) {
  if (const auto reference = reference_of(expr); reference && reference->kind == ReferenceKind::Start)
    return true;
  const auto* call = std::get_if<checked::SystemCall>(&expr.node);
  if (call == nullptr) return false;
  if (call->opcode == vm::Opcode::ScomOn || call->opcode == vm::Opcode::ScomState) return true;
  if (call->opcode != vm::Opcode::GetSys) return false;
  const auto blocks = vm::blocks_of(call->opcode, 0, std::get<int32_t>(call->arguments[1]));
  return std::any_of(blocks.begin(), blocks.end(),
                     [](const vm::BlockInfo& block) { return block.use == vm::BlockUse::Lasting; });
}

// Functions in which something is started, or in what they call.
std::vector<bool> find_starting(const Context& context) {
  const CallGraph& graph = context.graph;
  std::vector<std::vector<size_t>> callers(graph.size());
  std::vector<bool> starting(graph.size());
  std::vector<size_t> open;
  for (size_t n = 0; n < graph.size(); ++n) {
    for (const Reference& reference : graph[n]) callers[reference.function].push_back(n);
    const auto& calls = context.contents[n].calls;
    if (!std::any_of(calls.begin(), calls.end(), [](const checked::Expr* expr) { return starts(*expr); })) continue;
    open.push_back(n);
    starting[n] = true;
  }
  while (!open.empty()) {
    const size_t at = open.back();
    open.pop_back();
    for (const size_t caller : callers[at])
      if (!starting[caller]) open.push_back(caller), starting[caller] = true;
  }
  return starting;
}

}  // namespace

Observers::Observers(Context& context) {
  const checked::Program& program = context.program;
  const CallGraph& graph = context.graph;
  const std::vector<bool> used = reachable(graph, program.main);
  for (const checked::Function& function : program.functions) names_.push_back(function.name);
  roots_ = find_roots(graph, program.main, used);

  // The statements of main up to the first that starts something, and the functions that only they call.
  late_.resize(graph.size());
  std::vector<size_t> open;
  const auto late = [&](const Reference& reference) {
    if (late_[reference.function]) return;
    late_[reference.function] = true;
    open.push_back(reference.function);
  };
  const std::vector<bool> starting = find_starting(context);
  const auto* body = std::get_if<checked::Block>(&program.functions[program.main].body->node);
  bool begun = body == nullptr;
  if (body == nullptr) std::for_each(graph[program.main].begin(), graph[program.main].end(), late);
  for (const checked::StmtPtr stmt : body != nullptr ? body->body : std::span<const checked::StmtPtr>{}) {
    checked::walk(*stmt, [&](const checked::Expr& expr) {
      const auto reference = reference_of(expr);
      begun = begun || starts(expr) || (reference && starting[reference->function]);
    });
    if (begun)
      checked::walk(*stmt, [&](const checked::Expr& expr) {
        if (const auto reference = reference_of(expr)) late(*reference);
      });
    else
      early_.insert(stmt);
  }
  while (!open.empty()) {
    const size_t at = open.back();
    open.pop_back();
    std::for_each(graph[at].begin(), graph[at].end(), late);
  }
  if (late_[program.main]) early_.clear();  // it is called again
  late_[program.main] = true;

  Watched watched = find_watched(context, used);
  handed_over_ = std::move(watched.members);
  for (const auto& [number, watch] : watched.variables)
    watched_.emplace(number, Observer{watch.who, watch.span, "its number is handed over here"});
  if (watched.anywhere)
    anywhere_ =
        Observer{watched.anywhere->who, watched.anywhere->span, "the number is known at run time only"};
  accesses_ = std::move(context.accesses);
  raw_names_ = std::move(context.raw_names);
  indirect_ = std::move(context.indirect);
}

bool Observers::run_at_once(size_t one, size_t other) const {
  const uint64_t both = roots_[one] | roots_[other];
  if (roots_[one] == 0 || roots_[other] == 0) return false;
  return !std::has_single_bit(both) || both >> kManyRoots != 0;
}

std::optional<Observer> Observers::other_root(size_t function, uint32_t variable) const {
  const auto found = accesses_.find(variable);
  if (found == accesses_.end()) return std::nullopt;
  for (const auto& list : {&Access::readers, &Access::writers})
    for (const AccessPlace& place : found->second.*list) {
      if (!run_at_once(function, place.function)) continue;
      if (place.function == function)
        return Observer{fmt::format("'{}' runs more than once at a time", names_[function]), place.span,
                        "one of its uses"};
      return Observer{fmt::format("'{}' uses it", names_[place.function]), place.span, "used here", false,
                      list == &Access::writers};
    }
  for (const AccessPlace& taken : found->second.takers) {
    if (handed_over_.contains(taken.into)) continue;
    for (const AccessPlace& pointer : indirect_)
      if (run_at_once(function, pointer.function))
        return Observer{fmt::format("'{}' uses variables by their numbers", names_[pointer.function]),
                        taken.span, "its number is taken here"};
  }
  if (anywhere_ && !found->second.takers.empty()) return anywhere_;
  return std::nullopt;
}

// Where find() knows somebody who only reads, the value stays. A pointer may lead anywhere. What nobody in the program writes is
// there for somebody outside, and so is what is kept without power.
bool Observers::may_change(size_t function, uint32_t variable, bool early) const {
  const auto found = accesses_.find(variable);
  if (variable <= kLastNonVolatile || raw_names_.contains(variable) || found == accesses_.end() || found->second.writers.empty())
    return true;
  if (early) return false;
  const auto beside = [&](const AccessPlace& place) { return run_at_once(function, place.function); };
  return anywhere_ || watched_.contains(variable) || std::any_of(indirect_.begin(), indirect_.end(), beside) ||
         std::any_of(found->second.writers.begin(), found->second.writers.end(), beside) ||
         std::any_of(found->second.takers.begin(), found->second.takers.end(), beside);
}

std::optional<Observer> Observers::find(size_t function, uint32_t variable, bool early) const {
  if (!early) {
    if (auto other = other_root(function, variable)) return other;
    if (const auto watched = watched_.find(variable); watched != watched_.end()) return watched->second;
  }
  if (const auto raw = raw_names_.find(variable); raw != raw_names_.end())
    return Observer{fmt::format("a bus may read it as parameter {}", stdlib::kFirstVariables + variable), raw->second,
                    "used by its number here", true};
  return std::nullopt;
}

}  // namespace ipos::compiler
