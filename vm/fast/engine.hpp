// The fast engine: executes predecoded programs, command by command the same as the reference interpreter
// (vm/exec), whose work it leaves to it whenever a command needs more than variables.
#pragma once

#include "vm/context/context.hpp"
#include "vm/fast/native.hpp"
#include "vm/fast/predecode.hpp"

namespace ipos::vm::fast {

// Executes commands of a context until `budget` of them are done or until it stands at one that is not for
// this engine: system commands, what would end a task, what would fault. Returns how many of them are left;
// pc, calls and the count of commands are up to date. Does at most 2^30 at a time. With machine code of the
// same program it executes that as far as the budget goes.
uint32_t run(const Predecoded& program, TaskContext& t, int32_t* h, uint32_t budget, const Native* native);

// What stands for an operation in Slot::Command::handler: its number, or with computed goto the distance of
// its handler from handler_base().
uint16_t handler_of(Operation operation, const void* base);
const void* handler_base();

}  // namespace ipos::vm::fast
