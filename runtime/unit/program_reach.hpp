// What the program of a unit can still do, starting from where its tasks stand now (vm/sched/outlook.hpp).
// It stays true until the program is restarted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/scom/variable_objects.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

struct ProgramReach {
  ProgramReach() = default;
  // `objects`: of its buses. They stay as they are when the program is mute. `positions`: the unit does, so it refuses no
  // command of positioning. `memory` of an earlier one is used again.
  ProgramReach(const vm::Machine& machine, std::span<const VariableObjects* const> objects, bool positions = false,
               std::vector<uint16_t> memory = {});

  bool mute = false;      // it does not call the bus
  bool modest = false;    // its commands write no system variable, what the host does for it aside
  bool quiet = false;     // modest, and it asks the host for nothing
  bool may_fault = true;  // it can cause a fault
  bool may_stop = true;   // it can do more than change variables in an endless loop
  // Its tasks use no variable that another one of them writes, and no telegram brings a system variable.
  bool apart = false;
  bool reads_position = true;  // a task uses variables that change with the position
  bool reads_travel = true;    // or those of them that change while the axis is on its way to a target
  bool sends_position = true;  // a telegram has system variables
  // Mute, modest and apart: variables that are to be given back when running ahead fails.
  std::vector<uint16_t> rollback;
};

// From the first to the last variable that a part of the unit follows, shows or counts.
bool is_system_variable(size_t variable);

}  // namespace ipos::runtime
