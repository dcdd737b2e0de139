// Idle skipping. A loop that has come back to where it was, with all variables as they were and without
// having called the host, goes on so for ever, until something from outside changes what it reads. That is
// tried, not proved from the code: the loop is executed once and taken back. Within a turn variables may
// change for a moment (SET t = x, AND t & 1); then nobody else may look at them. What was found is used for
// the state it was found in alone; in any other the ticks are executed.
#include "vm/exec/idle.hpp"

#include <algorithm>
#include <bitset>

#include "vm/context/arithmetic.hpp"
#include "vm/exec/machine.hpp"
#include "vm/isa/effects.hpp"

namespace ipos::vm {
namespace {

using Variables = std::bitset<kMaxVariables>;

}  // namespace

// A loop of one context.
struct Machine::Spin {
  static constexpr uint32_t kMostChanged = 64;

  uint32_t length = 0;  // commands; 0: there is none
  Idle* found;          // where what it uses is listed
  Variables used;       // read or written
  Variables changed;    // for a moment within a turn
  std::array<uint16_t, kMostChanged> numbers{};
  std::array<int32_t, kMostChanged> originals{};
  uint32_t count = 0;
};

// As can_fault(), with the variables as they are.
bool Machine::would_fault(const TaskContext& t, const Instruction& command) const {
  const auto is_zero = [&](size_t operand) {
    const int32_t b = command.operands[operand];
    return (has_constant(command) ? b : h_[static_cast<size_t>(b)]) == 0;
  };
  switch (coding(command.opcode).faults) {
    case Faults::Never: return false;
    case Faults::Zero: return is_zero(1);
    case Faults::Index: return index_of(command) >= program_.limits().variables;
    case Faults::Depth: return t.depth == program_.limits().call_depth || t.depth == kMaxCallDepth;
    case Faults::Host: break;
  }
  return true;
}

// The variable that a command with an index means.
uint32_t Machine::index_of(const Instruction& command) const {
  const size_t operand = coding(command.opcode).writes == Writes::Indexed ? 0 : 1;
  return bits(h_[static_cast<size_t>(command.operands[operand])]);
}

// Executes one command of a context and notes what it did; false: not, as it would fault or needs the host.
bool Machine::try_command(int number, Spin& spin) {
  TaskContext& t = context_at(number);
  const Instruction command = decode(program_.code(), t.pc).instruction;
  const Coding& row = coding(command.opcode);
  const bool leaves = row.flow == Flow::End || row.flow == Flow::System || row.flow == Flow::SystemCall ||
                      (row.flow == Flow::Return && t.depth == 0);
  if (leaves || would_fault(t, command)) return false;
  bool fits = true;
  const auto use = [&](VariableRange range) {
    for (uint32_t n = range.first; n < range.end(); ++n) {
      if (spin.used[n]) continue;
      spin.used[n] = true;
      fits = fits && spin.found->used < Idle::kMostUsed;
      if (fits) spin.found->numbers[spin.found->used++] = static_cast<uint16_t>(n);
    }
  };
  each_named(command, use);
  VariableRange target = named_target(command);
  if (row.writes == Writes::Indexed) target = {index_of(command), 1};
  if (row.reads == Reads::Indexed) use({index_of(command), 1});
  use(target);
  if (!fits || target.count > Spin::kMostChanged) return false;
  std::array<int32_t, Spin::kMostChanged> before;
  std::copy_n(h_.begin() + target.first, target.count, before.begin());
  if (execute(number, t) != Stop::Budget) return false;
  for (uint32_t n = 0; n < target.count; ++n) {
    const uint32_t variable = target.first + n;
    if (h_[variable] == before[n] || spin.changed[variable]) continue;
    if (spin.count == Spin::kMostChanged) {
      std::copy_n(before.begin(), target.count, h_.begin() + target.first);
      return false;
    }
    spin.changed[variable] = true;
    spin.numbers[spin.count] = static_cast<uint16_t>(variable);
    spin.originals[spin.count++] = before[n];
  }
  return true;
}

// The loop a context is in now, which may pass the same command several times. Leaves everything as it is.
Machine::Spin Machine::find_spin(int number, uint32_t longest, Idle& found) {
  TaskContext& t = context_at(number);
  const TaskContext before = t;
  Spin spin;
  spin.found = &found;
  const auto as_before = [&] {
    for (uint32_t n = 0; n < spin.count; ++n)
      if (h_[spin.numbers[n]] != spin.originals[n]) return false;
    return true;
  };
  // What a turn has left, to see that the loop has settled where it never comes back to its beginning.
  std::array<int32_t, Spin::kMostChanged> left;
  uint32_t left_count = 0;
  const auto settled = [&] {
    bool same = left_count == spin.count;
    for (uint32_t n = 0; n < spin.count; ++n) {
      const int32_t value = h_[spin.numbers[n]];
      same = same && left[n] == value;
      left[n] = value;
    }
    left_count = spin.count;
    return same;
  };
  for (uint32_t n = 1; n <= longest && try_command(number, spin); ++n) {
    if (t.pc != before.pc || t.depth != before.depth ||
        !std::equal(t.calls.begin(), t.calls.begin() + t.depth, before.calls.begin()))
      continue;
    if (as_before())
      spin.length = n;
    else if (!settled())
      continue;
    break;
  }
  for (uint32_t n = 0; n < spin.count; ++n) h_[spin.numbers[n]] = spin.originals[n];
  t = before;
  return spin;
}

// Whether tick() would neither begin a routine nor note anything.
bool Machine::interrupts_rest() const {
  for (const EventInterrupt& interrupt : interrupts_.events)
    if (interrupt.pending) return false;
  if (program_.limits().variables <= kVarIntReq) return true;
  if ((h_[kVarIntReq] & kAllRequests) != 0) return false;
  for (const VariableInterrupt& interrupt : interrupts_.variables) {
    if (!interrupt.installed) continue;
    VariableInterrupt next = interrupt;
    if (next.look(h_[next.source]) || next.held != interrupt.held || next.last != interrupt.last)
      return false;
  }
  return true;
}

// Whether the task goes round in the next ticks.
bool Machine::executes(int task, const std::array<uint32_t, kTasks>& budgets) const {
  return context(active_context(task)).state == TaskState::Ready &&
         budgets[static_cast<size_t>(task - 1)] != 0;
}

uint64_t Machine::idle_ticks(const std::array<uint32_t, kTasks>& budgets, Idle& found, uint32_t longest) {
  found.ticks = 0;
  found.used = 0;
  if (!interrupts_rest()) return 0;
  uint64_t ticks = kIdleForever;
  for (const TaskContext& t : contexts_)
    if (t.state == TaskState::Waiting && t.wait_ms != 0) ticks = std::min<uint64_t>(ticks, t.wait_ms - 1);
  if (ticks == 0) return 0;
  // Variables that something reads, apart from the loops still to come.
  Variables changed, used;
  const uint32_t end = std::min<uint32_t>(kLastSystemVariable + 1, program_.limits().variables);
  for (uint32_t n = kFirstSystemVariable; n < end; ++n) used[n] = true;
  for (const VariableInterrupt& interrupt : interrupts_.variables)
    if (interrupt.installed) used[interrupt.source] = true;
  for (int task = 1; task <= kTasks; ++task) {
    Idle::Loop& loop = found.loops[static_cast<size_t>(task - 1)];
    loop.length = 0;
    if (!executes(task, budgets)) continue;
    const Spin spin = find_spin(active_context(task), longest, found);
    if (spin.length == 0 || (spin.changed & used).any() || (spin.used & changed).any()) return 0;
    loop.length = spin.length;
    changed |= spin.changed;
    used |= spin.used;
  }
  found.steady = changed.none();
  found.ticks = ticks;
  note_state(found);
  return ticks;
}

uint64_t Machine::idle_ticks(const std::array<uint32_t, kTasks>& budgets) {
  Idle found;
  return idle_ticks(budgets, found);
}

// The state that what was found is true of.
void Machine::note_state(Idle& found) const {
  found.begun = begun_;
  for (int task = 1; task <= kTasks; ++task) {
    Idle::Loop& loop = found.loops[static_cast<size_t>(task - 1)];
    const TaskContext& t = context(loop.context = active_context(task));
    loop.pc = t.pc;
    loop.commands = t.commands;
  }
  for (uint32_t n = 0; n < found.used; ++n) found.values[n] = h_[found.numbers[n]];
}

// The machine is in that state, and all is as it was for these ticks.
bool Machine::is_in_state(const Idle& found, const std::array<uint32_t, kTasks>& budgets,
                          uint64_t ticks) const {
  if (ticks > found.ticks || begun_ != found.begun || !interrupts_rest()) return false;
  for (int task = 1; task <= kTasks; ++task) {
    const Idle::Loop& loop = found.loops[static_cast<size_t>(task - 1)];
    if (executes(task, budgets) != (loop.length != 0)) return false;
    if (loop.length == 0) continue;
    const TaskContext& t = context(loop.context);
    if (active_context(task) != loop.context || t.pc != loop.pc || t.commands != loop.commands) return false;
  }
  for (uint32_t n = 0; n < found.used; ++n)
    if (h_[found.numbers[n]] != found.values[n]) return false;
  return std::none_of(contexts_.begin(), contexts_.end(), [&](const TaskContext& t) {
    return t.state == TaskState::Waiting && t.wait_ms != 0 && t.wait_ms <= ticks;
  });
}

uint64_t Machine::skip_ticks(const std::array<uint32_t, kTasks>& budgets, Idle& found, uint64_t ticks) {
  uint64_t executed = 0;
  if (!is_in_state(found, budgets, ticks)) {
    found.ticks = 0;
    for (; ticks != 0; --ticks) {
      tick();
      executed += run_tasks(budgets);
    }
    return executed;
  }
  for (TaskContext& t : contexts_)
    if (t.state == TaskState::Waiting && t.wait_ms != 0) t.wait_ms -= static_cast<uint32_t>(ticks);
  const auto installed = static_cast<uint64_t>(std::count_if(
      interrupts_.events.begin(), interrupts_.events.end(), [](const auto& row) { return row.installed; }));
  if (installed != 0)
    interrupts_.turn = static_cast<uint8_t>((interrupts_.turn % installed + ticks % installed) % installed);
  for (int task = 1; task <= kTasks; ++task) {
    const Idle::Loop& loop = found.loops[static_cast<size_t>(task - 1)];
    if (loop.length == 0) continue;
    const uint64_t commands = budgets[static_cast<size_t>(task - 1)] * ticks;
    const auto rest = static_cast<uint32_t>(commands % loop.length);
    context_at(loop.context).commands += commands - rest;
    run(task, rest);
    executed += commands;
  }
  if (found.ticks != kIdleForever) found.ticks -= ticks;
  note_state(found);
  return executed;
}

}  // namespace ipos::vm
