// Machine code of a program, as the fast engine sees it; vm/jit makes it where the target and the build have
// it. Nothing of it is needed here: without it every command is the engine's own.
#pragma once

#include <cstdint>
#include <span>

#include "vm/context/context.hpp"

namespace ipos::vm::fast {

struct Native {
  // For each word address the commands that may follow from there until the budget is looked at again; so
  // many must be left to enter. 0: there is no way in.
  std::span<const uint16_t> needs;

  // Executes commands from t.pc on until it stands at one that is not for it or the budget may not suffice;
  // at least needs[t.pc] are left. Returns how many are left then; pc and calls are up to date.
  uint32_t (*run)(const Native& self, TaskContext& t, int32_t* h, uint32_t left);
};

}  // namespace ipos::vm::fast
