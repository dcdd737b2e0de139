// The graph is that of verified code: every label leads to a command.
#include "compiler/analysis/graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "compiler/asm/disassembler.hpp"

namespace ipos::compiler::analysis {

using vm::Flow;
using vm::Opcode;

std::vector<const vm::BlockInfo*> blocks_of(const vm::Instruction& code) {
  const vm::Coding& row = vm::coding(code.opcode);
  int32_t keyword = vm::kAnyKeyword;
  for (size_t operand = 0; operand < row.operand_count; ++operand)
    if (row.kinds[operand] == vm::OperandKind::Keyword) keyword = code.operands[operand];
  std::vector<const vm::BlockInfo*> all;
  for (size_t operand = 0; operand < row.operand_count; ++operand)
    if (row.kinds[operand] == vm::OperandKind::Variable)
      for (const vm::BlockInfo& block : vm::blocks_of(code.opcode, operand, keyword)) all.push_back(&block);
  return all;
}

uint32_t line_of(const vm::Image& image, uint32_t address) {
  const auto next = std::upper_bound(image.lines.begin(), image.lines.end(), address,
                                     [](uint32_t at, const vm::LineEntry& entry) { return at < entry.address; });
  return next == image.lines.begin() ? 0 : std::prev(next)->line;
}

std::string variable_name(const vm::Image& image, uint32_t variable) {
  for (const vm::Symbol& symbol : image.symbols)
    if (variable >= symbol.variable && variable < symbol.variable + symbol.count)
      return symbol.count == 1 ? symbol.name : fmt::format("{}[{}]", symbol.name, variable - symbol.variable);
  return fmt::format("H{}", variable);
}

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
  if (!commands.empty()) add_root({});
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
    command.label = label;
    if (!command.ends && row.flow != Flow::Jump && following != at.end()) command.next = following->second;
    if (command.calls && label != kNone) add_entry(label);
    if (const auto started = started_by(n)) {
      add_root(*started);
      command.started = std::exchange(command.label, kNone);  // the flow does not go there
    }
  }
  for (const vm::FunctionEntry& function : image.functions)
    if (const auto found = at.find(function.address); found != at.end()) add_entry(found->second);
}

std::optional<Root> Graph::started_by(size_t number) const {
  const Command& command = commands[number];
  const size_t label = command.started != kNone ? command.started : command.label;
  if (label == kNone) return std::nullopt;
  switch (command.code.opcode) {
    case Opcode::Task: return Root{label, 3, Root::How::Task};
    case Opcode::Task2: return Root{label, 2, Root::How::Task};
    case Opcode::VarInt: return Root{label, 2, Root::How::Interrupt};
    case Opcode::SetInt: return Root{label, 1, Root::How::Interrupt};
    default: return std::nullopt;
  }
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

}  // namespace ipos::compiler::analysis
