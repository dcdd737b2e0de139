// Passes over the commands of a program, see flow.hpp.
#include "vm/jit/flow.hpp"

#include <algorithm>

#include "vm/isa/effects.hpp"

namespace ipos::vm::jit {
namespace {

constexpr int kMostDepth = 7;
constexpr uint64_t kDeeper = 8;  // times what is in a loop is executed as often as what is around it, by guess

// Commands that are left to the engines: those of the host, long blocks, and what always faults.
bool is_native(const Instruction& command, Flow flow) {
  constexpr uint32_t kLongestBlock = 8;
  if (flow == Flow::System || flow == Flow::SystemCall || flow == Flow::End) return false;
  return named_target(command).count <= kLongestBlock && !always_faults(command);
}

bool sums(Opcode opcode) {
  return opcode == Opcode::SetHH || opcode == Opcode::SetHK || opcode == Opcode::AddHH || opcode == Opcode::AddHK ||
         opcode == Opcode::SubHK;
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

// The sum of the constants that make an index, back to where it comes of something else than sums: the beginning of the
// table, or some elements more. For a pointer that comes from farther away at least the greatest constant it gets anywhere.
void Program::find_tables() {
  constexpr uint32_t kLook = 128;
  const auto is_variable = [&](int64_t number) { return number >= 0 && number < limits.variables; };
  std::vector<int32_t> anywhere(limits.variables, -1);
  for (const Command& command : commands) {
    const auto& [opcode, operands] = command.instruction;
    if ((opcode != Opcode::SetHK && opcode != Opcode::AddHK) || !is_variable(operands[1])) continue;
    int32_t& constant = anywhere[static_cast<size_t>(operands[0])];
    constant = std::max(constant, operands[1]);
  }
  for (uint32_t n = 0; n < commands.size(); ++n) {
    const Opcode opcode = commands[n].instruction.opcode;
    if (opcode != Opcode::SetiLoad && opcode != Opcode::SetiStore) continue;
    int32_t variable = commands[n].instruction.operands[opcode == Opcode::SetiLoad ? 1 : 0];
    int64_t sum = 0;
    bool begun = false, made = false;  // of constants
    for (uint32_t back = n; !begun && back-- > 0 && back + kLook >= n;) {
      const Instruction& command = commands[back].instruction;
      if (!named_target(command).has(static_cast<uint32_t>(variable))) continue;
      const bool adds = command.opcode == Opcode::AddHK || command.opcode == Opcode::SetHK;
      if (adds || command.opcode == Opcode::SubHK) {
        sum += adds ? int64_t{command.operands[1]} : -int64_t{command.operands[1]};
        made = true;
      }
      if (command.opcode == Opcode::SetHH) variable = command.operands[1];
      begun = command.opcode == Opcode::SetHK || !sums(command.opcode);
    }
    int32_t& table = commands[n].table;
    if (made && is_variable(sum)) table = static_cast<int32_t>(sum);
    if (!begun) table = std::max(table, anywhere[static_cast<size_t>(variable)]);
  }
}

std::vector<uint16_t> hottest_variables(const Program& program, size_t most) {
  const size_t size = program.limits.variables;
  std::vector<uint64_t> weights(size, 0), tables(size, 0);
  for (const Command& command : program.commands) {
    if (!command.native || command.depth == 0) continue;
    uint64_t weight = 1;
    for (int n = 0; n < command.depth; ++n) weight *= kDeeper;
    each_named(command.instruction, [&](VariableRange range) {
      for (uint32_t n = range.first; n < range.end(); ++n) weights[n] += weight;
    });
    if (command.table >= 0) tables[static_cast<size_t>(command.table)] += weight;
  }
  std::vector<uint16_t> numbers;
  uint64_t table = 0;
  for (size_t n = 0; n < size; ++n) {
    table = std::max(table, tables[n]);
    if (weights[n] != 0 && kDeeper * weights[n] >= table) numbers.push_back(static_cast<uint16_t>(n));
  }
  std::stable_sort(numbers.begin(), numbers.end(),
                   [&](uint16_t a, uint16_t b) { return weights[a] > weights[b]; });
  if (numbers.size() > most) numbers.resize(most);
  return numbers;
}

}  // namespace ipos::vm::jit
