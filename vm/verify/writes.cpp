// One look at each command; of those that only go on to the next the first operand takes the result.
#include "vm/verify/writes.hpp"

#include <algorithm>

namespace ipos::vm {

bool may_write(const VerifiedImage& program, uint32_t first, uint32_t last) {
  for (uint32_t address = 0; address < program.code().size();) {
    const Decoded decoded = decode(program.code(), address);
    const Instruction& command = decoded.instruction;
    address += decoded.words;
    const bool names = coding(command.opcode).flow == Flow::Next && command.opcode != Opcode::Nop;
    // The store goes anywhere; a variable interrupt notes the value it has seen.
    if (command.opcode == Opcode::SetiStore || command.opcode == Opcode::VarInt) return true;
    if (!names) continue;
    const auto to = static_cast<uint32_t>(command.operands[0]);
    const uint32_t count = command.opcode == Opcode::Copy ? static_cast<uint32_t>(command.operands[2]) : 1;
    if (to <= last && to + count > first) return true;
  }
  return false;
}

}  // namespace ipos::vm
