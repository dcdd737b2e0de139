// Blocks of variables that commands work on, from blocks.def: what the verifier demands of numbers and the
// compiler of types.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "vm/isa/coding.hpp"

namespace ipos::vm {

enum class BlockUse : uint8_t { Read, Write, Both, Lasting };

inline constexpr int32_t kAnyKeyword = -1;

struct BlockInfo {
  Opcode opcode;
  uint8_t operand;
  int32_t keyword;  // kAnyKeyword: every one without a row of its own
  uint8_t variables;
  BlockUse use;
  std::string_view type;
};

std::span<const BlockInfo> block_table();

// The rows of an operand: one, or several of which any may hold. Empty: one plain value.
std::span<const BlockInfo> blocks_of(Opcode opcode, size_t operand, int32_t keyword);

// Variables that `operand` of a command begins, the least where several rows hold.
uint32_t block_size(const Instruction& instruction, size_t operand);

}  // namespace ipos::vm
