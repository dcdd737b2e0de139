// PCG32 (O'Neill, XSH-RR 64/32): the same seed gives the same programs with any compiler and library, which
// <random> does not promise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ipos::tests {

class Pcg {
 public:
  explicit Pcg(uint64_t seed) {
    next();
    state_ += seed;
    next();
  }

  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005U + 1442695040888963407U;
    const auto shifted = static_cast<uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
  }

  // 0 .. limit - 1. The slight bias of the remainder does not matter here.
  int below(int limit) { return static_cast<int>(next() % static_cast<uint32_t>(limit)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  bool one_in(int count) { return below(count) == 0; }

  template <typename T>
  const T& pick(const std::vector<T>& items) {
    return items[static_cast<size_t>(below(static_cast<int>(items.size())))];
  }

 private:
  uint64_t state_ = 0;
};

}  // namespace ipos::tests
