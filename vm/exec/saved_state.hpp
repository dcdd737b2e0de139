// A machine's state as bytes that mean the same on every platform. Reading is in two steps, so that bytes of
// any origin can be refused before anything has changed.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/exec/machine.hpp"

namespace ipos::vm {

class SavedState {
 public:
  static size_t size(const VerifiedImage& program);
  // Writes and reads size() bytes; both return where they end.
  static uint8_t* write(const Machine& machine, uint8_t* bytes);
  // Only what has passed check() for this machine's program.
  static const uint8_t* read(const uint8_t* bytes, Machine& machine);

  // Whether a machine of this program could be in that state, as far as execution depends on it: contexts
  // stand at commands and return to commands, waits are in commands that wait, numbers are in their ranges.
  // Uses a bit of stack for each word of the longest program.
  static bool check(const VerifiedImage& program, const uint8_t* bytes);

  // As if the context had been saved in front of another command of the program: for debuggers. It is ready.
  static void go_on_at(Machine& machine, int context, uint32_t address);
};

}  // namespace ipos::vm
