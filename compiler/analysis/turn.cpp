// A command that the turn may miss is decided by the branches one side of which always comes by, and the other one not always
// (control dependence: Ferrante, Ottenstein and Warren 1987). That is asked in each function alone, as a return goes back to its own
// caller; what is reached where asks for any caller, which tells of more ways than there are.
#include "compiler/analysis/turn.hpp"

#include <algorithm>
#include <set>

#include "compiler/analysis/loops.hpp"

namespace ipos::compiler::analysis {

Turn::Turn(const Graph& graph, const Root& task) : graph_(graph), task_(task.task), next_(graph.commands.size()), back_(graph.commands.size()) {
  const std::vector<size_t> function = graph.function_at(task.entry);
  const std::vector<std::vector<size_t>> loops = endless_parts(task.entry);
  is_unclear_ = loops.size() > 1;
  for (const size_t command : graph.reached_from(task.entry))
    if (const Command& code = graph.commands[command]; code.calls && code.label != kNone)
      is_unclear_ = is_unclear_ || !endless_parts(code.label).empty();
  if (loops.empty() || is_unclear_) return;
  const std::vector<size_t>* loop = &loops.front();
  Part& whole = parts_[kNone];
  whole.commands = *loop;
  whole.has.resize(graph.commands.size());
  for (const size_t command : *loop) whole.has[command] = true;
  std::set<size_t> doors;
  if (whole.has[task.entry]) doors.insert(task.entry);
  for (const size_t command : function)
    if (!whole.has[command])
      for (const size_t to : graph.successors(command))
        if (whole.has[to]) doors.insert(to);
  is_unclear_ = doors.size() != 1;
  if (is_unclear_) return;
  for (const size_t command : *loop)
    if (const Command& code = graph.commands[command]; code.calls && code.label != kNone) add_function(code.label);
  for (auto& [entry, part] : parts_)
    for (const size_t command : part.commands)
      if (const Command& code = graph.commands[command]; code.calls && code.label != kNone) parts_.at(code.label).callers.push_back(command);
  head_ = *doors.begin();
  for (auto& [entry, part] : parts_) connect(part, entry == kNone);
  std::set<size_t> all;
  for (const auto& [entry, part] : parts_)
    for (const size_t command : part.commands) {
      all.insert(command);
      const Command& code = graph.commands[command];
      std::vector<size_t>& next = next_[command];
      const auto add = [&](size_t to) {
        if (to == head_) to = kNone;
        if (std::find(next.begin(), next.end(), to) == next.end()) next.push_back(to);
      };
      const bool is_call = code.calls && code.label != kNone;
      if (is_call) add(code.label);
      if (!is_call || vm::coding(code.code.opcode).flow == vm::Flow::SystemCall)
        for (const size_t to : graph.successors(command)) add(to);
      if (code.ends)
        for (const size_t caller : part.callers)
          if (graph.commands[caller].next != kNone) add(graph.commands[caller].next);
      if (code.ends && vm::coding(code.code.opcode).flow == vm::Flow::End) add(kNone);
    }
  commands_.assign(all.begin(), all.end());
  for (const size_t command : commands_)
    for (const size_t to : next_[command]) (to == kNone ? ends_ : back_[to]).push_back(command);
}

// Of the function that begins there: parts that lead nowhere else.
std::vector<std::vector<size_t>> Turn::endless_parts(size_t entry) const {
  std::vector<std::vector<size_t>> all = parts_in_order(graph_, graph_.function_at(entry), kNone);
  std::erase_if(all, [&](const std::vector<size_t>& part) {
    return std::any_of(part.begin(), part.end(), [&](size_t command) {
      const std::vector<size_t> next = graph_.successors(command);
      return next.empty() || graph_.commands[command].ends ||
             std::any_of(next.begin(), next.end(), [&](size_t to) { return std::find(part.begin(), part.end(), to) == part.end(); });
    });
  });
  return all;
}

void Turn::add_function(size_t entry) {
  const auto [found, is_new] = parts_.try_emplace(entry);
  if (!is_new) return;
  found->second.commands = graph_.function_at(entry);
  found->second.has.resize(graph_.commands.size());
  const std::vector<size_t> inside = found->second.commands;
  for (const size_t command : inside) parts_.at(entry).has[command] = true;
  for (const size_t command : inside)
    if (const Command& code = graph_.commands[command]; code.calls && code.label != kNone) add_function(code.label);
}

Turn::Set Turn::after(size_t command, const std::vector<size_t>& walls) const {
  Set wall(graph_.commands.size()), seen(graph_.commands.size());
  for (const size_t one : walls) wall[one] = true;
  std::vector<size_t> open{command};
  for (bool first = true; !open.empty(); first = false) {
    const size_t one = open.back();
    open.pop_back();
    if (!first && wall[one]) continue;
    for (const size_t to : next_[one])
      if (to != kNone && !seen[to]) {
        seen[to] = true;
        open.push_back(to);
      }
  }
  return seen;
}

bool Turn::lasts(size_t command, const std::vector<size_t>& walls) const {
  const Set seen = after(command, walls);
  const auto ends = [&](size_t one) { return std::find(next_[one].begin(), next_[one].end(), kNone) != next_[one].end(); };
  if (ends(command)) return true;
  return std::any_of(ends_.begin(), ends_.end(), [&](size_t one) { return seen[one] && std::find(walls.begin(), walls.end(), one) == walls.end(); });
}

Turn::Set Turn::before(const std::vector<size_t>& walls) const {
  Set wall(graph_.commands.size()), seen(graph_.commands.size());
  for (const size_t command : walls) wall[command] = true;
  std::vector<size_t> open{head_};
  seen[head_] = true;
  while (!open.empty()) {
    const size_t command = open.back();
    open.pop_back();
    if (wall[command]) continue;
    for (const size_t to : next_[command])
      if (to != kNone && !seen[to]) {
        seen[to] = true;
        open.push_back(to);
      }
  }
  return seen;
}

Turn::Set Turn::to_the_end(const std::vector<size_t>& walls) const {
  Set wall(graph_.commands.size()), seen(graph_.commands.size());
  for (const size_t command : walls) wall[command] = true;
  std::vector<size_t> open;
  const auto come = [&](size_t command) {
    if (wall[command] || seen[command]) return;
    seen[command] = true;
    open.push_back(command);
  };
  for (const size_t command : ends_) come(command);
  while (!open.empty()) {
    const size_t command = open.back();
    open.pop_back();
    for (const size_t from : back_[command]) come(from);
  }
  return seen;
}

void Turn::connect(Part& part, bool is_loop) const {
  for (const size_t command : part.commands) {
    std::vector<size_t>& next = part.next[command];
    for (const size_t to : graph_.successors(command)) next.push_back(is_loop && to == head_ ? kNone : to);
    if (graph_.commands[command].ends) next.push_back(kNone);
    for (const size_t to : next) (to == kNone ? part.last : part.back[to]).push_back(command);
  }
}

const std::vector<size_t>& Turn::deciders_in_functions(size_t command) {
  const auto [found, is_new] = known_.try_emplace(command);
  if (!is_new) return found->second;
  for (const auto& [entry, part] : parts_) {
    if (!part.has[command]) continue;
    // From which the function may end without the command.
    Set missing(graph_.commands.size());
    std::vector<size_t> open;
    const auto come = [&](size_t to) {
      if (to == command || missing[to]) return;
      missing[to] = true;
      open.push_back(to);
    };
    for (const size_t one : part.last) come(one);
    while (!open.empty()) {
      const size_t one = open.back();
      open.pop_back();
      if (const auto from = part.back.find(one); from != part.back.end())
        for (const size_t before : from->second) come(before);
    }
    for (const auto& [one, next] : part.next) {
      const auto misses = [&](size_t to) { return to == kNone || missing[to]; };
      if (std::any_of(next.begin(), next.end(), misses) && !std::all_of(next.begin(), next.end(), misses)) found->second.push_back(one);
    }
    for (const size_t caller : part.callers)
      if (vm::coding(graph_.commands[caller].code.opcode).flow == vm::Flow::SystemCall) found->second.push_back(caller);
  }
  return found->second;
}

std::vector<size_t> Turn::deciders(size_t command) {
  std::set<size_t> seen{command}, found;
  std::vector<size_t> open{command};
  const auto ask = [&](size_t one) {
    if (seen.insert(one).second) open.push_back(one);
  };
  while (!open.empty()) {
    const size_t one = open.back();
    open.pop_back();
    for (const size_t branch : deciders_in_functions(one)) {
      found.insert(branch);
      ask(branch);
    }
    for (const auto& [entry, part] : parts_)
      if (part.has[one])
        for (const size_t caller : part.callers) ask(caller);
  }
  return {found.begin(), found.end()};
}

}  // namespace ipos::compiler::analysis
