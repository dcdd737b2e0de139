// Builds without the fast engine: whatever there is to execute is left to the reference interpreter. For the fuzz
// targets, as clang takes minutes for the engine with sanitizers; tests/engines show that it does the same.
#include "vm/fast/engine.hpp"

namespace ipos::vm::fast {

const void* handler_base() { return nullptr; }
uint16_t handler_of(Operation operation, const void*) { return static_cast<uint16_t>(operation); }
uint32_t run(const Predecoded&, TaskContext&, int32_t*, uint32_t budget, const Native*) { return budget; }

}  // namespace ipos::vm::fast
