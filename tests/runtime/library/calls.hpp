// Sequences of calls of ipos_plant.h, right and wrong ones, made of bytes: for tests with random numbers and for a fuzzer.
// Memory may be made to fail from an allocation on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ipos::tests {

// Allocations of this thread that still succeed; negative: all do. What is counted are those of C++.
void fail_allocations_after(int64_t count);
int64_t live_allocations();

// Opens a plant and does what the bytes say with it. `what` is null unless a promise of the header was broken.
struct Outcome {
  const char* broken = nullptr;
  size_t calls = 0;
};
Outcome play_calls(std::span<const uint8_t> bytes);

}  // namespace ipos::tests
