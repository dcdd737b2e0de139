// Strongly connected parts after Tarjan; turns by the variable that a loop counts with.
#include "compiler/analysis/loops.hpp"

#include <algorithm>
#include <set>
#include <unordered_map>

#include "vm/isa/effects.hpp"

namespace ipos::compiler::analysis {

using vm::Opcode;

namespace {

// Without recursion: programs are long.
class Parts {
 public:
  Parts(const Graph& graph, const std::vector<size_t>& commands, size_t head) : graph_(graph), head_(head) {
    for (const size_t command : commands) open_[command] = 0;
    for (const size_t command : commands)
      if (open_[command] == 0) visit(command);
    std::reverse(parts.begin(), parts.end());
  }
  std::vector<std::vector<size_t>> parts;

 private:
  struct Step {
    size_t command;
    std::vector<size_t> to;
    size_t next = 0;
  };

  std::vector<size_t> inside(size_t command) const {
    std::vector<size_t> all;
    for (const size_t to : graph_.successors(command))
      if (to != head_ && open_.contains(to)) all.push_back(to);
    return all;
  }

  void visit(size_t first) {
    std::vector<Step> way;
    const auto enter = [&](size_t command) {
      open_[command] = low_[command] = ++count_;
      stack_.push_back(command);
      on_stack_.insert(command);
      way.push_back({command, inside(command)});
    };
    enter(first);
    while (!way.empty()) {
      Step& step = way.back();
      if (step.next < step.to.size()) {
        const size_t to = step.to[step.next++];
        if (open_[to] == 0)
          enter(to);
        else if (on_stack_.contains(to))
          low_[step.command] = std::min(low_[step.command], open_[to]);
        continue;
      }
      const size_t command = step.command;
      way.pop_back();
      if (!way.empty()) low_[way.back().command] = std::min(low_[way.back().command], low_[command]);
      if (low_[command] != open_[command]) continue;
      std::vector<size_t>& part = parts.emplace_back();
      size_t last = 0;
      do {
        last = stack_.back();
        stack_.pop_back();
        on_stack_.erase(last);
        part.push_back(last);
      } while (last != command);
    }
  }

  const Graph& graph_;
  size_t head_;
  size_t count_ = 0;
  std::unordered_map<size_t, size_t> open_, low_;
  std::vector<size_t> stack_;
  std::set<size_t> on_stack_;
};

// From `from` to `to` inside of the loop, without the commands of `without`.
bool leads(const Graph& graph, const std::set<size_t>& loop, size_t from, size_t to, const std::set<size_t>& without) {
  std::set<size_t> seen;
  std::vector<size_t> open{from};
  while (!open.empty()) {
    const size_t command = open.back();
    open.pop_back();
    for (const size_t next : graph.successors(command)) {
      if (!loop.contains(next)) continue;
      if (next == to) return true;
      if (!without.contains(next) && seen.insert(next).second) open.push_back(next);
    }
  }
  return false;
}

class Counter {
 public:
  Counter(const Graph& graph, const Values& values, const std::vector<size_t>& loop, size_t head)
      : graph_(graph), values_(values), loop_(loop.begin(), loop.end()), head_(head) {
    for (const size_t command : loop) {
      writers_.push_back({command, values.written_by(command)});
      const Command& called = graph.commands[command];
      if (!called.calls || called.label == kNone) continue;
      for (const size_t inside : graph.reached_from(called.label))
        for (const Span& span : values.written_by(inside)) writers_.push_back({command, {span}});
    }
  }

  std::optional<Turns> least() const {
    std::optional<Turns> found;
    for (const size_t command : loop_) {
      const auto turns = by_exit(command);
      if (turns && (!found || turns->most < found->most)) found = turns;
    }
    return found;
  }

 private:
  struct Writer {
    size_t command;
    std::vector<Span> spans;
  };

  // Each turn comes by.
  bool in_each_turn(size_t command) const { return command == head_ || !leads(graph_, loop_, head_, head_, {command}); }

  std::vector<size_t> writers_of(uint32_t variable) const {
    std::vector<size_t> all;
    for (const Writer& writer : writers_)
      for (const Span& span : writer.spans)
        if (span.has(variable) && (all.empty() || all.back() != writer.command)) all.push_back(writer.command);
    return all;
  }

  // What a turn adds, where one command does that once.
  std::optional<std::pair<int64_t, size_t>> step_of(uint32_t variable) const {
    const std::vector<size_t> writers = writers_of(variable);
    if (writers.size() != 1 || values_.is_shared(head_, variable)) return std::nullopt;
    const size_t at = writers.front();
    const vm::Instruction& code = graph_.commands[at].code;
    const bool adds = code.opcode == Opcode::AddHK, takes = code.opcode == Opcode::SubHK;
    if ((!adds && !takes) || static_cast<uint32_t>(code.operands[0]) != variable) return std::nullopt;
    const int64_t step = adds ? code.operands[1] : -static_cast<int64_t>(code.operands[1]);
    const bool once = in_each_turn(at) && (at == head_ || !leads(graph_, loop_, at, at, {head_}));
    if (step == 0 || !once) return std::nullopt;
    return std::pair(step, at);
  }

