// Modulo arithmetic in units, so that a turn that is no whole number of increments does not drift.
#include "runtime/positioning/modulo.hpp"

#include <algorithm>
#include <cassert>

namespace ipos::runtime {
namespace {

constexpr int64_t remainder(Wide value, int64_t by) {
  const auto rest = static_cast<int64_t>(value % by);
  return rest < 0 ? rest + by : rest;
}

}  // namespace

bool Modulo::configure(const PositioningSettings& s, int32_t position) {
  const int64_t turn = int64_t{s.modulo_numerator} * s.modulo_resolution;
  possible_ = turn > 0 && turn <= INT32_MAX && s.modulo_denominator > 0;
  const ModuloMode mode = possible_ ? static_cast<ModuloMode>(s.modulo) : ModuloMode::Off;
  if (mode != mode_ || turn != turn_ || s.modulo_denominator != increment_) {
    mode_ = mode;
    turn_ = possible_ ? turn : 1;
    increment_ = possible_ ? s.modulo_denominator : 1;
    set(position);
  }
  return possible_ || s.modulo == 0;
}

void Modulo::set(int32_t position) {
  const int64_t units = position * increment_;
  turns_ = floor_divide(units, turn_);
  units_ = units - turns_ * turn_;
}

void Modulo::pass_turns(int64_t units) {
  const int64_t turns = floor_divide(units, turn_);
  turns_ += turns;
  units_ = units - turns * turn_;
}

int32_t Modulo::position(bool high_resolution) const {
  if (!on()) return 0;
  return static_cast<int32_t>(high_resolution ? units_ : units_ * kSteps / turn_);
}

int32_t Modulo::within_turn(int32_t target, bool high_resolution) const {
  return static_cast<int32_t>(remainder(target, high_resolution ? turn_ : kSteps));
}

int64_t Modulo::units_within(int32_t target, bool high_resolution) const {
  const int64_t within = within_turn(target, high_resolution);
  return high_resolution ? within : (within * turn_ + kSteps / 2) / kSteps;
}

int64_t Modulo::way_to(int32_t target, bool high_resolution, int64_t offset) const {
  assert(on());
  const int64_t from = remainder(units_ + Wide{offset} * increment_, turn_);
  int64_t ahead = remainder(units_within(target, high_resolution) - from, turn_);
  // The target is a point between two increments; an axis less than one away is there.
  if (turn_ - ahead < increment_) ahead -= turn_;
  const int64_t full = high_resolution ? 0 : std::max<int64_t>(0, floor_divide(target, kSteps)) * turn_;
  switch (mode_) {
    case ModuloMode::Off: break;
    case ModuloMode::Short:
      if (2 * ahead > turn_) ahead -= turn_;
      break;
    case ModuloMode::Cw: ahead += full; break;
    case ModuloMode::Ccw:
      if (ahead >= increment_) ahead -= turn_;
      ahead -= full;
      break;
  }
  return floor_divide(2 * ahead + increment_, 2 * increment_);  // to the nearest
}

}  // namespace ipos::runtime
