// The law of parts (runtime/part/part.hpp), tried on one of them with a random history.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "runtime/part/part.hpp"

namespace ipos::tests {

// Of each of four seeds, together a million ticks; IPOS_LAW_STEPS is another number. A build without optimizer
// makes fewer.
inline uint32_t law_steps() {
#ifdef __OPTIMIZE__
  constexpr uint32_t kUsual = 1'000'000;
#else
  constexpr uint32_t kUsual = 200'000;
#endif
  const char* wanted = std::getenv("IPOS_LAW_STEPS");
  return std::max(wanted == nullptr ? kUsual : static_cast<uint32_t>(std::strtoul(wanted, nullptr, 10)),
                  100'000U) /
         4;
}

// `change` does to the part what others may, `tick` is its millisecond. What ticks have in common stays as it
// is between two changes.
template <runtime::Part P, class Change, class Tick>
void expect_law(P part, uint64_t seed, uint32_t steps, Change change, Tick tick) {
  std::mt19937_64 random(seed);
  uint64_t held = 0;
  for (uint32_t step = 0; step < steps;) {
    change(part, random);
    for (auto ticks = static_cast<uint32_t>(random() % 400); ticks != 0 && step < steps; --ticks, ++step) {
      const P before = part;
      tick(part);
      const runtime::Ticks bound = runtime::steady_ticks(before, part);
      if (bound == 0 || random() % 16 != 0) continue;
      const runtime::Ticks count = std::min(bound, static_cast<runtime::Ticks>(1 + random() % 300));
      P ahead = part;
      ahead.advance(count);
      for (runtime::Ticks n = 0; n < count; ++n) tick(part);
      step += count;
      held += count;
      ASSERT_TRUE(part == ahead) << "seed " << seed << ", " << count << " of " << bound << " ticks behind "
                                 << step;
    }
  }
  EXPECT_GT(held, steps / 20) << "ticks that were compared, seed " << seed;
}

}  // namespace ipos::tests
