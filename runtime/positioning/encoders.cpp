// Positions of all encoders from what the motor has turned.
#include "runtime/positioning/encoders.hpp"

namespace ipos::runtime {

void Encoders::configure(const PositioningSettings& settings) {
  factor_ = settings.encoder_factor();
  inverted_ = settings.absolute_inverted == 1;
  absolute_zero_ = settings.absolute_zero;
  find_positions();
}

void Encoders::power_on(int32_t shaft) {
  turned_ = turned_before_ = shaft;
  counter_ = 0;
  absolute_offset_ = 0;
  set_position(PositionSource::Motor, 0);
  set_position(PositionSource::External, 0);
}

void Encoders::set_position(PositionSource source, int32_t position) {
  const int64_t change = position - exact(source);
  switch (source) {
    case PositionSource::Motor: motor_offset_ += change; break;
    case PositionSource::External: external_offset_ += change; break;
    case PositionSource::Absolute: absolute_offset_ += change; break;
  }
  find_positions();
}

// H510 goes on from the number it has.
void Encoders::count_other(std::optional<int32_t> count) {
  const int64_t position = exact(PositionSource::External);
  if (external_ && count)
    external_turned_ += wrapped(int64_t{*count} - *external_);
  else
    external_turned_ = 0;
  const bool goes_on = external_.has_value() && count.has_value();
  external_ = count;
  if (!goes_on) external_offset_ += position - exact(PositionSource::External);
  find_positions();
}

// Of an encoder X14 that something else turns no zero pulse is known (ours).
std::optional<int32_t> Encoders::zero_pulse(PositionSource source, int way) const {
  if (source == PositionSource::External && external_) return std::nullopt;
  // The pulses a shaft passes on its way from 1 to 4096 and back are the one at 4096 and the one at 0 or
  // below.
  const int64_t pulse =
      way > 0 ? floor_divide(turned_, kTurn) * kTurn : -floor_divide(-turned_, kTurn) * kTurn;
  const bool passed = way > 0 ? pulse > turned_before_ : pulse < turned_before_;
  if (!passed || turned_ == turned_before_) return std::nullopt;
  return wrapped(scaled(source, pulse) + offset(source));
}

}  // namespace ipos::runtime
