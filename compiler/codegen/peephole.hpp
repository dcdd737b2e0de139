// Clean-up of a function's commands: jumps and what nobody reaches. The table of rules stands in peephole.cpp
// and in docs/language.md.
#pragma once

#include "compiler/codegen/code.hpp"

namespace ipos::compiler {

void optimize(FunctionCode& code);

// The branch that jumps when this one does not; other commands as they are.
vm::Opcode inverse(vm::Opcode opcode);

}  // namespace ipos::compiler
