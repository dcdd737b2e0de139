// Speeds inside the motion layer: 1/1000 rpm with 32 binary places, so that a ramp of 2000 s still moves by
// exact steps and the position is the integral of what was really driven. Amounts end at 100000 rpm (ours):
// far above any motor, and low enough that no sum below overflows.
#pragma once

#include <algorithm>
#include <cstdint>

namespace ipos::runtime {

using FineSpeed = int64_t;

inline constexpr int kFineSpeedBits = 32;
inline constexpr int64_t kFine = int64_t{1} << kFineSpeedBits;  // one 1/1000 rpm
inline constexpr int32_t kTopSpeed = 100'000'000;               // 1/1000 rpm
inline constexpr FineSpeed kTopFine = kTopSpeed * kFine;

constexpr FineSpeed fine_speed(int32_t mrpm) { return std::clamp(mrpm, -kTopSpeed, kTopSpeed) * kFine; }

// Rounded to the nearest 1/1000 rpm, halves away from zero: both directions read alike. Below zero the shift,
// which rounds down, has to pass one half less.
constexpr int32_t whole_speed(FineSpeed speed) {
  return static_cast<int32_t>((speed + kFine / 2 - (speed < 0 ? 1 : 0)) >> kFineSpeedBits);
}

// Of a speed in the same unit with a point, toward zero.
constexpr FineSpeed fine_of(double speed) {
  constexpr auto kTop = static_cast<double>(kTopFine);
  return static_cast<FineSpeed>(std::clamp(speed, -kTop, kTop));
}

constexpr int sign_of(int64_t value) { return value < 0 ? -1 : value > 0 ? 1 : 0; }

}  // namespace ipos::runtime
