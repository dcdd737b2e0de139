// Numbers of the positioning layer: positions in increments with 20 binary places, speeds in increments a
// millisecond with 28, times in milliseconds with 20. Every product of three of them fits into 128 bits, and
// a travel over the whole 32-bit range keeps well below 1/1000 increment of rounding.
#pragma once

#include <algorithm>
#include <cstdint>

namespace ipos::runtime {

using Fine = int64_t;
using Rate = int64_t;
using Span = int64_t;
__extension__ using Wide = __int128;
__extension__ using WideAmount = unsigned __int128;

inline constexpr int kFineBits = 20;
inline constexpr int kRateBits = 28;
inline constexpr Fine kIncrement = Fine{1} << kFineBits;
inline constexpr Span kMs = Span{1} << 20;
inline constexpr Span kForever = INT64_MAX;

constexpr Fine fine(int64_t increments) { return increments * kIncrement; }
// The nearest whole increment, halves upward.
constexpr int64_t whole(Fine position) { return (position + kIncrement / 2) >> kFineBits; }
constexpr int64_t floor_whole(Fine position) { return position >> kFineBits; }
constexpr int32_t wrapped(int64_t position) { return static_cast<int32_t>(static_cast<uint32_t>(position)); }

constexpr int sign(int64_t value) { return value < 0 ? -1 : value > 0 ? 1 : 0; }
constexpr int64_t magnitude(int64_t value) { return value < 0 ? -value : value; }

constexpr int64_t floor_divide(int64_t value, int64_t by) {
  return value / by - (value % by != 0 && (value < 0) != (by < 0) ? 1 : 0);
}

// The whole square root.
constexpr Rate root(Wide value) {
  Rate result = 0;
  for (Rate bit = Rate{1} << 60; bit != 0; bit >>= 1)
    if (Wide{result + bit} * (result + bit) <= value) result += bit;
  return result;
}

// Increments of the motor encoder for those of the source of the actual position: P942 / P943.
struct EncoderFactor {
  int32_t numerator = 1;
  int32_t denominator = 1;
  bool operator==(const EncoderFactor&) const = default;
};

// 1/1000 rpm x 4096 / 60 000 000 is increments of the motor a millisecond.
constexpr Rate rate_of_speed(int64_t mrpm, EncoderFactor factor) {
  return static_cast<Rate>((Wide{mrpm} * 16 * factor.denominator << kRateBits) /
                           (Wide{234'375} * factor.numerator));
}
// Rounded to the nearest, halves away from 0. The unit is 2^32 x denominator: to divide by its parts one
// after the other gives the same whole number. With a numerator of 15 bits (P942) the amount has less than
// 96, so 64 are left for the second one. Both parts of the factor are above 0.
constexpr int64_t speed_of_rate(Rate rate, EncoderFactor factor) {
  static_assert(Wide{16} << kRateBits == Wide{1} << 32);
  const auto denominator = static_cast<uint64_t>(factor.denominator);
  const uint64_t amount = rate < 0 ? 0 - static_cast<uint64_t>(rate) : static_cast<uint64_t>(rate);
  const auto value = WideAmount{amount} * (uint64_t{234'375} * static_cast<uint64_t>(factor.numerator)) +
                     (denominator << 31);
  const auto speed = static_cast<int64_t>(static_cast<uint64_t>(value >> 32) / denominator);
  return rate < 0 ? -speed : speed;
}

// A way of the source as one of the motor, rounded towards 0.
constexpr int64_t motor_way(int64_t way, EncoderFactor factor) {
  return factor.numerator == factor.denominator ? way : way * factor.numerator / factor.denominator;
}

}  // namespace ipos::runtime
