// Signals. Calls of the system that a command makes go on after one.
#include "tools/cli/interrupt.hpp"

#include <csignal>

namespace ipos::tools {
namespace {

void on_signal(int) { note_interrupt(); }

void catch_signal(int number) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(number, &action, nullptr);
}

}  // namespace

void catch_interrupts() {
  catch_signal(SIGINT);
  catch_signal(SIGTERM);
}

void catch_ctrl_c() { catch_signal(SIGINT); }

}  // namespace ipos::tools
