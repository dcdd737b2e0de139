// The modulo function: positions within one turn of the output (IPOSplus p. 29, 76, 81; P960..P963). A turn
// has P961 x P963 units, an increment P962 of them; in the normal form a turn is shown as 65536 steps, with
// H453 bit 1 in units.
#pragma once

#include <cstdint>

#include "runtime/positioning/settings.hpp"

namespace ipos::runtime {

// Settings of P960.
enum class ModuloMode : uint8_t { Off = 0, Short = 1, Cw = 2, Ccw = 3 };

class Modulo {
 public:
  static constexpr int64_t kSteps = 1 << 16;

  // False when P961 x P963 is not below 2^31 (IPOSplus p. 81) and the function is wanted; it is off then.
  bool configure(const PositioningSettings& settings, int32_t position);
  // Else configure() is called every millisecond: turns follow the position.
  bool possible() const { return possible_; }

  ModuloMode mode() const { return mode_; }
  bool on() const { return mode_ != ModuloMode::Off; }

  // The source has another position: by moving, or by being given another number.
  void move(int32_t increments) {
    const int64_t units = units_ + increments * increment_;
    if (turn_ == 1) {  // as without the function: no division
      turns_ += units;
      units_ = 0;
    } else if (units >= 0 && units < turn_) {
      units_ = units;
    } else {
      pass_turns(units);
    }
  }
  void set(int32_t position);

  int32_t position(bool high_resolution) const;
  int32_t turns() const { return wrapped(turns_); }
  void set_turns(int32_t turns) { turns_ = turns; }

  // The target without its full turns: how it reads once the travel has begun.
  int32_t within_turn(int32_t target, bool high_resolution) const;

  // Increments from a point, `offset` from the present position, to the target: the way P960 demands, in the
  // normal form with the full turns of the target added when it goes one way only. Only while the function is on.
  int64_t way_to(int32_t target, bool high_resolution, int64_t offset) const;
  bool operator==(const Modulo&) const = default;

 private:
  void pass_turns(int64_t units);
  int64_t units_within(int32_t target, bool high_resolution) const;

  ModuloMode mode_ = ModuloMode::Off;
  bool possible_ = true;
  int64_t turn_ = 1;       // units
  int64_t increment_ = 1;  // units
  int64_t units_ = 0;      // 0..turn_ - 1
  int64_t turns_ = 0;
};

}  // namespace ipos::runtime
