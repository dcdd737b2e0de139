// Loops whose indexes need no look: for (; k < n; k += d) v[k] = c, one line of commands that counts a
// variable up to a limit and has no other index than that variable and a constant. When all is well at the
// beginning of such a loop it stays so, and it can be executed by code that leaves the checks out.
#pragma once

#include <optional>

#include "vm/jit/flow.hpp"

namespace ipos::vm::jit {

struct CountedLoop {
  uint32_t first = 0, last = 0;     // commands; the last is the test
  int32_t counter = 0;              // its variable
  Instruction step;                 // ADD counter + constant above 0, or + variable
  Instruction test;                 // JMP counter < limit or <= limit
  std::optional<uint32_t> access;   // its first SETI
  int32_t lowest = 0, highest = 0;  // of the constants in the indexes
  std::vector<int32_t> fixed;       // the variables all this depends on

  // The tests, as jumps, that find whether all indexes will lie in the `count` variables from `in` on, none
  // of which is a fixed one: when one of them jumps, that is not sure. Nothing when it can be seen already
  // that they will not.
  std::optional<std::vector<Instruction>> doubts(uint32_t in, uint32_t count) const;
};

// The loop that begins at a command, if it is one of these.
std::optional<CountedLoop> counted_loop(const Program& program, uint32_t first);

}  // namespace ipos::vm::jit
