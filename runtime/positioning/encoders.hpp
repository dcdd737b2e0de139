// The three encoders: motor X15, external X14, absolute DIP (H511, H510, H509). The simulated external ones
// are coupled to the motor without slip, with the ratio P942 and P943 state (ours), unless something else turns X14.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/positioning/fixed_point.hpp"
#include "runtime/positioning/settings.hpp"

namespace ipos::runtime {

class Encoders {
 public:
  static constexpr int32_t kTurn = 4096;  // increments of the motor encoder; its zero pulse comes once a turn

  // The parameters P942, P943, P951 and P954.
  void configure(const PositioningSettings& settings);

  // Incremental encoders begin at 0; the absolute one knows where the shaft is: increments it was ever
  // turned.
  void power_on(int32_t shaft);

  // The counter of the motor encoder as the axis has it; it wraps.
  void count(int32_t motor_counter) {
    turned_before_ = turned_;
    turned_ += wrapped(int64_t{motor_counter} - counter_);
    counter_ = motor_counter;
    find_positions();
  }
  // The same for several milliseconds, before the last of which it was at `before`.
  void count(int32_t before, int32_t motor_counter) {
    turned_ += wrapped(int64_t{before} - counter_);
    counter_ = before;
    count(motor_counter);
  }
  // What turns X14 in place of the motor, as it counts; nothing: the motor does. It begins where X14 stands. True: it has
  // turned.
  bool count_external(std::optional<int32_t> count) {
    if (count == external_) return false;
    count_other(count);
    return true;
  }
  int32_t counter() const { return counter_; }  // as last counted
  // It was told this count twice.
  bool stands_at(int32_t motor_counter) const {
    return motor_counter == counter_ && turned_before_ == turned_;
  }
  // The axis was given another count; nothing has moved.
  void recount(int32_t motor_counter) { counter_ = motor_counter; }

  int32_t position(PositionSource source) const { return positions_.of(source); }
  struct Positions {
    std::array<int32_t, 3> by_source{};
    int32_t of(PositionSource source) const { return by_source[static_cast<size_t>(source)]; }
    bool operator==(const Positions&) const = default;
  };
  const Positions& positions() const { return positions_; }
  // From now on the present position of this source has another number.
  void set_position(PositionSource source, int32_t position);

  // Position of the source at a zero pulse that the last millisecond passed in this direction.
  std::optional<int32_t> zero_pulse(PositionSource source, int way) const;
  bool operator==(const Encoders&) const = default;

 private:
  void count_other(std::optional<int32_t> count);
  void find_positions() {
    const int64_t count = counted(turned_);
    positions_.by_source = {wrapped(turned_ + motor_offset_), wrapped((external_ ? external_turned_ : count) + external_offset_),
                            wrapped((inverted_ ? -count : count) + absolute_zero_ + absolute_offset_)};
  }
  int64_t exact(PositionSource source) const { return scaled(source, turned_) + offset(source); }
  int64_t scaled(PositionSource source, int64_t motor) const {
    if (source == PositionSource::Motor) return motor;
    if (source == PositionSource::External && external_) return external_turned_;
    const int64_t count = counted(motor);
    return source == PositionSource::Absolute && inverted_ ? -count : count;
  }
  int64_t counted(int64_t motor) const {  // by the encoders P942 and P943 are for
    const bool equal = factor_.numerator == factor_.denominator;
    return equal ? motor : floor_divide(motor * factor_.denominator, factor_.numerator);
  }
  int64_t offset(PositionSource source) const {
    switch (source) {
      case PositionSource::Motor: return motor_offset_;
      case PositionSource::External: return external_offset_;
      case PositionSource::Absolute: break;
    }
    return absolute_zero_ + absolute_offset_;
  }

  EncoderFactor factor_;
  bool inverted_ = false;
  int64_t absolute_zero_ = 0;

  int32_t counter_ = 0;
  int64_t turned_ = 0;         // by the motor ever; zero pulses at multiples of a turn
  int64_t turned_before_ = 0;  // a millisecond ago
  std::optional<int32_t> external_;  // count of X14 where it does not follow the motor
  int64_t external_turned_ = 0;      // the same, without wrapping
  int64_t motor_offset_ = 0;
  int64_t external_offset_ = 0;
  int64_t absolute_offset_ = 0;
  Positions positions_;  // found again when one of the above changes
};

}  // namespace ipos::runtime
