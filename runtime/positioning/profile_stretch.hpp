// The milliseconds of a profile within one phase of constant or evenly changing speed: Profile::tick() for each of them, of
// what stays the same in all. The places of a phase follow from its beginning, so no rounding adds up.
#pragma once

#include <algorithm>

#include "runtime/part/part.hpp"
#include "runtime/positioning/profile.hpp"

namespace ipos::runtime {

// With 34 bits, 16 s, the product below has 64.
inline int64_t Profile::share_in(const Phase& phase, Span time) {
  if (phase.duration < Span{1} << (64 - kShareBits))
    return static_cast<int64_t>((static_cast<uint64_t>(time) << kShareBits) /
                                static_cast<uint64_t>(phase.duration));
  return share_in_long(phase.duration, time);
}

inline Fine Profile::way_in(const Phase& phase, Span time, int64_t distance_share) {
  const Wide change = Wide{phase.to - phase.from} * phase.duration * distance_share;
  return static_cast<Fine>((Wide{phase.from} * time + (change >> kShareBits)) >> kRateBits);
}

class Profile::Stretch {
 public:
  struct Place {
    Span elapsed;
    Fine position;
    Rate speed;
  };

  // It is within such a phase.
  static bool possible(const Profile& profile) {
    return profile.phases_ != 0 && profile.entered_ && profile.plan_[profile.phase_].shape == RampShape::Linear;
  }

  [[gnu::always_inline]] explicit Stretch(Profile& profile)
      : profile_(profile),
        phase_(profile.plan_[profile.phase_]),
        origin_(profile.origin_),
        goal_(profile.goal_),
        way_(profile.ends_at_goal() ? sign(phase_.from + phase_.to) : 0) {}

  // How many milliseconds are left of it, at most so many.
  [[gnu::always_inline]] Ticks left(Ticks most) const {
    const Span left = phase_.duration - 1 - profile_.elapsed_;
    return left <= 0 ? 0 : static_cast<Ticks>(std::min<Span>(left / kMs, most));
  }
  // Where it is in the next millisecond.
  [[gnu::always_inline]] Place next() const {
    const Span elapsed = profile_.elapsed_ + kMs;
    const int64_t share = phase_.from == phase_.to ? 0 : share_in(phase_, elapsed);
    const Fine position = origin_ + way_in(phase_, elapsed, linear_distance_share(share));
    return {elapsed, way_ * (position - goal_) > 0 ? goal_ : position, speed_in(phase_, share)};
  }
  [[gnu::always_inline]] void go(const Place& place) {
    profile_.elapsed_ = place.elapsed;
    profile_.position_ = place.position;
    profile_.speed_ = place.speed;
  }

 private:
  Profile& profile_;
  Phase phase_;
  Fine origin_;
  Fine goal_;
  int way_;  // towards the goal, if it may not be passed
};

}  // namespace ipos::runtime
