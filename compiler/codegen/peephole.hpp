// Clean-up of a function's commands: jumps and what nobody reaches. The table of rules stands in peephole.cpp
// and in docs/guide/language.md.
#pragma once

#include "compiler/codegen/code.hpp"

namespace ipos::compiler {

void optimize(FunctionCode& code);

}  // namespace ipos::compiler
