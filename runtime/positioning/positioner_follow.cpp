// Following a master (ISYNC): coupling on the positioning ramp, with or without catching up, then its path increment by increment.
#include "runtime/positioning/positioner.hpp"

namespace ipos::runtime {

// Whether the master moves the axis in this millisecond.
bool Positioner::follow_master() {
  const MasterInputs& master = inputs_.master;
  if (!master.follow) follow_refused_ = false;
  if (master.follow && !follow_refused_ && follower_.known() && !reference_.active()) {
    if (follow_state_ == FollowState::Free) {
      follow_state_ = FollowState::Coupling;
      follow_lost_ = 0;
    }
    couple();
    return true;
  }
  if (follow_state_ == FollowState::Free) return false;
  if (master.follow && !follow_refused_) report(PositioningEvent::MasterLost);
  follow_state_ = FollowState::Free;
  if (!reference_.active()) brake_here();
  return false;
}

// P911 up to the speed of the master, and with `catch_up` beyond it, so that the axis arrives at the place of the master and
// at its speed on the same ramp. The way to go in this millisecond, and the speed at its end.
Fine Positioner::approach(Rate& speed) {
  constexpr Rate kFiner = Rate{1} << (kRateBits - kFineBits);
  const Rate now = profile_.speed();
  const Rate change = std::max<Rate>(1, rules_.reference / rules_.up_ms);
  const bool catches_up = inputs_.master.catch_up;
  Rate wanted = speed;
  if (catches_up) {
    const Rate top = rate_of_speed(std::max(settings_.maximum_speed, 0), factor_);
    wanted = std::clamp(speed + sign(follow_lost_) * root(Wide{2} * change * magnitude(follow_lost_) * kFiner), -top, top);
  }
  // The path of the master is as fine as its telegrams; a few steps of the ramp are less.
  constexpr Rate kSteps = 4;
  const bool arrives = !catches_up || magnitude(follow_lost_) * kFiner <= kSteps * change;
  if (arrives && magnitude(speed - now) <= (catches_up ? kSteps : 1) * change) {
    follow_state_ = FollowState::Synchronous;
    return follower_.step() + (catches_up ? follow_lost_ : 0);
  }
  speed = now + std::clamp(wanted - now, -change, change);
  const Fine step = (now + speed) / (2 * kFiner);
  follow_lost_ += follower_.step() - step;
  return step;
}

// In step every increment of the master counts.
void Positioner::couple() {
  // More than twice what P302 allows; a ramp from more has no room in the numbers of a profile.
  const Rate top = 4 * rules_.reference;
  Rate speed = std::clamp(follower_.step() * (Rate{1} << (kRateBits - kFineBits)), -top, top);
  const Fine step = follow_state_ == FollowState::Coupling ? approach(speed) : follower_.step();
  profile_.hold(profile_.position() + step, speed);
  planned_target_.reset();
  target_ = setpoint();
  ordered_target_.reset();
  target_follows_ = false;
  watch_limit_switches();
  if (!target_allowed()) report(PositioningEvent::FollowedBeyondLimit);
  if (!target_allowed() || given_up_) {
    follow_refused_ = true;
    follow_state_ = FollowState::Free;
    brake_here();
  }
}

}  // namespace ipos::runtime
