// The one source of pseudo-random numbers of the simulation: SplitMix64 (Steele, Lea, Flood 2014), its seed
// an argument. Each part that needs chance owns a generator, so that no two parts disturb each other's numbers.
#pragma once

#include <cstdint>

namespace ipos::runtime {

class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t next() {
    uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  // 0 .. limit - 1, limit > 0. The bias of at most limit / 2^32 does not matter here.
  uint32_t below(uint32_t limit) { return static_cast<uint32_t>(((next() >> 32) * limit) >> 32); }

 private:
  uint64_t state_;
};

}  // namespace ipos::runtime
