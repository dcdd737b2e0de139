// Warnings of what a program as a whole leaves out or does twice: telegrams that nothing starts, a timer interrupt without
// a time, a timer of two tasks, numbers that are reserved, memory that is worn, results that nobody reads.
#pragma once

#include "compiler/sema/command_check.hpp"
#include "compiler/sema/written.hpp"

namespace ipos::compiler {

// `commands` has seen all commands.
void check_program(Context& context, const ProgramRoots& roots, const CommandCheck& commands, const Written& written);

}  // namespace ipos::compiler
