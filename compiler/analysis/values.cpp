// Intervals by abstract interpretation: each way through the commands is followed until nothing new comes. Functions have no
// variables of their own, so a call is a jump there and one back. An interval that grows again and again stops at a constant of
// the program, which is where its loops end.
#include "compiler/analysis/values.hpp"

#include <deque>
#include <iterator>
#include <set>

#include "stdlib/language_tables.hpp"
#include "stdlib/system_variables.hpp"
#include "vm/isa/effects.hpp"

namespace ipos::compiler::analysis {
namespace {

using vm::Flow;
using vm::Instruction;
using vm::Opcode;

constexpr Interval kAny{};
constexpr int kPatience = 3;  // visits before an interval is widened

Interval of(int64_t least, int64_t most) {
  // Arithmetic wraps.
  return least < INT32_MIN || most > INT32_MAX ? kAny : Interval{least, most};
}

Interval product(const Interval& a, const Interval& b) {
  const int64_t all[] = {a.least * b.least, a.least * b.most, a.most * b.least, a.most * b.most};
  return of(*std::min_element(std::begin(all), std::end(all)), *std::max_element(std::begin(all), std::end(all)));
}

Interval result(Opcode opcode, const Interval& a, const Interval& b) {
  switch (opcode) {
    case Opcode::SetHH:
    case Opcode::SetHK: return b;
    case Opcode::AddHH:
    case Opcode::AddHK: return of(a.least + b.least, a.most + b.most);
    case Opcode::SubHH:
    case Opcode::SubHK: return of(a.least - b.most, a.most - b.least);
    case Opcode::MulHH:
    case Opcode::MulHK: return product(a, b);
    case Opcode::DivHH:
    case Opcode::DivHK: return b.least > 0 && a.least >= 0 ? Interval{a.least / b.most, a.most / b.least} : kAny;
    case Opcode::ModHH:
    case Opcode::ModHK:
      if (b.least <= 0) return kAny;
      return {a.least >= 0 ? 0 : -(b.most - 1), b.most - 1};
    case Opcode::AndHH:
    case Opcode::AndHK:
      if (b.least >= 0) return {0, b.most};
      return a.least >= 0 ? Interval{0, a.most} : kAny;
    case Opcode::ShrHH:
    case Opcode::ShrHK:
    case Opcode::AshrHH:
    case Opcode::AshrHK:
      if (a.least < 0 || b.least < 0 || b.most > 31) return kAny;
      return {a.least >> b.most, a.most >> b.least};
    default: return kAny;
  }
}

// The members of structures that say where the unit or the bus writes, and how many variables from there on.
struct Pointer {
  std::string_view type, member;
  int64_t variables;
};
constexpr Pointer kPointers[] = {
    {"SCREC", "DPointer", 2}, {"MOVLNK", "DPointer", 8}, {"GSCAM", "DestVar", 1}, {"GSCAM_EXT", "CamDestination", 1}};

struct Target {
  uint32_t offset;  // of the member
  int64_t variables;
  std::optional<uint32_t> format;  // the member that says how many bytes come
};
std::vector<Target> pointers_of(std::string_view type) {
  std::vector<Target> all;
  for (const Pointer& pointer : kPointers) {
    if (pointer.type != type) continue;
    const stdlib::Structure& structure = *stdlib::find_structure(type);
    const auto member = [&](std::string_view wanted) -> std::optional<uint32_t> {
      for (uint32_t n = 0; n < structure.members.size(); ++n)
        for (const std::string_view name : structure.members[n])
          if (name == wanted) return n;
      return std::nullopt;
    };
    if (const auto offset = member(pointer.member)) all.push_back({*offset, pointer.variables, type == "SCREC" ? member("Format") : std::nullopt});
  }
  return all;
}

// Of a format of 4 bytes or fewer, in the low byte, it takes one variable (1053 1610 p. 54).
int64_t variables_of(const Target& target, const Interval& format) {
  return target.format && format.least == format.most && (format.least & 0xFF) <= 4 ? 1 : target.variables;
}

// Which of its variables the host writes: of a structure with a result that one, else all.
Span host_target(const vm::BlockInfo& block, uint32_t first) {
  if (const stdlib::Structure* structure = stdlib::find_structure(block.type))
    for (uint32_t n = 0; n < structure->members.size(); ++n)
      for (const std::string_view name : structure->members[n])
        if (name == "Result" || name == "IntEvent") return {first + n, first + n};
  return {first, static_cast<int64_t>(first) + block.variables - 1};
}

}  // namespace

bool is_system_variable(uint32_t variable) {
  return variable >= stdlib::kFirstSystemVariable && variable <= stdlib::kLastSystemVariable;
}

Values::Values(const Graph& graph, uint32_t variables) : graph_(graph), variables_(variables) {
  std::set<int64_t> constants{INT32_MIN, 0, INT32_MAX};
  leads_.resize(graph.commands.size());
  for (size_t n = 0; n < graph.commands.size(); ++n) {
    const Command& command = graph.commands[n];
    vm::each_named(command.code, [&](const vm::VariableRange& range) {
      for (uint32_t v = range.first; v < range.end() && v < variables; ++v)
        if (slots_.try_emplace(v, tracked_.size()).second) tracked_.push_back(v);
    });
    const Opcode opcode = command.code.opcode;
    const bool grows = opcode == Opcode::AddHK || opcode == Opcode::SubHK;
    if (grows || vm::coding(opcode).flow == Flow::Branch) {
      std::vector<size_t>& slots = grows ? growing_ : compared_;
      const size_t at = slot(static_cast<uint32_t>(command.code.operands[0]));
      if (at != kNone && std::find(slots.begin(), slots.end(), at) == slots.end()) slots.push_back(at);
    }
    for (size_t operand = 0; operand < vm::coding(command.code.opcode).operand_count; ++operand)
      if (vm::coding(command.code.opcode).kinds[operand] == vm::OperandKind::Constant)
        for (const int64_t near : {-1, 0, 1}) constants.insert(std::clamp<int64_t>(command.code.operands[operand] + near, INT32_MIN, INT32_MAX));
    if (command.label != kNone) {
      leads_[command.label] = true;
      if (command.next != kNone) leads_[command.next] = true;
    }
    if (command.calls && command.label != kNone && command.next != kNone) behind_[command.label].push_back(command.next);
  }
  thresholds_.assign(constants.begin(), constants.end());
  for (const size_t entry : graph.entries) {
    leads_[entry] = true;
    for (const size_t command : graph.function_at(entry))
      if (graph.commands[command].ends) returns_[entry].push_back(command);
  }
  for (const Root& root : graph.roots) {
    Task& task = tasks_.emplace_back();
    task.shared.resize(variables);
    task.reached.resize(graph.commands.size());
    for (const size_t command : graph.reached_from(root.entry)) task.reached[command] = true;
  }
  // What one task writes the others may not rely on, and so it may write more: until that is all.
  for (bool more = true; more;) {
    more = false;
    for (size_t n = 0; n < tasks_.size(); ++n) analyse(tasks_[n], graph.roots[n].entry);
    for (const Task& writer : tasks_)
      for (size_t command = 0; command < graph.commands.size(); ++command) {
        if (!writer.reached[command]) continue;
        const State state = before(writer, command);
        if (state.values.empty()) continue;
        const std::vector<Span> spans = writes(writer, state, command);
        for (Task& other : tasks_)
          if (&other != &writer) more = share(spans, other.shared) || more;
        // The unit and the bus go on with what a command gives them, and write there at any time.
        const Opcode opcode = graph.commands[command].code.opcode;
        if (vm::coding(opcode).flow != Flow::System) continue;
        for (Task& any : tasks_) {
          for (const vm::BlockInfo* row : blocks_of(graph.commands[command].code)) {
            const vm::BlockInfo& block = *row;
            const auto first = static_cast<uint32_t>(graph.commands[command].code.operands[block.operand]);
            if (block.use == vm::BlockUse::Both || block.use == vm::BlockUse::Lasting)
              more = share({host_target(block, first)}, any.shared) || more;
            for (const Target& target : pointers_of(block.type)) {
              const Interval to = read(writer, state, first + target.offset);
              const int64_t count = variables_of(target, target.format ? read(writer, state, first + *target.format) : kAny);
              more = share({{to.least, to.most + count - 1}}, any.shared) || more;
            }
          }
          if (opcode == Opcode::MovCom) more = share({{0, variables - 1}}, any.shared) || more;  // its layout is on no page read
        }
      }
  }
}

size_t Values::slot(uint32_t variable) const {
  const auto found = slots_.find(variable);
  return found == slots_.end() ? kNone : found->second;
}

bool Values::share(const std::vector<Span>& spans, std::vector<bool>& shared) const {
  bool more = false;
  for (const Span& span : spans)
    for (int64_t v = std::max<int64_t>(0, span.first); v <= span.last && v < variables_; ++v) {
      more = more || !shared[static_cast<size_t>(v)];
      shared[static_cast<size_t>(v)] = true;
    }
  return more;
}

bool Values::is_shared_in(const Task& task, uint32_t variable) const {
  return variable >= variables_ || is_system_variable(variable) || task.shared[variable];
}

Interval Values::read(const Task& task, const State& state, uint32_t variable) const {
  const size_t at = slot(variable);
  if (at == kNone || is_shared_in(task, variable)) return kAny;
  return state.values[at];
}

std::vector<Span> Values::writes(const Task& task, const State& state, size_t number) const {
  const Instruction& code = graph_.commands[number].code;
  std::vector<Span> spans;
  if (const vm::VariableRange named = vm::named_target(code); named.count != 0)
    spans.push_back({named.first, static_cast<int64_t>(named.end()) - 1});
  if (code.opcode == Opcode::SetiStore) {
    const Interval to = read(task, state, static_cast<uint32_t>(code.operands[0]));
    spans.push_back({to.least, to.most});
  }
  if (vm::coding(code.opcode).flow != Flow::System) return spans;
  if (code.opcode == Opcode::Memorize && code.operands[0] == 2) spans.push_back({0, variables_ - 1});  // LOAD ALL
  if (code.opcode == Opcode::MovCom) spans.push_back({0, variables_ - 1});
  for (const vm::BlockInfo* block : blocks_of(code))
    if (block->use != vm::BlockUse::Read) spans.push_back(host_target(*block, static_cast<uint32_t>(code.operands[block->operand])));
  return spans;
}

void Values::execute(const Task& task, State& state, size_t number) const {
  const Instruction& code = graph_.commands[number].code;
  const std::vector<Span> spans = writes(task, state, number);
  const vm::Coding& row = vm::coding(code.opcode);
  if (row.writes == vm::Writes::First) {
    const size_t to = slot(static_cast<uint32_t>(code.operands[0]));
    const bool adds = code.opcode == Opcode::AddHK, takes = code.opcode == Opcode::SubHK;
    Interval value = kAny;
    if (row.operand_count > 1 && row.kinds[1] == vm::OperandKind::Constant)
      value = result(code.opcode, read(task, state, static_cast<uint32_t>(code.operands[0])), {code.operands[1], code.operands[1]});
    else if (row.operand_count > 1 && row.kinds[1] == vm::OperandKind::Variable && code.opcode != Opcode::SetiLoad)
      value = result(code.opcode, read(task, state, static_cast<uint32_t>(code.operands[0])),
                     read(task, state, static_cast<uint32_t>(code.operands[1])));
    if (to == kNone) return;
    if ((adds || takes) && !value.is_any()) {  // copies of it stay what they are
      state.values[to] = value;
      const int64_t step = adds ? code.operands[1] : -static_cast<int64_t>(code.operands[1]);
      for (Copy& copy : state.copies) {
        const int64_t by = (copy.copy == to ? step : 0) - (copy.of == to ? copy.factor * step : 0);
        copy.more = {copy.more.least + by, copy.more.most + by};
      }
      return;
    }
    if (code.opcode == Opcode::MulHK && code.operands[1] > 0 && !value.is_any()) {
      state.values[to] = value;
      std::erase_if(state.copies, [&](const Copy& copy) { return copy.of == to; });
      for (Copy& copy : state.copies)
        if (copy.copy == to) copy = {to, copy.of, copy.factor * code.operands[1], {copy.more.least * code.operands[1], copy.more.most * code.operands[1]}};
      return;
    }
    set(state, to, value);
    if (code.opcode == Opcode::SetHH && !is_shared_in(task, static_cast<uint32_t>(code.operands[0])))
      if (const auto from = static_cast<uint32_t>(code.operands[1]); slot(from) != kNone && slot(from) != to && !is_shared_in(task, from))
        state.copies.push_back({to, slot(from), 1, {0, 0}});
    return;
  }
  const Interval stored = code.opcode == Opcode::SetiStore ? read(task, state, static_cast<uint32_t>(code.operands[1])) : kAny;
  const bool weak = code.opcode == Opcode::SetiStore;  // one of these, the others stay
  for (const Span& span : spans)
    for (size_t n = 0; n < tracked_.size(); ++n)
      if (span.has(tracked_[n])) set(state, n, weak ? joined(state.values[n], stored) : kAny);
}

// What was a copy of it, or it was a copy of, is none any more.
void Values::set(State& state, size_t slot, const Interval& value) const {
  state.values[slot] = value;
  std::erase_if(state.copies, [&](const Copy& copy) { return copy.copy == slot || copy.of == slot; });
}

// It is known better now, and so is what it is a copy of, and what is a copy of it.
void Values::narrow(State& state, size_t slot, const Interval& value) const {
  state.values[slot] = value;
  for (const Copy& copy : state.copies) {
    if (copy.copy != slot || copy.factor != 1) continue;
    Interval& of = state.values[copy.of];
    of = {std::max(of.least, value.least - copy.more.most), std::min(of.most, value.most - copy.more.least)};
  }
  tighten(state);
}

// What a comparison tells where it jumps, or does not.
void Values::refine(const Task& task, State& state, const Instruction& branch, bool jumps) const {
  const Opcode opcode = jumps ? branch.opcode : vm::inverse(branch.opcode);
  const bool constant = vm::has_constant(branch);
  const auto left = static_cast<uint32_t>(branch.operands[0]);
  const auto right = static_cast<uint32_t>(branch.operands[1]);
  const Interval a = read(task, state, left);
  const Interval b = constant ? Interval{branch.operands[1], branch.operands[1]} : read(task, state, right);
  Interval to_a = a, to_b = b;
  switch (opcode) {
    case Opcode::JmpEqHH:
    case Opcode::JmpEqHK: to_a = to_b = {std::max(a.least, b.least), std::min(a.most, b.most)}; break;
    case Opcode::JmpNeHH:
    case Opcode::JmpNeHK:
      if (b.least == b.most && a.least == b.least) ++to_a.least;
      if (b.least == b.most && a.most == b.most) --to_a.most;
      break;
    case Opcode::JmpLtHH:
    case Opcode::JmpLtHK:
      to_a.most = std::min(a.most, b.most - 1);
      to_b.least = std::max(b.least, a.least + 1);
      break;
    case Opcode::JmpLeHH:
    case Opcode::JmpLeHK:
      to_a.most = std::min(a.most, b.most);
      to_b.least = std::max(b.least, a.least);
      break;
    case Opcode::JmpGtHH:
    case Opcode::JmpGtHK:
      to_a.least = std::max(a.least, b.least + 1);
      to_b.most = std::min(b.most, a.most - 1);
      break;
    case Opcode::JmpGeHH:
    case Opcode::JmpGeHK:
      to_a.least = std::max(a.least, b.least);
      to_b.most = std::min(b.most, a.most);
      break;
    default: return;
  }
  if (to_a.is_empty() || to_b.is_empty()) {
    state.values.clear();  // that way is never taken
    return;
  }
  if (const size_t at = slot(left); at != kNone) narrow(state, at, to_a);
  if (!constant)
    if (const size_t at = slot(right); at != kNone) narrow(state, at, to_b);
}

Interval Values::widened(const Interval& old, const Interval& now) const {
  Interval out = now;
  if (now.least < old.least)
    out.least = *std::prev(std::upper_bound(thresholds_.begin(), thresholds_.end(), now.least));
  if (now.most > old.most) out.most = *std::lower_bound(thresholds_.begin(), thresholds_.end(), now.most);
  return out;
}

void Values::analyse(Task& task, size_t entry) const {
  task.states.clear();
  std::unordered_map<size_t, int> visits;
  std::deque<size_t> open;
  const auto flow_to = [&](size_t to, const State& state) {
    if (state.values.empty()) return;
    const auto [found, is_new] = task.states.try_emplace(to, state);
    bool changed = is_new;
    if (!is_new) {
      State& kept = found->second;
      const State before = kept;
      const bool widen = ++visits[to] > kPatience;
      for (size_t n = 0; n < state.values.size(); ++n) {
        const Interval old = kept.values[n];
        const Interval now = joined(old, state.values[n]);
        if (now == old) continue;
        kept.values[n] = widen ? widened(old, now) : now;
      }
      std::erase_if(kept.copies, [&](Copy& copy) { return !holds(copy, state, true); });
      std::vector<Copy> more = growing_together(task, before, state);
      std::copy_if(state.copies.begin(), state.copies.end(), std::back_inserter(more), [&](Copy copy) {
        return std::find(growing_.begin(), growing_.end(), copy.copy) != growing_.end() && holds(copy, before, false);
      });
      for (const Copy& copy : more)
        if (std::none_of(kept.copies.begin(), kept.copies.end(), [&](const Copy& known) { return known.copy == copy.copy && known.of == copy.of; }))
          kept.copies.push_back(copy);
      tighten(kept);
      changed = kept.values != before.values || kept.copies != before.copies;
    }
    if (changed) open.push_back(to);
  };
  flow_to(entry, {std::vector<Interval>(tracked_.size() + 1), {}});  // one more: there is always one
  while (!open.empty()) {
    size_t number = open.front();
    open.pop_front();
    State state = task.states.at(number);
    for (bool first = true;; first = false) {
      if (!first && leads_[number]) {
        flow_to(number, state);
        break;
      }
      const Command& command = graph_.commands[number];
      const Flow flow = vm::coding(command.code.opcode).flow;
      if (flow == Flow::Branch && command.label != kNone) {
        State jumped = state;
        refine(task, jumped, command.code, true);
        flow_to(command.label, jumped);
        refine(task, state, command.code, false);
        if (command.next != kNone) flow_to(command.next, state);
        break;
      }
      execute(task, state, number);
      if (command.calls && command.label != kNone) {
        flow_to(command.label, state);
        if (flow == Flow::SystemCall && command.next != kNone) flow_to(command.next, state);
        // It may have returned before with more than it does from here.
        for (const size_t back : returns_.count(command.label) ? returns_.at(command.label) : std::vector<size_t>{})
          if (command.next != kNone)
            if (const State after = before(task, back); !after.values.empty()) flow_to(command.next, after);
        break;
      }
      if (command.ends) {
        if (flow == Flow::Return)
          for (const auto& [function, ends] : returns_)
            if (std::find(ends.begin(), ends.end(), number) != ends.end() && behind_.contains(function))
              for (const size_t to : behind_.at(function))
                if (task.reached[to]) flow_to(to, state);
        break;
      }
      const size_t next = command.next != kNone ? command.next : command.label;
      if (next == kNone) break;
      if (command.next == kNone) {  // a jump
        flow_to(next, state);
        break;
      }
      number = next;
    }
  }
}

// From the last command before it that has a state; empty: it is never reached.
Values::State Values::before(const Task& task, size_t number) const {
  size_t first = number;
  while (!leads_[first]) {
    if (first == 0 || graph_.commands[first - 1].next != first) return {};
    --first;
  }
  const auto found = task.states.find(first);
  if (found == task.states.end()) return {};
  State state = found->second;
  for (; first != number; ++first) execute(task, state, first);
  return state;
}

Interval Values::at(size_t command, uint32_t variable) const {
  Interval all{1, 0};
  for (const Task& task : tasks_) {
    if (!task.reached[command]) continue;
    const State state = before(task, command);
    if (!state.values.empty()) all = joined(all, read(task, state, variable));
  }
  return all;
}

std::vector<Span> Values::written_by(size_t command) const {
  std::vector<Span> all;
  for (const Task& task : tasks_) {
    if (!task.reached[command]) continue;
    const State state = before(task, command);
    if (state.values.empty()) continue;
    for (const Span& span : writes(task, state, command)) all.push_back(span);
  }
  return all;
}

bool Values::is_shared(size_t command, uint32_t variable) const {
  for (const Task& task : tasks_)
    if (task.reached[command] && is_shared_in(task, variable)) return true;
  return false;
}

}  // namespace ipos::compiler::analysis
