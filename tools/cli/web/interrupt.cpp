// A worker of a browser is ended; nothing interrupts it.
#include "tools/cli/interrupt.hpp"

namespace ipos::tools {

void catch_interrupts() {}
void catch_ctrl_c() {}

}  // namespace ipos::tools
