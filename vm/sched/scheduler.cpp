// One tick of all tasks.
#include "vm/sched/scheduler.hpp"

namespace ipos::vm {

uint32_t run_tick(Machine& machine, const Rates& rates) {
  machine.tick();
  uint32_t executed = 0;
  for (int task = 1; task <= kTasks; ++task)
    executed += machine.run(task, rates.commands[static_cast<size_t>(task - 1)]).commands;
  return executed;
}

}  // namespace ipos::vm
