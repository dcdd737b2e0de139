// Events of the console, which come on a thread of their own.
#include "tools/cli/interrupt.hpp"

#include <windows.h>

namespace ipos::tools {
namespace {

// A console that is closed and a session that ends take the process with them as soon as this returns, and after some
// seconds anyway.
constexpr DWORD kTimeToEnd = 10'000;

BOOL WINAPI on_event(DWORD event) {
  note_interrupt();
  if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT) Sleep(kTimeToEnd);
  return TRUE;
}

BOOL WINAPI on_ctrl_c(DWORD event) {
  if (event != CTRL_C_EVENT) return FALSE;
  note_interrupt();
  return TRUE;
}

}  // namespace

void catch_interrupts() { SetConsoleCtrlHandler(on_event, TRUE); }

void catch_ctrl_c() { SetConsoleCtrlHandler(on_ctrl_c, TRUE); }

}  // namespace ipos::tools
