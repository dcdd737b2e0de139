// Shares a millisecond among the tasks: task 1 first, then 2, then 3, each with its number of commands
// (IPOSplus p. 44). The order of the tasks inside the millisecond is ours, see docs/cycle.md.
#pragma once

#include <array>
#include <cstdint>

#include "vm/exec/machine.hpp"

namespace ipos::vm {

// Commands per millisecond of tasks 1, 2 and 3: P938 + 1, P939 + 2, and 20 for task 3 (ours, the manual says
// typically 20 to 40).
struct Rates {
  std::array<uint32_t, kTasks> commands{1, 2, 20};
};

// One millisecond: waits count down, then every task gets its commands. Returns the commands executed.
uint32_t run_tick(Machine& machine, const Rates& rates);

}  // namespace ipos::vm
