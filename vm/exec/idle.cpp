// Idle skipping. A loop that has come back to where it was, with all variables as they were and without
// having called the host, goes on so for ever, until something from outside changes what it reads. That is
// tried, not proved from the code: the loop is executed once and taken back. Within a turn variables may
// change for a moment (SET t = x, AND t & 1); then nobody else may look at them.
#include <algorithm>
#include <bitset>

#include "vm/exec/arithmetic.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::vm {
namespace {

using Variables = std::bitset<kMaxVariables>;

// The unit looks at its system variables in every tick (IPOSplus p. 29).
constexpr uint32_t kFirstSystemVariable = 453;
constexpr uint32_t kLastSystemVariable = 560;

}  // namespace

// A loop of one context.
struct Machine::Spin {
  static constexpr uint32_t kMostChanged = 64;

  uint32_t length = 0;  // commands; 0: there is none
  Variables used;       // read or written
  Variables changed;    // for a moment within a turn
  std::array<uint16_t, kMostChanged> numbers{};
  std::array<int32_t, kMostChanged> originals{};
  uint32_t count = 0;
};

// Executes one command of a context and notes what it did; false: not, as it could fault or needs the host.
bool Machine::try_command(int number, Spin& spin) {
  TaskContext& t = context_at(number);
  const Instruction command = decode(program_.code(), t.pc).instruction;
  const Coding& row = coding(command.opcode);
  const uint32_t variables = program_.limits().variables;
  const auto value = [&](size_t operand) { return h_[static_cast<size_t>(command.operands[operand])]; };
  for (size_t n = 0; n < row.operand_count; ++n)
    if (row.kinds[n] == OperandKind::Variable) spin.used[static_cast<size_t>(command.operands[n])] = true;
  uint32_t target = 0;
  switch (row.flow) {
    case Flow::Jump:
    case Flow::Branch: break;
    case Flow::Call:
      if (t.depth == program_.limits().call_depth || t.depth == kMaxCallDepth) return false;
      break;
    case Flow::Return:
      if (t.depth == 0) return false;
      break;
    case Flow::Next:
      if (command.opcode == Opcode::Copy) return false;
      if ((command.opcode == Opcode::DivHH || command.opcode == Opcode::ModHH) && value(1) == 0) return false;
      if ((command.opcode == Opcode::DivHK || command.opcode == Opcode::ModHK) && command.operands[1] == 0)
        return false;
      target = command.opcode == Opcode::SetiStore ? bits(value(0)) : bits(command.operands[0]);
      if (command.opcode == Opcode::SetiLoad) {
        if (bits(value(1)) >= variables) return false;
        spin.used[bits(value(1))] = true;
      }
      if (target >= variables) return false;
      spin.used[target] = true;
      break;
    default: return false;
  }
  const int32_t before = h_[target];
  if (execute(number, t) != Stop::Budget) return false;
  if (h_[target] != before && !spin.changed[target]) {
    if (spin.count == Spin::kMostChanged) {
      h_[target] = before;
      return false;
    }
    spin.changed[target] = true;
    spin.numbers[spin.count] = static_cast<uint16_t>(target);
    spin.originals[spin.count++] = before;
  }
  return true;
}

// The loop a context is in now, which may pass the same command several times. Leaves everything as it is.
Machine::Spin Machine::find_spin(int number, uint32_t longest) {
  TaskContext& t = context_at(number);
  const TaskContext before = t;
  Spin spin;
  const auto as_before = [&] {
    for (uint32_t n = 0; n < spin.count; ++n)
      if (h_[spin.numbers[n]] != spin.originals[n]) return false;
    return true;
  };
  for (uint32_t n = 1; n <= longest && try_command(number, spin); ++n) {
    if (t.pc != before.pc || t.depth != before.depth) continue;
    if (!std::equal(t.calls.begin(), t.calls.begin() + t.depth, before.calls.begin()) || !as_before())
      continue;
    spin.length = n;
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
    if (!interrupt.installed || context(interrupt.task).state == TaskState::Stopped) continue;
    VariableInterrupt next = interrupt;
    if (next.look(h_[next.source]) || next.held != interrupt.held || next.last != interrupt.last)
      return false;
  }
  return true;
}

uint64_t Machine::idle_ticks(const std::array<uint32_t, kTasks>& budgets, uint32_t longest, bool* steady) {
  if (!interrupts_rest()) return 0;
  uint64_t ticks = kIdleForever;
  for (const TaskContext& t : contexts_)
    if (t.state == TaskState::Waiting && t.wait_ms != 0) ticks = std::min<uint64_t>(ticks, t.wait_ms - 1);
  if (ticks == 0) return 0;
  // Variables that somebody looks at, but for the loops that are still to come.
  Variables changed, used;
  for (uint32_t n = kFirstSystemVariable; n <= kLastSystemVariable; ++n) used[n] = true;
  for (const VariableInterrupt& interrupt : interrupts_.variables)
    if (interrupt.installed) used[interrupt.source] = true;
  for (int task = 1; task <= kTasks; ++task) {
    const int number = active_context(task);
    if (context(number).state != TaskState::Ready || budgets[static_cast<size_t>(task - 1)] == 0) continue;
    const Spin spin = find_spin(number, longest);
    if (spin.length == 0 || (spin.changed & used).any() || (spin.used & changed).any()) return 0;
    changed |= spin.changed;
    used |= spin.used;
  }
  if (steady != nullptr) *steady = changed.none();
  return ticks;
}

uint64_t Machine::skip_ticks(const std::array<uint32_t, kTasks>& budgets, uint64_t ticks) {
  for (TaskContext& t : contexts_)
    if (t.state == TaskState::Waiting && t.wait_ms != 0) t.wait_ms -= static_cast<uint32_t>(ticks);
  const auto installed = static_cast<uint64_t>(std::count_if(
      interrupts_.events.begin(), interrupts_.events.end(), [](const auto& row) { return row.installed; }));
  if (installed != 0)
    interrupts_.turn = static_cast<uint8_t>((interrupts_.turn % installed + ticks % installed) % installed);
  uint64_t executed = 0;
  for (int task = 1; task <= kTasks; ++task) {
    const int number = active_context(task);
    const uint64_t budget = budgets[static_cast<size_t>(task - 1)];
    if (context(number).state != TaskState::Ready || budget == 0) continue;
    const uint64_t commands = budget * ticks;
    const auto rest = static_cast<uint32_t>(commands % find_spin(number, UINT32_MAX).length);
    context_at(number).commands += commands - rest;
    run(task, rest);
    executed += commands;
  }
  return executed;
}

}  // namespace ipos::vm
