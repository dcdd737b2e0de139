// By the operands of the command and the blocks that they begin.
#include "compiler/analysis/uses.hpp"

#include <algorithm>

namespace ipos::compiler::analysis {
namespace {

using vm::Opcode;

// The command takes only its place, whatever was there.
bool only_writes(Opcode opcode) {
  return opcode == Opcode::SetHH || opcode == Opcode::SetHK || opcode == Opcode::SetiLoad || opcode == Opcode::NotH;
}

}  // namespace

std::vector<Span> read_by(const Graph& graph, const Values& values, size_t number) {
  const vm::Instruction& code = graph.commands[number].code;
  const vm::Coding& row = vm::coding(code.opcode);
  std::vector<Span> all;
  const std::vector<const vm::BlockInfo*> blocks = blocks_of(code);
  for (size_t operand = 0; operand < row.operand_count; ++operand) {
    if (row.kinds[operand] != vm::OperandKind::Variable || (operand == 0 && only_writes(code.opcode))) continue;
    int64_t count = 1;
    for (const vm::BlockInfo* block : blocks)
      if (block->operand == operand) count = block->use == vm::BlockUse::Write ? 0 : std::max<int64_t>(count, block->variables);
    if (code.opcode == Opcode::Copy) count = operand == 0 ? 0 : code.operands[2];
    all.push_back({code.operands[operand], code.operands[operand] + count - 1});
  }
  if (code.opcode == Opcode::SetiLoad) {
    const Interval from = values.at(number, static_cast<uint32_t>(code.operands[1]));
    all.push_back({from.least, from.most});
  }
  return all;
}

}  // namespace ipos::compiler::analysis
