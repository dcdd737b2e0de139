// The shapes in integers; the sine by its series.
#include "runtime/positioning/ramp_shape.hpp"

#include <initializer_list>
#include <numbers>

namespace ipos::runtime {
namespace {

constexpr int64_t kHalf = kWholeShare / 2;
constexpr auto kPi = static_cast<int64_t>(std::numbers::pi * kWholeShare);

constexpr int64_t times(int64_t a, int64_t b) { return (a * b) >> kShareBits; }

// sin(pi x) for 0 <= x <= 1/2; the first term left out is below the last binary place.
int64_t sine(int64_t x) {
  const int64_t angle = times(kPi, x);
  const int64_t square = times(angle, angle);
  int64_t series = kWholeShare;
  for (const int64_t k : {13 * 12, 11 * 10, 9 * 8, 7 * 6, 5 * 4, 3 * 2})
    series = kWholeShare - times(square, series) / k;
  return times(angle, series);
}

// The first half of each shape; the second mirrors it.
int64_t early_speed(RampShape shape, int64_t time) {
  if (shape == RampShape::Squared) return 2 * times(time, time);
  return (kWholeShare - sine(kHalf - time)) / 2;  // 1 - cos(pi t)
}

int64_t early_distance(RampShape shape, int64_t time) {
  if (shape == RampShape::Squared) return 2 * times(times(time, time), time) / 3;
  return time / 2 - (sine(time) << kShareBits) / (2 * kPi);
}

}  // namespace

int64_t curved_speed_share(RampShape shape, int64_t time) {
  return time <= kHalf ? early_speed(shape, time) : kWholeShare - early_speed(shape, kWholeShare - time);
}

int64_t curved_distance_share(RampShape shape, int64_t time) {
  return time <= kHalf ? early_distance(shape, time)
                       : time - kHalf + early_distance(shape, kWholeShare - time);
}

}  // namespace ipos::runtime
