// One look at each command.
#include "vm/verify/writes.hpp"

#include "vm/isa/effects.hpp"

namespace ipos::vm {

bool may_write(const VerifiedImage& program, uint32_t first, uint32_t last) {
  for (uint32_t address = 0; address < program.code().size();) {
    const Decoded decoded = decode(program.code(), address);
    const Instruction& command = decoded.instruction;
    address += decoded.words;
    if (coding(command.opcode).writes == Writes::Indexed) return true;
    const VariableRange to = named_target(command);
    if (to.first <= last && to.end() > first) return true;
  }
  return false;
}

}  // namespace ipos::vm
