// Ctrl-C and SIGTERM as a question: verbs that go on until then ask it in their loop, and end in good order. posix, windows
// and web have what catches them.
#pragma once

namespace ipos::tools {

void catch_interrupts();
// Ctrl-C alone, which may come again.
void catch_ctrl_c();
bool interrupted();
void forget_interrupt();

// For what catches them; it takes no lock.
void note_interrupt();

}  // namespace ipos::tools
