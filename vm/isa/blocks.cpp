// Rows of the table of blocks by command, operand and keyword.
#include "vm/isa/blocks.hpp"

#include <algorithm>
#include <array>

namespace ipos::vm {
namespace {

constexpr BlockInfo kBlocks[] = {
#define BLOCK(opcode, operand, keyword, variables, use, type) \
  {Opcode::opcode, operand, keyword, variables, BlockUse::use, type},
#include "vm/isa/blocks.def"
};

// Bit n of word m: the command 32 * m + n has rows. Most have none, and the verifier asks of each.
constexpr auto kWithBlocks = [] {
  std::array<uint32_t, 8> bits{};
  for (const BlockInfo& row : kBlocks) {
    const auto code = static_cast<uint8_t>(row.opcode);
    bits[code / 32] |= 1U << code % 32;
  }
  return bits;
}();

}  // namespace

std::span<const BlockInfo> block_table() { return kBlocks; }

std::span<const BlockInfo> blocks_of(Opcode opcode, size_t operand, int32_t keyword) {
  const auto rows = [&](int32_t wanted) {
    const auto holds = [&](const BlockInfo& row) {
      return row.opcode == opcode && row.operand == operand && row.keyword == wanted;
    };
    const auto* first = std::find_if(std::begin(kBlocks), std::end(kBlocks), holds);
    return std::span(first, std::find_if_not(first, std::end(kBlocks), holds));
  };
  const auto own = rows(keyword);
  return own.empty() ? rows(kAnyKeyword) : own;
}

uint32_t block_size(const Instruction& instruction, size_t operand) {
  const auto code = static_cast<uint8_t>(instruction.opcode);
  if ((kWithBlocks[code / 32] >> code % 32 & 1U) == 0) return 1;
  const Coding& row = coding(instruction.opcode);
  int32_t keyword = kAnyKeyword;
  uint32_t count = 1;
  for (auto value = instruction.operands.begin(); const OperandKind kind : row.kinds) {
    if (kind == OperandKind::Keyword) keyword = *value;
    if (kind == OperandKind::Count) count = static_cast<uint32_t>(*value);
    ++value;
  }
  const auto blocks = blocks_of(instruction.opcode, operand, keyword);
  if (blocks.empty()) return 1;
  uint32_t least = UINT32_MAX;
  for (const BlockInfo& block : blocks)
    least = std::min(least, block.variables == 0 ? count : uint32_t{block.variables});
  return least;
}

}  // namespace ipos::vm
