// Looks at SBus objects set up with constants for what _SBusCommDef would refuse at run time.
#pragma once

#include "compiler/sema/context.hpp"

namespace ipos::compiler {

// After all bodies are checked.
void check_sbus_objects(Context& context);

}  // namespace ipos::compiler
