// How the speed changes within a ramp: P916 (1053 1610 p. 82). The manuals at hand name the types only; ours:
// all three take the same time and the same distance, and are symmetric about their middle.
//
//   linear   constant acceleration
//   sine     the speed follows half a cosine, greatest acceleration pi/2 times the linear one
//   squared  the speed follows two parabolas, greatest acceleration twice the linear one
#pragma once

#include <cstdint>

namespace ipos::runtime {

enum class RampShape : uint8_t { Linear = 0, Sine = 1, Squared = 2 };

// Shares with 30 binary places.
inline constexpr int kShareBits = 30;
inline constexpr int64_t kWholeShare = int64_t{1} << kShareBits;

// At a share of the ramp time: the share of the change of speed already made, 0..1.
int64_t curved_speed_share(RampShape shape, int64_t time);
inline int64_t speed_share(RampShape shape, int64_t time) {
  return shape == RampShape::Linear ? time : curved_speed_share(shape, time);
}
// And its integral over the time, 0..1/2.
int64_t curved_distance_share(RampShape shape, int64_t time);
inline int64_t linear_distance_share(int64_t time) { return (time * time) >> (kShareBits + 1); }
inline int64_t distance_share(RampShape shape, int64_t time) {
  return shape == RampShape::Linear ? linear_distance_share(time) : curved_distance_share(shape, time);
}

// How much harder than on average a ramp of this shape may brake, in halves: a curved ramp that is taken up
// again in its steepest part still ends where it would have ended (docs/inside/positioning.md).
constexpr int64_t hardness_halves(RampShape shape) {
  return shape == RampShape::Squared ? 4 : shape == RampShape::Sine ? 3 : 2;
}

}  // namespace ipos::runtime
