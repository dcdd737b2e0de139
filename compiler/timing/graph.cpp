// The graph is that of verified code: every label leads to a command.
#include "compiler/timing/graph.hpp"

#include <algorithm>
#include <unordered_map>

#include "compiler/asm/disassembler.hpp"

namespace ipos::compiler::timing {

using vm::Flow;
using vm::Opcode;

namespace {

// What a command starts beside its own task; 0: nothing.
uint8_t started_task(const vm::Instruction& code) {
  switch (code.opcode) {
    case Opcode::Task: return 3;
    case Opcode::Task2:
    case Opcode::VarInt: return 2;
    case Opcode::SetInt: return 1;
    default: return 0;
  }
}

}  // namespace

Graph::Graph(const vm::Image& image) {
  std::unordered_map<uint32_t, size_t> at;
  for (const CodeItem& item : code_items(image.code)) {
    if (!item.command) continue;
    at[item.address] = commands.size();
    commands.push_back({*item.command, item.address});
  }
  const auto add_entry = [&](size_t entry) {
    if (std::find(entries.begin(), entries.end(), entry) == entries.end()) entries.push_back(entry);
  };
  const auto add_root = [&](Root root) {
    if (std::find(roots.begin(), roots.end(), root) == roots.end()) roots.push_back(root);
    add_entry(root.entry);
  };
  if (!commands.empty()) add_root({0, 1});
  for (size_t n = 0; n < commands.size(); ++n) {
    Command& command = commands[n];
    const vm::Coding& row = vm::coding(command.code.opcode);
    const auto following = at.find(command.address + row.words);
    size_t label = kNone;
    for (size_t operand = 0; operand < row.operand_count; ++operand)
      if (row.kinds[operand] == vm::OperandKind::Label)
        if (const auto found = at.find(static_cast<uint32_t>(command.code.operands[operand])); found != at.end())
          label = found->second;
    command.calls = row.flow == Flow::Call || row.flow == Flow::SystemCall;
    command.ends = row.flow == Flow::Return || row.flow == Flow::End;
    if (command.calls || row.flow == Flow::Jump || row.flow == Flow::Branch) command.label = label;
    if (!command.ends && row.flow != Flow::Jump && following != at.end()) command.next = following->second;
    if (command.calls && label != kNone) add_entry(label);
    if (const uint8_t task = started_task(command.code); task != 0 && label != kNone) add_root({label, task});
  }
  for (const vm::FunctionEntry& function : image.functions)
    if (const auto found = at.find(function.address); found != at.end()) add_entry(found->second);
}

std::vector<size_t> Graph::successors(size_t number) const {
  const Command& command = commands[number];
  std::vector<size_t> all;
  if (command.next != kNone) all.push_back(command.next);
  if (command.label != kNone && !command.calls && command.label != command.next) all.push_back(command.label);
  return all;
}

namespace {

std::vector<size_t> reach(const Graph& graph, size_t entry, bool with_calls) {
  std::vector<bool> seen(graph.commands.size());
  std::vector<size_t> found{entry};
  seen[entry] = true;
  for (size_t n = 0; n < found.size(); ++n) {
    const Command& command = graph.commands[found[n]];
    std::vector<size_t> next = graph.successors(found[n]);
    if (with_calls && command.calls && command.label != kNone) next.push_back(command.label);
    for (const size_t to : next)
      if (!seen[to]) {
        seen[to] = true;
        found.push_back(to);
      }
  }
  return found;
}

}  // namespace

std::vector<size_t> Graph::function_at(size_t entry) const { return reach(*this, entry, false); }
std::vector<size_t> Graph::reached_from(size_t entry) const { return reach(*this, entry, true); }

}  // namespace ipos::compiler::timing
