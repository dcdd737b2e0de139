// What the program of a station will still do, whatever happens, as far as its station asks: found from where
// its tasks stand (vm/sched/outlook.hpp), and true until the program is started anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/services/variable_objects.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

struct Prospect {
  Prospect() = default;
  // `objects`: of its buses. They stay as they are when the program is mute.
  Prospect(const vm::Machine& machine, std::span<const VariableObjects* const> objects);

  bool mute = false;      // it does not call the bus
  bool may_fault = true;  // it can cause a fault
  bool may_stop = true;   // it can do anything but to change variables for ever
  // Its tasks use no variable that another one of them writes, and no telegram brings a system variable.
  bool apart = false;
  bool minds_motion = true;  // a task uses variables that show the position
  bool tells_motion = true;  // a telegram has system variables
  // Mute and apart: variables that are to be given back when running ahead fails.
  std::vector<uint16_t> undone;
};

// From the first to the last variable that a part of the unit follows, shows or counts.
bool is_system_variable(size_t variable);

}  // namespace ipos::runtime
