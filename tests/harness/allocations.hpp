// How many pieces of memory a program has taken from the heap: a test or bench that is linked with allocations.cpp counts
// them, those of the product included. One thread.
#pragma once

#include <cstddef>

namespace ipos::tests {

std::size_t allocations();

}  // namespace ipos::tests
