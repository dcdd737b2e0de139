// Warnings about variables that several tasks or interrupt routines write.
#pragma once

#include "compiler/sema/context.hpp"

namespace ipos::compiler {

void check_writers(Context& context);

}  // namespace ipos::compiler
