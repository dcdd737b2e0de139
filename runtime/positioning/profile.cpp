// Planning and reading out. All ramps, whatever their shape, run at their mean speed on average: time and
// distance of a plan are those of the linear one.
#include "runtime/positioning/profile_stretch.hpp"

#include <cassert>

namespace ipos::runtime {
namespace {

constexpr Span clamp_span(Wide span) { return span > kForever - 1 ? kForever - 1 : static_cast<Span>(span); }

Span ramp_time(Rate change, int32_t ms, const TravelRules& rules) {
  return static_cast<Span>(Wide{change} * ms * kMs / rules.reference);
}

// Covered by a ramp between rest and `speed`.
Fine ramp_way(Rate speed, int32_t ms, const TravelRules& rules) {
  return static_cast<Fine>((Wide{speed} * speed * ms / rules.reference) >> (kRateBits - kFineBits + 1));
}

// Time for a way at a speed.
Span time_for(Fine way, Rate speed) { return clamp_span((Wide{way} << kRateBits) / speed); }

// Greatest speed of a travel over `way` that begins with `speed` and ends at rest.
Rate peak_speed(Fine way, Rate speed, const TravelRules& rules) {
  const Wide square =
      ((Wide{rules.reference} * way) << (1 + kRateBits - kFineBits)) + Wide{speed} * speed * rules.up_ms;
  return root(square / (rules.up_ms + rules.down_ms));
}

// The ramp, within rounding, or a harder one where the shape is steep anyway, stops within `way`.
bool stops_within(Fine way, Fine brake, RampShape shape) {
  return 2 * brake <= way * hardness_halves(shape) + brake / 512 + kIncrement / 1024;
}

}  // namespace

void Profile::begin() {
  begin_ = position_;
  elapsed_ = 0;
  phase_ = 0;
  entered_ = false;
  phases_ = 0;
  arrives_ = turns_ = false;
}

void Profile::add(Rate from, Rate to, Span duration, RampShape shape) {
  assert(phases_ < plan_.size() && duration >= 0);
  plan_[phases_++] = {from, to, duration, shape};
}

void Profile::hold(Fine position, Rate speed) {
  position_ = position;
  speed_ = speed;
  begin();
}

void Profile::brake_to(Fine goal, RampShape shape) {
  goal_ = goal;
  arrives_ = true;
  add(speed_, 0, time_for(2 * magnitude(goal - position_), magnitude(speed_)), shape);
}

void Profile::travel(int64_t target, const TravelRules& rules, Goal kind) {
  begin();
  const Fine goal = fine(target);
  Fine from = position_;
  Rate speed = speed_;
  if (speed != 0) {
    const int way = sign(speed);
    const Fine ahead = way * (goal - from);
    const Fine brake = ramp_way(magnitude(speed), rules.down_ms, rules);
    if (ahead >= 0 && brake >= ahead && (kind == Goal::Kept || stops_within(ahead, brake, rules.shape)))
      return brake_to(goal, rules.shape);
    if (brake >= ahead) {
      add(speed, 0, ramp_time(magnitude(speed), rules.down_ms, rules), rules.shape);
      turns_ = true;
      from += way * brake;
      speed = 0;
    }
  }
  goal_ = goal;
  const int way = sign(goal - from);
  const Fine distance = magnitude(goal - from);
  const Rate cap = way > 0 ? rules.cw : rules.ccw;
  const Rate now = magnitude(speed);
  const Rate top = std::min(cap, peak_speed(distance, now, rules));
  if (top <= 0) {
    // Not to be moved: at the target already, or a travel speed of 0.
    if (now != 0) add(speed, 0, ramp_time(now, rules.down_ms, rules), rules.shape);
    arrives_ = distance < kIncrement / 2 && cap > 0;
    if (phases_ == 0 && arrives_) position_ = goal;
    return;
  }
  const int32_t ms = top >= now ? rules.up_ms : rules.down_ms;
  const Fine change = magnitude(ramp_way(top, ms, rules) - ramp_way(now, ms, rules));
  const Fine brake = ramp_way(top, rules.down_ms, rules);
  add(way * now, way * top, ramp_time(magnitude(top - now), ms, rules), rules.shape);
  add(way * top, way * top, time_for(std::max<Fine>(0, distance - change - brake), top), rules.shape);
  add(way * top, 0, ramp_time(top, rules.down_ms, rules), rules.shape);
  arrives_ = true;
}

void Profile::run(int way, const TravelRules& rules) {
  begin();
  const Rate top = way > 0 ? rules.cw : -rules.ccw;
  Rate now = speed_;
  if (now != 0 && sign(now) != way) {
    add(now, 0, ramp_time(magnitude(now), rules.down_ms, rules), rules.shape);
    now = 0;
  }
  const bool up = magnitude(top) >= magnitude(now);
  add(now, top, ramp_time(magnitude(top - now), up ? rules.up_ms : rules.down_ms, rules), rules.shape);
  add(top, top, kForever, rules.shape);
}

void Profile::stop(const TravelRules& rules) {
  const int64_t end = stop_position(rules);
  if (speed_ == 0) return travel(end, rules, Goal::New);
  begin();
  brake_to(fine(end), rules.shape);
}

int64_t Profile::stop_position(const TravelRules& rules) const {
  const Fine way = ramp_way(magnitude(speed_), rules.down_ms, rules);
  if (speed_ < 0) return floor_whole(position_ - way);
  if (speed_ > 0) return -floor_whole(-(position_ + way));
  return whole(position_);
}

bool Profile::overruns(int64_t target, const TravelRules& rules) const {
  const Fine ahead = sign(speed_) * (fine(target) - position_);
  const Fine brake = ramp_way(magnitude(speed_), rules.down_ms, rules);
  return speed_ != 0 && ahead >= 0 && !stops_within(ahead, brake, rules.shape);
}

// What an earlier plan has left behind is no position.
void Profile::shift(int64_t increments) {
  const Fine change = fine(increments);
  position_ += change;
  begin_ += change;
  if (entered_) origin_ += change;
  if (arrives_) goal_ += change;
}

int64_t Profile::share_in_long(Span duration, Span time) {
  return static_cast<int64_t>((Wide{time} << kShareBits) / duration);
}

// What is the same in all its milliseconds. The last phase is counted from its end, so that it ends exactly
// there.
void Profile::enter_phase() {
  const Phase& phase = plan_[phase_];
  way_ = phase.duration == 0 ? 0 : way_in(phase, phase.duration, distance_share(phase.shape, kWholeShare));
  origin_ = at_last_phase() ? goal_ - way_ : begin_;
  entered_ = true;
}

// False: there is none left.
bool Profile::next_phase() {
  while (elapsed_ >= plan_[phase_].duration) {
    elapsed_ -= plan_[phase_].duration;
    begin_ += way_;
    if (++phase_ == phases_) {
      arrive();
      return false;
    }
    enter_phase();
  }
  return true;
}

void Profile::tick() {
  if (phases_ == 0) return;
  if (!entered_) enter_phase();
  elapsed_ += kMs;
  if (elapsed_ >= plan_[phase_].duration && !next_phase()) return;
  const Phase& phase = plan_[phase_];
  const int64_t share = phase.from == phase.to ? 0 : share_in(phase, elapsed_);
  if (phase.shape == RampShape::Linear)
    read_out(phase, share, linear_distance_share(share));
  else
    read_out_curve(phase, share);
}

void Profile::read_out_curve(const Phase& phase, int64_t share) {
  read_out(phase, curved_speed_share(phase.shape, share), curved_distance_share(phase.shape, share));
}

[[gnu::always_inline]] inline void Profile::read_out(const Phase& phase, int64_t speed_share,
                                                     int64_t distance_share) {
  position_ = origin_ + way_in(phase, elapsed_, distance_share);
  speed_ = speed_in(phase, speed_share);
  const int way = sign(phase.from + phase.to);
  if (ends_at_goal() && way * (position_ - goal_) > 0) position_ = goal_;
}

void Profile::arrive() {
  position_ = arrives_ ? goal_ : begin_;
  speed_ = 0;
  phases_ = 0;
}

}  // namespace ipos::runtime
