// The flag that a handler sets. The threads of a suite of tests ask for it, too, so it is atomic; a handler may set it as it
// takes no lock.
#include "tools/cli/interrupt.hpp"

#include <atomic>

namespace ipos::tools {
namespace {

std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

bool interrupted() { return signalled; }
void forget_interrupt() { signalled = false; }
void note_interrupt() { signalled = true; }

}  // namespace ipos::tools
