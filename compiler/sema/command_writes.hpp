// The blocks of variables that a system command writes, from vm/isa/blocks.def. Of the structures that hold orders only the
// last member is written: the result.
#pragma once

#include "compiler/sema/checked.hpp"
#include "vm/isa/blocks.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::compiler {

// Keywords of SCOM (keywords.def, set scom).
inline constexpr int32_t kTransmitCyclic = 1;
inline constexpr int32_t kTransmitAcyclic = 2;
inline constexpr int32_t kReceive = 3;

// Of MOVLNK, SCOM and VARINT: the structure they take orders from, and whether they write a result into it.
struct OrderBlock {
  uint32_t first = 0;
  uint32_t size = 0;  // 0: another command
  bool result = false;
};

// They write nothing of their structure but its last member.
inline bool takes_orders(vm::Opcode opcode) {
  return opcode == vm::Opcode::Scom || opcode == vm::Opcode::Movlnk || opcode == vm::Opcode::VarInt;
}

inline OrderBlock order_block(const checked::SystemCall& call) {
  using vm::Opcode;
  if (!takes_orders(call.opcode)) return {};
  const bool scom = call.opcode == Opcode::Scom;
  const size_t operand = scom ? 1 : 0;
  const int32_t keyword = scom ? std::get<int32_t>(call.arguments[0]) : vm::kAnyKeyword;
  const vm::BlockInfo& row = vm::blocks_of(call.opcode, operand, keyword).front();
  return {static_cast<uint32_t>(std::get<int32_t>(call.arguments[operand])), row.variables,
          row.use != vm::BlockUse::Read};
}

// visit(first, count)
template <typename Visit>
void written_blocks(const checked::SystemCall& call, Visit visit) {
  if (const OrderBlock orders = order_block(call); orders.size != 0) {
    if (orders.result) visit(orders.first + orders.size - 1, 1U);
    return;
  }
  const vm::OpcodeInfo& row = vm::info(call.opcode);
  int32_t keyword = vm::kAnyKeyword;
  uint32_t count = 1;
  for (size_t n = 0; n < call.arguments.size(); ++n) {
    const int32_t* number = std::get_if<int32_t>(&call.arguments[n]);
    if (number != nullptr && row.operands[n].kind == vm::OperandKind::Keyword) keyword = *number;
    if (number != nullptr && row.operands[n].kind == vm::OperandKind::Count) count = static_cast<uint32_t>(*number);
  }
  for (size_t n = 0; n < call.arguments.size(); ++n) {
    const int32_t* number = std::get_if<int32_t>(&call.arguments[n]);
    if (number == nullptr || row.operands[n].kind != vm::OperandKind::Variable) continue;
    for (const vm::BlockInfo& block : vm::blocks_of(call.opcode, n, keyword))
      if (block.use != vm::BlockUse::Read)
        visit(static_cast<uint32_t>(*number), block.variables == 0 ? count : uint32_t{block.variables});
  }
}

}  // namespace ipos::compiler
