// The arithmetic of the IPOS commands: 32-bit two's complement with wrap-around (IPOSplus p. 28), computed on
// unsigned numbers so that nothing is undefined. Division toward zero, shift counts modulo 32: ours, see
// docs/guide/language.md.
#pragma once

#include <cstdint>

namespace ipos::vm {

constexpr uint32_t bits(int32_t value) { return static_cast<uint32_t>(value); }
constexpr int32_t wrap(uint32_t value) { return static_cast<int32_t>(value); }

constexpr int32_t add(int32_t a, int32_t b) { return wrap(bits(a) + bits(b)); }
constexpr int32_t subtract(int32_t a, int32_t b) { return wrap(bits(a) - bits(b)); }
constexpr int32_t multiply(int32_t a, int32_t b) { return wrap(bits(a) * bits(b)); }
constexpr int32_t shift_left(int32_t a, int32_t count) { return wrap(bits(a) << (bits(count) & 31U)); }
constexpr int32_t shift_right(int32_t a, int32_t count) { return wrap(bits(a) >> (bits(count) & 31U)); }
constexpr int32_t shift_right_sign(int32_t a, int32_t count) { return a >> (bits(count) & 31U); }

// The divisor must not be 0. INT_MIN / -1 wraps to INT_MIN, its remainder is 0.
constexpr int32_t divide(int32_t a, int32_t b) { return b == -1 ? wrap(0U - bits(a)) : a / b; }
constexpr int32_t remainder(int32_t a, int32_t b) { return b == -1 ? 0 : a % b; }

constexpr int32_t set_bit(int32_t value, int32_t bit, bool on) {
  const uint32_t at = bits(bit) & 31U;
  return wrap((bits(value) & ~(1U << at)) | uint32_t{on} << at);
}
constexpr bool test_bit(int32_t value, int32_t bit) { return (bits(value) >> (bits(bit) & 31U) & 1U) != 0; }

}  // namespace ipos::vm
