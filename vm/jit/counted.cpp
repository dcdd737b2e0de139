// Finding counted loops, see counted.hpp.
#include "vm/jit/counted.hpp"

#include <algorithm>

#include "vm/isa/effects.hpp"

namespace ipos::vm::jit {
namespace {

// Far above any number of a variable, and two of them still make no overflow.
constexpr int32_t kFar = 1 << 20;

// The variable a command of a line sets, -1: none by its name.
int32_t set_by(const Instruction& command) {
  const VariableRange target = named_target(command);
  return target.count == 0 ? -1 : static_cast<int32_t>(target.first);
}

// What is added to the counter to get this index at a command of the loop; nothing when it is not that. Notes
// the variables it is made in.
std::optional<int32_t> constant_of(const Program& program, CountedLoop& loop, uint32_t at, int32_t index) {
  int64_t sum = 0;
  while (index != loop.counter) {
    loop.fixed.push_back(index);
    if (at-- == loop.first) return std::nullopt;
    const Instruction& command = program.commands[at].instruction;
    if (set_by(command) != index) continue;
    if (command.opcode == Opcode::AddHK)
      sum += command.operands[1];
    else if (command.opcode == Opcode::SubHK)
      sum -= command.operands[1];
    else if (command.opcode == Opcode::SetHH)
      index = command.operands[1];
    else
      return std::nullopt;
  }
  if (sum < -kFar || sum > kFar) return std::nullopt;
  return static_cast<int32_t>(sum);
}

}  // namespace

std::optional<CountedLoop> counted_loop(const Program& program, uint32_t first) {
  const auto& commands = program.commands;
  if (!commands[first].checks || commands[first].called) return std::nullopt;
  uint32_t last = first;
  while (last < commands.size() && commands[last].native && commands[last].flow == Flow::Next &&
         (last == first || !commands[last].joins))
    ++last;
  if (last >= commands.size() || last < first + 2 || commands[last].joins || commands[last].target != first)
    return std::nullopt;
  CountedLoop loop;
  loop.first = first;
  loop.last = last;
  loop.step = commands[last - 1].instruction;
  loop.test = commands[last].instruction;
  loop.counter = loop.test.operands[0];
  const bool below = loop.test.opcode == Opcode::JmpLtHK || loop.test.opcode == Opcode::JmpLtHH;
  const bool up_to = loop.test.opcode == Opcode::JmpLeHK || loop.test.opcode == Opcode::JmpLeHH;
  const bool steps =
      (loop.step.opcode == Opcode::AddHK && loop.step.operands[1] > 0) || loop.step.opcode == Opcode::AddHH;
  if ((!below && !up_to) || !steps || loop.step.operands[0] != loop.counter) return std::nullopt;

  // Nothing else changes the counter, and nothing step or limit.
  loop.fixed = {loop.counter};
  if (loop.step.opcode == Opcode::AddHH) loop.fixed.push_back(loop.step.operands[1]);
  if (loop.test.opcode == Opcode::JmpLtHH || loop.test.opcode == Opcode::JmpLeHH)
    loop.fixed.push_back(loop.test.operands[1]);
  const std::vector<int32_t> given = loop.fixed;
  if (std::count(given.begin(), given.end(), loop.counter) != 1) return std::nullopt;
  for (uint32_t n = first; n + 1 < last; ++n) {
    const Instruction& command = commands[n].instruction;
    if (std::find(given.begin(), given.end(), set_by(command)) != given.end() || named_target(command).count > 1)
      return std::nullopt;
    const bool loads = command.opcode == Opcode::SetiLoad;
    if (!loads && command.opcode != Opcode::SetiStore) continue;
    const auto constant = constant_of(program, loop, n, command.operands[loads ? 1 : 0]);
    if (!constant) return std::nullopt;
    if (!loop.access) loop.lowest = loop.highest = *constant;
    loop.access = loop.access.value_or(n);
    loop.lowest = std::min(loop.lowest, *constant);
    loop.highest = std::max(loop.highest, *constant);
  }
  if (!loop.access) return std::nullopt;
  return loop;
}

// With the counter at least `begin` and below `end` all indexes are in these variables. What is tested after
// the step keeps it below the limit, and the step keeps it from falling, as it is above 0 and so small that
// the sum does not overflow.
std::optional<std::vector<Instruction>> CountedLoop::doubts(uint32_t in, uint32_t count) const {
  const int32_t begin = static_cast<int32_t>(in) - lowest;
  const int32_t end = static_cast<int32_t>(in + count) - highest;
  std::vector<Instruction> out{{Opcode::JmpLtHK, {counter, begin}}, {Opcode::JmpGeHK, {counter, end}}};
  const int32_t limit = test.operands[1];
  switch (test.opcode) {
    case Opcode::JmpLtHK:
      if (limit > end) return std::nullopt;
      break;
    case Opcode::JmpLeHK:
      if (limit >= end) return std::nullopt;
      break;
    case Opcode::JmpLtHH: out.push_back({Opcode::JmpGtHK, {limit, end}}); break;
    default: out.push_back({Opcode::JmpGeHK, {limit, end}}); break;
  }
  const int32_t by = step.operands[1];
  if (step.opcode == Opcode::AddHH) {
    out.push_back({Opcode::JmpLeHK, {by, 0}});
    out.push_back({Opcode::JmpGtHK, {by, kFar}});
  } else if (by > kFar) {
    return std::nullopt;
  }
  return out;
}

}  // namespace ipos::vm::jit
