// The counter of synchronous operation, free running and coming back, and the speed of the slave.
#include "runtime/positioning/synchronous.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

// P223 as it is coded: 0 is MODE 1.
enum Mode : int32_t {
  kNewReference = 0,       // 1: free running without end; where it ends is in step from then on
  kWorkedOff = 1,          // 2: the same, and what came of it is worked off
  kWorkedOffAndMore = 2,   // 3: the same, with P224 more
  kLimitedReference = 3,   // 4: as 1, free running ends after P224
  kLimitedWorkedOff = 4,   // 5: as 2, free running ends after P224
  kTemporaryOffset = 5,    // 6: P225..P227 while they are chosen
  kPermanentOffset = 6,    // 7: each choice adds
  kRepeatedOffset = 7,     // 8: the same, and a choice that stays adds again
};

// Of mode 8 (ours): a choice that has been there for this long adds again, in these intervals.
constexpr int32_t kHeldMs = 3'000, kRepeatMs = 250;
// P241 is the time of this change of speed (ours, as of all ramps of MOVIDRIVE).
constexpr int64_t kRampSpeed = 3'000'000;

// Of the precontrol, microseconds, beside P228 (ours).
constexpr int64_t kLeastFilter = 4'000;

constexpr Rate kUnit = Rate{1} << kRateBits;

bool is_limited(int32_t mode) { return mode == kLimitedReference || mode == kLimitedWorkedOff; }
bool has_offsets(int32_t mode) { return mode >= kTemporaryOffset; }

int32_t offset_of(const SynchronousSettings& settings, uint8_t offset) {
  switch (offset) {
    case 1: return settings.offset_1;
    case 2: return settings.offset_2;
    case 3: return settings.offset_3;
    default: return 0;
  }
}

Wide amount(Wide value) { return value < 0 ? -value : value; }

}  // namespace

// P221 and P222 are increments of master and slave for the same way (DRS11B manual p. 25, 30). With P230 the encoder that
// is compared turns P232 increments for P231 of the slave's motor.
SynchronousOperation::Scale::Scale(const SynchronousSettings& s) {
  const bool own = s.synchronous_encoder != 0;
  motor = own ? std::max(s.slave_factor, 1) : 1;
  encoder = own ? std::max(s.encoder_factor, 1) : 1;
  const Wide gear = std::max(static_cast<uint32_t>(s.master_gear), 1U);
  master = Wide{static_cast<uint32_t>(s.slave_gear)} * motor;
  slave = gear * encoder;
  increment = gear * motor;
}

Rate SynchronousOperation::Scale::motor_rate(Wide of_encoder) const {
  constexpr Wide kMost = Wide{1} << 58;  // far beyond any way of an axis
  return static_cast<Rate>(std::clamp(of_encoder * motor / encoder, -kMost, kMost));
}

// Other gears leave the slave as far behind as it is.
void SynchronousOperation::count(const SynchronousInputs& in, const Scale& scale) {
  if (!begun_) {
    master_ = in.master;
    slave_ = in.slave;
    begun_ = true;
  }
  if (increment_ != scale.increment) {
    counter_ = counter_ / increment_ * scale.increment + counter_ % increment_ * scale.increment / increment_;
    free_from_ = free_from_ / increment_ * scale.increment;
    increment_ = scale.increment;
  }
  step_ = wrapped(int64_t{in.master} - master_);
  counter_ += step_ * scale.master - wrapped(int64_t{in.slave} - slave_) * scale.slave;
  master_ = in.master;
  slave_ = in.slave;
}

void SynchronousOperation::take_offset(const SynchronousSettings& s, const SynchronousInputs& in, const Scale& scale) {
  const bool fresh = in.offset != offset_;
  offset_ms_ = fresh || in.offset == 0 ? 0 : offset_ms_ + 1;
  offset_ = in.offset;
  const bool repeats = s.mode == kRepeatedOffset && offset_ms_ >= kHeldMs && (offset_ms_ - kHeldMs) % kRepeatMs == 0;
  const bool adds = s.mode == kPermanentOffset || s.mode == kRepeatedOffset;
  if (adds && in.offset != 0 && (fresh || repeats)) counter_ += offset_of(s, in.offset) * scale.increment;
  if (has_offsets(s.mode) && fresh && state_ == State::Synchronous) state_ = State::CatchingUp;
}

void SynchronousOperation::take_edges(const SynchronousSettings& s, const SynchronousInputs& in, const Scale& scale) {
  if (in.zero_point && !zero_point_) counter_ = 0;
  if (teach_in_ && !in.teach_in) counter_ = 0;
  zero_point_ = in.zero_point;
  teach_in_ = in.teach_in;
  take_offset(s, in, scale);
}

void SynchronousOperation::end_free_run(const SynchronousSettings& s, const Scale& scale) {
  if (s.mode == kWorkedOff || s.mode == kLimitedWorkedOff) return;
  if (s.mode == kWorkedOffAndMore)
    counter_ += s.slave_counter * scale.increment;
  else
    counter_ = 0;
}

bool SynchronousOperation::runs_free(const SynchronousSettings& s, const SynchronousInputs& in, const Scale& scale) {
  if (in.free_run && !free_input_) {
    free_from_ = counter_;
    free_ended_ = false;
  }
  const bool was = free_input_ && !free_ended_;
  free_input_ = in.free_run;
  const bool limit_reached = is_limited(s.mode) && amount(counter_ - free_from_) >= amount(s.slave_counter * scale.increment);
  if (in.free_run && limit_reached) free_ended_ = true;
  const bool is = in.free_run && !free_ended_;
  if (was && !is) end_free_run(s, scale);
  return is || in.teach_in;
}

