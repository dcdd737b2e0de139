// Stands in place of the library's new and delete.
#include "tests/harness/allocations.hpp"

#include <cstdlib>
#include <new>

namespace {
std::size_t taken = 0;
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++taken;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  std::abort();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

std::size_t ipos::tests::allocations() {
  return taken;
}
