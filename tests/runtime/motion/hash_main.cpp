// Prints the hashes of a few runs; built once without and once with optimization.
#include <cinttypes>
#include <cstdio>

#include "tests/runtime/motion/order_mix.hpp"

int main() {
  using namespace ipos::tests;
  for (uint64_t seed = 1; seed <= 3; ++seed)
    for (const Taste taste : {Taste::Plausible, Taste::Any, Taste::Detailed})
      std::printf("%016" PRIx64 "\n", hash_of_run(seed, 100'000, taste));
}
