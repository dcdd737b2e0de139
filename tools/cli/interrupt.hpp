// Ctrl-C and SIGTERM as a question: verbs that go on until then ask it in their loop, and end in good order.
#pragma once

namespace ipos::tools {

void catch_interrupts();
bool interrupted();

}  // namespace ipos::tools
