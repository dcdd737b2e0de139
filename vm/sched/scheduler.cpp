// Single steps.
#include "vm/sched/scheduler.hpp"

#include <algorithm>

namespace ipos::vm {

void TickSteps::begin(Machine& machine, const Rates& rates) {
  machine.tick();
  rates_ = rates;
  task_ = 1;
  used_ = 0;
  settle(machine);
}

// Goes on to the next task that can execute a command.
void TickSteps::settle(const Machine& machine) {
  while (task_ <= kTasks && (used_ >= rates_.commands[static_cast<size_t>(task_ - 1)] ||
                             machine.context(machine.active_context(task_)).state != TaskState::Ready)) {
    ++task_;
    used_ = 0;
  }
}

uint32_t TickSteps::step(Machine& machine, uint32_t most) {
  const uint32_t left = rates_.commands[static_cast<size_t>(task_ - 1)] - used_;
  const uint32_t executed = machine.run(task_, std::min(left, most)).commands;
  used_ += executed;
  settle(machine);
  return executed;
}

}  // namespace ipos::vm
