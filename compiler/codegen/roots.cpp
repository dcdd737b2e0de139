// Roots, instances and their temporaries.
#include "compiler/codegen/roots.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace ipos::compiler {
namespace {

bool calls(const Command& command) {
  return command.reference && command.reference->kind == ReferenceKind::Call;
}

}  // namespace

Instances::Instances(const std::vector<FunctionCode>& functions, size_t main) : functions_(functions) {
  find_copied();
  reach(main);
  find_lost();
  if (lost_.empty()) place_temporaries();
}

void Instances::find_copied() {
  copied_.resize(functions_.size());
  std::vector<std::vector<size_t>> callers(functions_.size());
  std::vector<size_t> open;
  const auto copy = [&](size_t function) {
    if (copied_[function]) return;
    copied_[function] = true;
    open.push_back(function);
  };
  for (size_t n = 0; n < functions_.size(); ++n) {
    if (functions_[n].temporaries != 0) copy(n);
    for (const Command& command : functions_[n].commands)
      if (calls(command)) callers[command.reference->function].push_back(n);
  }
  while (!open.empty()) {
    const size_t at = open.back();
    open.pop_back();
    for (const size_t caller : callers[at]) copy(caller);
  }
}

size_t Instances::root_of(const Reference& reference) {
  for (size_t n = 0; n < roots_.size(); ++n)
    if (roots_[n].function == reference.function && roots_[n].opcode == reference.opcode &&
        roots_[n].keyword == reference.keyword)
      return n;
  roots_.push_back({reference.function, reference.opcode, reference.keyword, 0, 0});
  return roots_.size() - 1;
}

void Instances::add(size_t function, size_t root) {
  if (!copied_[function]) root = kShared;
  const auto [at, fresh] = index_.emplace(std::pair(function, root), instances_.size());
  if (fresh) instances_.push_back({function, root, 0});
}

void Instances::reach(size_t main) {
  roots_.push_back({main, vm::Opcode::End, 0, 0, 0});
  size_t rooted = 0;
  size_t done = 0;
  std::vector<const Reference*> stops;
  // A function below a shared instance is shared as well, so its root does not matter.
  while (rooted < roots_.size() || done < instances_.size() || !stops.empty()) {
    if (rooted < roots_.size()) {
      add(roots_[rooted].function, rooted);
      ++rooted;
    } else if (done < instances_.size()) {
      const Instance from = instances_[done++];
      for (const Command& command : functions_[from.function].commands) {
        if (!command.reference) continue;
        if (command.reference->kind == ReferenceKind::Call) add(command.reference->function, from.root);
        if (command.reference->kind == ReferenceKind::Start) root_of(*command.reference);
        if (command.reference->kind == ReferenceKind::Stop) stops.push_back(&*command.reference);
      }
    } else {
      // What is only ever stopped needs an address all the same.
      const Reference& stop = *stops.back();
      stops.pop_back();
      const auto known = index_.lower_bound({stop.function, 0});
      if (known == index_.end() || known->first.first != stop.function) root_of(stop);
    }
  }
  std::stable_sort(instances_.begin(), instances_.end(), [main](const Instance& a, const Instance& b) {
    const auto key = [main](const Instance& n) {
      const bool first = n.function == main && (n.root == 0 || n.root == kShared);
      return std::tuple(!first, n.function, n.root);
    };
    return key(a) < key(b);
  });
  for (size_t n = 0; n < instances_.size(); ++n) index_[{instances_[n].function, instances_[n].root}] = n;
}

size_t Instances::target(const Instance& from, const Reference& reference) const {
  const auto find = [&](size_t root) { return index_.find({reference.function, root}); };
  if (const auto shared = find(kShared); shared != index_.end()) return shared->second;
  if (reference.kind == ReferenceKind::Call) return find(from.root)->second;
  // STOP and DISABLE give no interrupt or start; any instance of that command will do.
  const auto started = std::find_if(roots_.begin(), roots_.end(), [&](const Root& root) {
    return root.function == reference.function && root.opcode == reference.opcode &&
           (root.keyword == reference.keyword || reference.kind == ReferenceKind::Stop);
  });
  if (started != roots_.end()) return find(static_cast<size_t>(started - roots_.begin()))->second;
  return index_.lower_bound({reference.function, 0})->second;
}

void Instances::find_lost() {
  for (size_t n = 0; n < functions_.size(); ++n) {
    for (const Command& command : functions_[n].commands) {
      if (!calls(command) || command.held == 0) continue;
      std::set<size_t> seen;
      std::vector<size_t> open{command.reference->function};
      while (!open.empty()) {
        const size_t at = open.back();
        open.pop_back();
        if (!seen.insert(at).second) continue;
        for (const Command& next : functions_[at].commands)
          if (calls(next)) open.push_back(next.reference->function);
      }
      if (seen.contains(n)) lost_.push_back(&command);
    }
  }
}

void Instances::place_temporaries() {
  // Calls that hold temporaries are in no cycle, so this ends.
  for (bool changed = true; changed;) {
    changed = false;
    for (const Instance& from : instances_) {
      for (const Command& command : functions_[from.function].commands) {
        if (!calls(command) || from.root == kShared) continue;
        Instance& to = instances_[target(from, *command.reference)];
        if (to.first >= from.first + command.held) continue;
        to.first = from.first + command.held;
        changed = true;
      }
    }
  }
  for (const Instance& instance : instances_)
    if (instance.root != kShared)
      roots_[instance.root].count =
          std::max(roots_[instance.root].count, instance.first + functions_[instance.function].temporaries);
  uint32_t first = 0;
  for (Root& root : roots_) {
    root.first = first;
    first += root.count;
  }
}

uint32_t Instances::temporaries() const { return roots_.back().first + roots_.back().count; }

}  // namespace ipos::compiler