  std::optional<Turns> by_exit(size_t command) const {
    const Command& exit = graph_.commands[command];
    if (vm::coding(exit.code.opcode).flow != vm::Flow::Branch || exit.label == kNone || exit.next == kNone) return std::nullopt;
    const bool label_stays = loop_.contains(exit.label), next_stays = loop_.contains(exit.next);
    if (label_stays == next_stays || !in_each_turn(command)) return std::nullopt;
    const Opcode stays = label_stays ? exit.code.opcode : vm::inverse(exit.code.opcode);
    const auto left = static_cast<uint32_t>(exit.code.operands[0]);
    if (vm::has_constant(exit.code)) {
      const int64_t constant = exit.code.operands[1];
      return turns_with(command, stays, left, {constant, constant});
    }
    const auto right = static_cast<uint32_t>(exit.code.operands[1]);
    if (writers_of(right).empty() && !values_.is_shared(command, right))
      return turns_with(command, stays, left, values_.at(command, right));
    if (writers_of(left).empty() && !values_.is_shared(command, left))
      return turns_with(command, turned(stays), right, values_.at(command, left));
    return std::nullopt;
  }

  // Of the variable itself, or of the one that each turn copies to it before: n-- > 0.
  std::optional<Turns> turns_with(size_t exit, Opcode stays, uint32_t variable, const Interval& limit) const {
    const std::vector<size_t> writers = writers_of(variable);
    if (writers.size() == 1 && graph_.commands[writers.front()].code.opcode == Opcode::SetHH && !values_.is_shared(exit, variable)) {
      const size_t copied = writers.front();
      if (exit == head_ || (copied != head_ && leads(graph_, loop_, head_, exit, {copied}))) return std::nullopt;
      return turns(exit, copied, stays, static_cast<uint32_t>(graph_.commands[copied].code.operands[1]), limit);
    }
    return turns(exit, exit, stays, variable, limit);
  }

  // a < b is b > a.
  static Opcode turned(Opcode opcode) {
    switch (opcode) {
      case Opcode::JmpLtHH: return Opcode::JmpGtHH;
      case Opcode::JmpLeHH: return Opcode::JmpGeHH;
      case Opcode::JmpGtHH: return Opcode::JmpLtHH;
      case Opcode::JmpGeHH: return Opcode::JmpLeHH;
      default: return opcode;
    }
  }

  // Stays in the loop while the variable, as it is at `seen`, compares so with the limit.
  std::optional<Turns> turns(size_t exit, size_t seen, Opcode stays, uint32_t variable, const Interval& limit) const {
    const auto counted = step_of(variable);
    if (!counted || limit.is_empty()) return std::nullopt;
    const auto [step, at] = *counted;
    const Interval begin = values_.at(head_, variable);
    if (begin.is_empty()) return Turns{0, exit};
    const int64_t width = std::abs(step);
    // How far it goes from where it begins, while it stays: the last value with which it does.
    int64_t distance = 0;
    const bool up = step > 0;
    const int64_t first = up ? begin.least : begin.most;
    const int64_t end = up ? limit.most : limit.least;
    if (first == INT32_MIN || first == INT32_MAX) return std::nullopt;  // not known, or it may wrap
    switch (stays) {
      case Opcode::JmpLtHH:
      case Opcode::JmpLtHK:
        if (!up) return std::nullopt;
        distance = end - 1 - first;
        break;
      case Opcode::JmpLeHH:
      case Opcode::JmpLeHK:
        if (!up) return std::nullopt;
        distance = end - first;
        break;
      case Opcode::JmpGtHH:
      case Opcode::JmpGtHK:
        if (up) return std::nullopt;
        distance = first - end - 1;
        break;
      case Opcode::JmpGeHH:
      case Opcode::JmpGeHK:
        if (up) return std::nullopt;
        distance = first - end;
        break;
      case Opcode::JmpNeHH:
      case Opcode::JmpNeHK: {
        // It has to meet the limit: by ones from before it, or the head's values say that it never passes it.
        const int64_t far = up ? begin.most : begin.least;
        if (width != 1 || limit.least != limit.most || (up ? far > end : far < end)) return std::nullopt;
        distance = up ? end - 1 - first : first - end - 1;
        break;
      }
      default: return std::nullopt;
    }
    // Beyond the last value comes one more step, which must not wrap.
    const int64_t last = up ? end + width : end - width;
    if (last > INT32_MAX || last < INT32_MIN) return std::nullopt;
    // Where the step comes first in a turn, the first comparison sees it already.
    const bool stepped = at != seen && seen != head_ && (at == head_ || !leads(graph_, loop_, head_, seen, {at}));
    if (stepped) distance -= width;
    return Turns{distance < 0 ? 0 : static_cast<uint64_t>(distance / width) + 1, exit};
  }

  const Graph& graph_;
  const Values& values_;
  std::set<size_t> loop_;
  size_t head_;
  std::vector<Writer> writers_;
};

}  // namespace

std::vector<std::vector<size_t>> parts_in_order(const Graph& graph, const std::vector<size_t>& commands, size_t head) {
  return Parts(graph, commands, head).parts;
}

std::optional<Turns> turns_of(const Graph& graph, const Values& values, const std::vector<size_t>& loop, size_t head) {
  return Counter(graph, values, loop, head).least();
}

}  // namespace ipos::compiler::analysis
