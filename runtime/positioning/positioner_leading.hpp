// Milliseconds in a row in which a positioner leads its axis within one phase of a travel: Positioner::go_on() and observe()
// for each of them, of an axis that is positioned by the encoder of its motor, on a line. Nothing but the place changes.
#pragma once

#include "runtime/positioning/positioner.hpp"
#include "runtime/positioning/profile_stretch.hpp"

namespace ipos::runtime {

class Positioner::Leading {
 public:
  using Place = Profile::Stretch::Place;

  // While goes_on(), and without too much of a lag.
  static bool possible(const Positioner& positioner) {
    return positioner.following_ && !positioner.modulo_.on() && positioner.follow_state_ == FollowState::Free &&
           positioner.source() == PositionSource::Motor &&
           Profile::Stretch::possible(positioner.profile_);
  }

  [[gnu::always_inline]] explicit Leading(Positioner& positioner)
      : positioner_(positioner),
        stretch_(positioner.profile_),
        offset_(static_cast<uint32_t>(positioner.actual()) - static_cast<uint32_t>(positioner.encoders_.counter())),
        counter_(positioner.encoders_.counter()),
        before_(counter_),
        top_(std::max(positioner.settings_.maximum_speed, 0)),
        window_(std::max(positioner.settings_.window, 0)),
        was_in_position_(positioner.in_position()) {}

  // How many are left of the phase, at most so many.
  Ticks left(Ticks most) const { return stretch_.left(most); }
  // The next place of the setpoint, and the speed for it.
  [[gnu::always_inline]] Place next() const { return stretch_.next(); }
  [[gnu::always_inline]] int32_t speed(const Place& place) const { return positioner_.speed_order(place.speed, positioner_.lag_, kMotor, top_); }
  // The setpoint has gone there, and the axis to this counter. False: it has come into its position or out of it, or lags too far.
  [[gnu::always_inline]] bool observe(const Place& place, int32_t counter) {
    stretch_.go(place);
    before_ = counter_;
    counter_ = counter;
    const auto actual = static_cast<int32_t>(static_cast<uint32_t>(counter) + offset_);
    const int32_t lag = positioner_.lag_ = wrapped(whole(place.position) - actual);
    const PositioningSettings& settings = positioner_.settings_;
    const bool in_position = magnitude(int64_t{actual} - positioner_.target_) <= window_;
    return in_position == was_in_position_ && (settings.lag_window <= 0 || magnitude(int64_t{lag}) <= settings.lag_window);
  }
  [[gnu::always_inline]] void finish() {
    const int32_t actual = positioner_.actual();
    positioner_.encoders_.count(before_, counter_);
    positioner_.modulo_.move(wrapped(int64_t{positioner_.actual()} - actual));
  }

 private:
  static constexpr EncoderFactor kMotor{};  // what PositioningSettings::source_factor() is

  Positioner& positioner_;
  Profile::Stretch stretch_;
  uint32_t offset_;  // of the position from the counter
  int32_t counter_;
  int32_t before_;  // the counter, a millisecond ago
  int64_t top_;     // of the speed
  int32_t window_;
  bool was_in_position_;
};

}  // namespace ipos::runtime
