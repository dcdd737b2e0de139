// Shares a millisecond among the tasks: task 1 first, then 2, then 3, each with its number of commands
// (IPOSplus p. 44). The order of the tasks inside the millisecond is ours, see docs/inside/cycle.md.
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
inline uint32_t run_tick(Machine& machine, const Rates& rates) {
  machine.tick();
  return machine.run_tasks(rates.commands);
}

// A millisecond that can be left between any two commands, for debuggers: the commands of run_tick in the
// same order.
class TickSteps {
 public:
  void begin(Machine& machine, const Rates& rates);
  // Whose command is next; 0: the millisecond is over.
  int task() const { return task_ > kTasks ? 0 : task_; }
  const Rates& rates() const { return rates_; }  // of this millisecond
  // Executes at most `most` commands, all of that task; returns how many.
  uint32_t step(Machine& machine, uint32_t most = 1);

 private:
  void settle(const Machine& machine);

  Rates rates_;
  int task_ = kTasks + 1;
  uint32_t used_ = 0;  // of the budget of the task
};

}  // namespace ipos::vm
