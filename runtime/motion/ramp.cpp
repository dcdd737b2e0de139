// Ramp steps with remainders.
#include "runtime/motion/ramp.hpp"

#include <bit>
#include <cstdlib>

namespace ipos::runtime {
namespace {

constexpr uint32_t kLongestMs = 2'000'000;    // upper end of P130..P134
constexpr int32_t kLongestRounding = 16'000;  // ms; keeps the products below within 64 bits

constexpr uint64_t kWholeMs = uint64_t{1} << 32;

// Shift after which a positive value has 31 bits, enough for 1e-9 of relative error.
int shift_of(int64_t value) {
  return std::max(0, static_cast<int>(std::bit_width(static_cast<uint64_t>(value))) - 31);
}

// part / whole in units of 2^-32, for 0 <= part <= whole.
uint64_t fraction(int64_t part, int64_t whole) {
  const int shift = shift_of(whole);
  return (static_cast<uint64_t>(part >> shift) << 32) / static_cast<uint64_t>(whole >> shift);
}

// value x share / 2^32, for 0 <= share <= 2^32.
int64_t portion(int64_t value, uint64_t share) {
  const int shift = shift_of(value);
  return static_cast<int64_t>((static_cast<uint64_t>(value >> shift) * share) >> 32) << shift;
}

// Speed gained while the level falls from `level` to 0, in units of one level's step.
constexpr int64_t triangle(int64_t level) { return level * (level + 1) / 2; }

}  // namespace

void Ramp::go_on(FineSpeed target, const RampTimes& times) {
  if (times.s_pattern == 0) return step_linear(target, times);
  constexpr int32_t kShare[] = {8, 4, 2};
  const uint32_t ms = std::min(times.up_cw_ms, kLongestMs);
  const int32_t share = kShare[std::min<int>(times.s_pattern, 3) - 1];
  step_s_pattern(target, {ms, std::clamp(static_cast<int32_t>(ms) / share, 1, kLongestRounding)});
}

// level x reference / divisor for this millisecond; what cannot be divided is kept for the next ones.
int64_t Ramp::exact(int64_t divisor, int64_t level) {
  if (divisor != divisor_) {
    divisor_ = divisor;
    whole_ = reference_ * kFine / divisor;
    part_ = reference_ * kFine % divisor;
    rest_ = 0;
  }
  rest_ += part_ * level;
  if (rest_ < divisor) return whole_ * level;
  const int64_t carry = rest_ / divisor;
  rest_ %= divisor;
  return whole_ * level + carry;
}

void Ramp::step_linear(FineSpeed target, const RampTimes& times) {
  level_ = 0;
  for (uint64_t left = kWholeMs; left != 0 && output_ != target;) {
    const bool cw = output_ > 0 || (output_ == 0 && target > 0);
    const FineSpeed goal = cw ? std::max<FineSpeed>(target, 0) : std::min<FineSpeed>(target, 0);
    const bool up = std::abs(goal) > std::abs(output_);
    left =
        leg(goal, cw ? (up ? times.up_cw_ms : times.down_cw_ms) : (up ? times.up_ccw_ms : times.down_ccw_ms),
            left);
  }
}

// Moves towards the goal within `left` of a millisecond (2^-32 ms); returns how much of it is left.
uint64_t Ramp::leg(FineSpeed goal, uint32_t ms, uint64_t left) {
  if (ms == 0) {
    output_ = goal;
    return left;
  }
  const int64_t whole = exact(std::min(ms, kLongestMs), 1);
  const int64_t step = left == kWholeMs ? whole : portion(whole, left);
  const int64_t distance = std::abs(goal - output_);
  // The share of a split millisecond is rounded: what it may lack counts as arrived.
  if (distance > step + (whole >> 24)) {
    output_ += goal > output_ ? step : -step;
    return 0;
  }
  output_ = goal;
  return left - std::min(left, fraction(distance, whole));
}

void Ramp::step_s_pattern(FineSpeed target, Slope slope) {
  if (slope.ms == 0) return set(target);
  const int64_t divisor = int64_t{slope.ms} * slope.levels;
  if (!(slope == slope_)) {
    // Another time or pattern goes on with the slope there is, as far as its own steepest allows.
    const int64_t old_divisor = std::max<int64_t>(1, int64_t{slope_.ms} * slope_.levels);
    level_ = static_cast<int32_t>(
        std::clamp<int64_t>(level_ * divisor / old_divisor, -slope.levels, slope.levels));
    slope_ = slope;
  }
  const int towards = target < output_ ? -1 : 1;
  const int64_t error = std::abs(target - output_);
  const int64_t whole = reference_ * kFine / divisor, part = reference_ * kFine % divisor;
  if (error <= whole && std::abs(level_) <= 1) return set(target);

  // The steepest of the three slopes in reach that can still be built down before the target.
  const auto too_steep = [&](int64_t level) {
    return level > 0 && triangle(level) * whole + triangle(level) * part / divisor > error;
  };
  const int32_t now = towards * level_;
  int32_t next = std::min(now + 1, slope.levels);
  while (next >= now && too_steep(next)) --next;
  level_ = towards * next;
  const int64_t step = exact(divisor, std::abs(level_));
  output_ = std::clamp(output_ + sign_of(level_) * step, -kTopFine, kTopFine);
}

}  // namespace ipos::runtime
