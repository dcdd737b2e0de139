// Passes over the commands of a program, see flow.hpp.
#include "vm/jit/flow.hpp"

#include <algorithm>

#include "vm/isa/effects.hpp"

namespace ipos::vm::jit {
namespace {

constexpr int kMostDepth = 7;

// Commands that are left to the engines: those of the host, blocks as they are rare, and what always faults.
bool is_native(const Instruction& command, Flow flow) {
  if (flow == Flow::System || flow == Flow::SystemCall || flow == Flow::End) return false;
  return coding(command.opcode).writes != Writes::Block && !always_faults(command);
}

bool goes_on(Flow flow) { return flow == Flow::Next || flow == Flow::Branch; }

}  // namespace

Program::Program(const VerifiedImage& image) : limits(image.limits()) {
  decode_all(image);
  mark();
  nest();
  count();
  find_tables();
}

void Program::decode_all(const VerifiedImage& image) {
  index.assign(image.code().size(), kNowhere);
  for (uint32_t at = 0; at < image.code().size();) {
    const Decoded decoded = decode(image.code(), at);
    Command command;
    command.instruction = decoded.instruction;
    command.flow = info(decoded.instruction.opcode).flow;
    command.at = at;
    command.native = is_native(decoded.instruction, command.flow);
    index[at] = static_cast<uint32_t>(commands.size());
    commands.push_back(command);
    at += decoded.words;
  }
}

// Where control comes together and where the budget is looked at. Every cycle has a backward jump, a call or
// a return in it.
void Program::mark() {
  for (uint32_t n = 0; n < commands.size(); ++n) {
    Command& command = commands[n];
    const OpcodeInfo& row = info(command.instruction.opcode);
    const bool last = n + 1 == commands.size();
    for (size_t operand = 0; operand < static_cast<size_t>(row.operand_count); ++operand) {
      if (row.operands[operand].kind != OperandKind::Label) continue;
      const uint32_t to = index[static_cast<uint32_t>(command.instruction.operands[operand])];
      commands[to].joins = true;
      if (command.flow == Flow::Jump || command.flow == Flow::Branch || command.flow == Flow::Call)
        command.target = to;
      if ((command.flow == Flow::Jump || command.flow == Flow::Branch) && to <= n) commands[to].checks = true;
      if (command.flow == Flow::Call) commands[to].called = true;
    }
    if (last) continue;
    if (command.flow == Flow::Call || command.flow == Flow::SystemCall) commands[n + 1].called = true;
    if (!command.native || !goes_on(command.flow)) commands[n + 1].joins = true;
  }
  for (Command& command : commands)
    if (command.called) command.joins = command.checks = true;
}

// Loops are what lies between a backward jump and its target. A subroutine is as deep as its deepest call,
// one deeper when it is called from further down, as it may call itself.
void Program::nest() {
  const size_t size = commands.size();
  std::vector<uint32_t> end(size, 0);  // of the loop that begins here
  for (uint32_t n = 0; n < size; ++n)
    if (commands[n].flow != Flow::Call && commands[n].target != kNowhere && commands[n].target <= n)
      end[commands[n].target] = std::max(end[commands[n].target], n + 1);
  std::vector<int> change(size + 1, 0);
  for (uint32_t n = 0; n < size; ++n)
    if (end[n] != 0) ++change[n], --change[end[n]];
  int depth = 0;
  for (uint32_t n = 0; n < size; ++n) commands[n].depth = std::min(depth += change[n], kMostDepth);

  std::vector<int> added(size, 0);
  std::vector<int> wanted(size, 0);  // of subroutines
  std::vector<uint32_t> open;
  for (int round = 0; round < kMostDepth; ++round) {
    bool changed = false;
    for (uint32_t n = 0; n < size; ++n) {
      const Command& command = commands[n];
      if (command.flow != Flow::Call) continue;
      const int calls = std::min(command.depth + added[n] + (command.target <= n), kMostDepth);
      if (calls <= wanted[command.target]) continue;
      wanted[command.target] = calls;
      changed = true;
    }
    if (!changed) break;
    for (uint32_t first = 0; first < size; ++first) {
      if (wanted[first] <= added[first]) continue;
      open.assign(1, first);
      while (!open.empty()) {
        const uint32_t n = open.back();
        open.pop_back();
        if (n >= size || added[n] >= wanted[first]) continue;
        added[n] = wanted[first];
        const Command& command = commands[n];
        if (command.flow != Flow::Jump && command.flow != Flow::Return && command.flow != Flow::End)
          open.push_back(n + 1);
        if (command.flow == Flow::Jump || command.flow == Flow::Branch) open.push_back(command.target);
      }
    }
  }
  for (uint32_t n = 0; n < size; ++n) commands[n].depth = std::min(commands[n].depth + added[n], kMostDepth);
}

void Program::count() {
  // What follows: backward, as what leads back leads to a check.
  const auto behind = [&](uint32_t n) { return commands[n].checks ? 0 : commands[n].need; };
  for (uint32_t n = static_cast<uint32_t>(commands.size()); n-- > 0;) {
    Command& command = commands[n];
    if (!command.native) continue;
    int32_t most = 0;
    if (goes_on(command.flow)) most = behind(n + 1);
    if (command.flow == Flow::Jump || command.flow == Flow::Branch)
      most = std::max(most, command.target <= n ? 0 : behind(command.target));
    command.need = 1 + most;
  }
  // Credits: where ways meet, a branch that is taken comes without correction, as it would need one on both
  // of its ways; else any. Of several the one in the innermost loop.
  struct Offer {
    int depth = -1;
    int32_t credit = 0;
    void take(const Command& from) {
      if (from.depth > depth) *this = {from.depth, from.credit - 1};
    }
  };
  std::vector<Offer> by_branch(commands.size()), otherwise(commands.size());
  for (uint32_t n = 0; n < commands.size(); ++n) {
    Command& command = commands[n];
    command.credit = command.checks            ? command.need
                     : by_branch[n].depth >= 0 ? by_branch[n].credit
                     : otherwise[n].depth >= 0 ? otherwise[n].credit
                                               : command.need;
    if (!command.native) continue;
    if (goes_on(command.flow)) otherwise[n + 1].take(command);
    if (command.target == kNowhere || command.flow == Flow::Call) continue;
    // The way back into a loop comes without correction, too.
    (command.flow == Flow::Branch || command.target <= n ? by_branch : otherwise)[command.target].take(
        command);
  }
  // Who calls and who returns know nothing of each other: 0.
  for (uint32_t n = 0; n < commands.size(); ++n)
    if (commands[n].checks && !commands[n].called) commands[n].arrival = std::max(by_branch[n].credit, 0);
}

// What has been added to the copy of an index, also where one copy serves several elements in turn; else the constant that was
// added to the index last, or one that it is set to anywhere.
void Program::find_tables() {
  constexpr uint32_t kLook = 8, kLookForCopy = 32;
  const auto is_variable = [&](int32_t number) { return static_cast<uint32_t>(number) < limits.variables; };
  std::vector<int32_t> set_to(limits.variables, -1);
  for (const Command& command : commands) {
    const auto& operands = command.instruction.operands;
    if (command.instruction.opcode != Opcode::SetHK || !is_variable(operands[1])) continue;
    int32_t& constant = set_to[static_cast<size_t>(operands[0])];
    constant = std::max(constant, operands[1]);
  }
  for (uint32_t n = 0; n < commands.size(); ++n) {
    const Opcode opcode = commands[n].instruction.opcode;
    if (opcode != Opcode::SetiLoad && opcode != Opcode::SetiStore) continue;
    int32_t& table = commands[n].table;
    int32_t variable = commands[n].instruction.operands[opcode == Opcode::SetiLoad ? 1 : 0];
    int64_t added = 0;   // to the variable, back to where it became a copy
    int32_t near = -1;   // what was added to it last. A step of 1 belongs to a pointer
    for (uint32_t back = n; table < 0 && back-- > 0 && back + kLookForCopy >= n;) {
      const Instruction& command = commands[back].instruction;
      if (command.operands[0] != variable) continue;
      if (command.opcode == Opcode::AddHK) {
        added += command.operands[1];
        if (near < 0 && command.operands[1] != 1 && is_variable(command.operands[1]) && back + kLook >= n) near = command.operands[1];
      } else if (command.opcode == Opcode::SetHH) {
        if (near >= 0 || added > 1) table = added > 1 && added < limits.variables ? static_cast<int32_t>(added) : near;
        variable = command.operands[1];
        added = 0;
      }
    }
    if (table < 0) table = near;
    if (table < 0) table = set_to[static_cast<size_t>(variable)];
  }
}

std::vector<uint16_t> hottest_variables(const Program& program, size_t most) {
  const size_t size = program.limits.variables;
  std::vector<uint64_t> weights(size, 0), tables(size, 0);
  for (const Command& command : program.commands) {
    if (!command.native || command.depth == 0) continue;
    const uint64_t weight = uint64_t{1} << (3 * command.depth);
    const OpcodeInfo& row = info(command.instruction.opcode);
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n)
      if (row.operands[n].kind == OperandKind::Variable)
        weights[static_cast<size_t>(command.instruction.operands[n])] += weight;
    if (command.table >= 0) tables[static_cast<size_t>(command.table)] += weight;
  }
  std::vector<uint16_t> numbers;
  uint64_t table = 0;
  for (size_t n = 0; n < size; ++n) {
    table = std::max(table, tables[n]);
    if (weights[n] != 0 && 2 * weights[n] >= table) numbers.push_back(static_cast<uint16_t>(n));
  }
  std::stable_sort(numbers.begin(), numbers.end(),
                   [&](uint16_t a, uint16_t b) { return weights[a] > weights[b]; });
  if (numbers.size() > most) numbers.resize(most);
  return numbers;
}

}  // namespace ipos::vm::jit
