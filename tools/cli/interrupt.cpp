// The signal handlers, and the flag they set. The threads of a suite of tests ask for it, too, so it is
// atomic; a handler may set it as it takes no lock.
#include "tools/cli/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace ipos::tools {
namespace {

std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free);
void on_signal(int) { signalled = true; }

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return signalled; }

}  // namespace ipos::tools
