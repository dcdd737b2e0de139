// Division by a constant as a multiplication with 2^power / divisor, rounded up, where 2^(power - 32) is the
// power of 2 not below half of the divisor: below 2^32, and exact for all 32-bit dividends (Granlund and
// Montgomery, 1994). The quotient is (dividend * factor) >> power, toward zero one more for what is negative.
#pragma once

#include <bit>
#include <cstdint>

namespace ipos::vm::jit {

struct Reciprocal {
  explicit constexpr Reciprocal(uint32_t divisor)  // 2 and above
      : power(31 + static_cast<int>(std::bit_width(divisor - 1))),
        factor(static_cast<uint32_t>((uint64_t{1} << power) / divisor + 1)) {}

  int power;
  uint32_t factor;
};

}  // namespace ipos::vm::jit