// P510 with P515, P511, and P512 with P513. A slave that comes back from elsewhere is not watched for lag (ours).
void SynchronousOperation::watch(const SynchronousSettings& s) {
  const int64_t behind = magnitude(difference());
  const bool coupled = state_ != State::FreeRunning;
  near_ms_ = coupled && behind <= s.tolerance ? std::min(near_ms_ + 1, s.in_position_delay + 1) : 0;
  in_position_ = near_ms_ > s.in_position_delay;
  prewarning_ = coupled && behind > s.prewarning;
  far_ms_ = state_ == State::Synchronous && behind > s.lag_limit ? std::min(far_ms_ + 1, s.lag_delay + 1) : 0;
  if (far_ms_ > s.lag_delay) lag_error_ = true;
}

// What the master turned in the last millisecond, in increments of the slave's motor; filtered with P228. Without the few
// milliseconds more the whole increments of a millisecond would be jumps of 15 rpm, which no motor follows.
Rate SynchronousOperation::precontrol(const SynchronousSettings& s, const Scale& scale) {
  constexpr int64_t kMillisecond = 1'000;
  const int64_t time = kLeastFilter + std::max(s.precontrol_filter, 0);
  const Rate now = scale.motor_rate(Wide{step_} * kUnit * scale.master / scale.increment);
  return precontrol_ + static_cast<Rate>(Wide{now - precontrol_} * kMillisecond / (kMillisecond + time));
}

// P220 (its unit is ours: with 1 a slave that is behind by n increments makes n increments a second up), while it catches up no more
// than P240, and so that it can brake on P241: as sqrt(2 a d) where the gain alone would need more.
Rate SynchronousOperation::correction(const SynchronousSettings& s, const Scale& scale) const {
  constexpr Wide kSecond = 1'000'000;  // of ms, and of 1/1000 of the gain
  const Wide gain = std::max(s.gain, 1);
  const Rate behind = scale.motor_rate(Wide{difference_} * (Wide{1} << (kRateBits - kFineBits)));
  const Wide by_gain = Wide{behind} * gain / kSecond;
  if (state_ != State::CatchingUp) return static_cast<Rate>(by_gain);
  Wide most = rate_of_speed(std::max(s.catch_up_speed, 0), {});
  if (s.catch_up_ramp > 0) {
    const Wide slope = rate_of_speed(kRampSpeed, {}) / s.catch_up_ramp;
    const Wide knee = slope * kSecond / gain;  // the speed from which the gain alone brakes with this slope
    if (amount(by_gain) > knee) most = std::min(most, Wide{root(2 * slope * amount(behind) - knee * knee)});
  }
  return static_cast<Rate>(std::clamp(by_gain, -most, most));
}

int32_t SynchronousOperation::lead(const SynchronousSettings& s, const Scale& scale) {
  const Rate top = rate_of_speed(std::max(s.maximum_speed, 0), {});
  const Rate wanted = std::clamp(precontrol_ + correction(s, scale), -top, top);
  const Rate slope = s.catch_up_ramp > 0 ? rate_of_speed(kRampSpeed, {}) / s.catch_up_ramp : INT64_MAX;
  if (state_ == State::CatchingUp && magnitude(wanted - speed_) > slope)
    speed_ += sign(wanted - speed_) * slope;
  else {
    speed_ = wanted;
    if (magnitude(difference()) <= s.tolerance) state_ = State::Synchronous;
  }
  return static_cast<int32_t>(speed_of_rate(speed_, {}));
}

// It waits for its start, for a master that has stopped, or at a limit switch that it would go beyond.
bool SynchronousOperation::stands(const SynchronousSettings& s, const SynchronousInputs& in) const {
  if (!in.start || (in.master_stopped && magnitude(difference()) <= s.tolerance)) return true;
  return (in.limit_cw && (difference() > 0 || in.speed > 0)) || (in.limit_ccw && (difference() < 0 || in.speed < 0));
}

SynchronousOrder SynchronousOperation::tick(const SynchronousSettings& s, const SynchronousInputs& in) {
  const Scale scale(s);
  count(in, scale);
  take_edges(s, in, scale);
  const bool free = runs_free(s, in, scale);
  const Wide shown = counter_ + (s.mode == kTemporaryOffset ? offset_of(s, offset_) * scale.increment : 0);
  constexpr Wide kFarthest = Wide{1} << 58;
  difference_ = static_cast<Fine>(std::clamp(shown * kIncrement / scale.increment, -kFarthest, kFarthest));
  precontrol_ = precontrol(s, scale);
  SynchronousOrder order;
  order.controls = !free;
  order.stands = !free && stands(s, in);
  order.speed = in.speed;
  if (free) {
    state_ = State::FreeRunning;
  } else if (order.stands || !in.following) {
    state_ = State::Stopped;
  } else {
    if (state_ == State::Stopped || state_ == State::FreeRunning) {
      state_ = State::CatchingUp;
      speed_ = rate_of_speed(in.speed, {});
      lag_error_ = false;
    }
    order.speed = lead(s, scale);
  }
  watch(s);
  return order;
}

}  // namespace ipos::runtime
