// Following a master (ISYNC): coupling on the positioning ramp, then its path increment by increment.
#include "runtime/positioning/positioner.hpp"

namespace ipos::runtime {

// Whether the master moves the axis in this millisecond.
bool Positioner::follow_master() {
  const MasterInputs& master = inputs_.master;
  if (!master.follow) follow_refused_ = false;
  if (master.follow && !follow_refused_ && follower_.known() && !reference_.active()) {
    if (follow_state_ == FollowState::Free) follow_state_ = FollowState::Coupling;
    couple();
    return true;
  }
  if (follow_state_ == FollowState::Free) return false;
  if (master.follow && !follow_refused_) report(PositioningEvent::MasterLost);
  follow_state_ = FollowState::Free;
  if (!reference_.active()) brake_here();
  return false;
}

// P911 up to the speed of the master; the way lost meanwhile stays lost. From then on every increment counts.
void Positioner::couple() {
  // More than twice what P302 allows; a ramp from more has no room in the numbers of a profile.
  const Rate top = 4 * rules_.reference;
  const Rate wanted = std::clamp(follower_.step() * (Rate{1} << (kRateBits - kFineBits)), -top, top);
  const Rate now = profile_.speed();
  const Rate change = std::max<Rate>(1, rules_.reference / rules_.up_ms);
  Rate next = wanted;
  Fine step = follower_.step();
  if (follow_state_ == FollowState::Coupling) {
    if (magnitude(wanted - now) <= change) {
      follow_state_ = FollowState::Synchronous;
    } else {
      next = now + sign(wanted - now) * change;
      step = (now + next) / (Rate{2} << (kRateBits - kFineBits));
    }
  }
  profile_.hold(profile_.position() + step, next);
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
