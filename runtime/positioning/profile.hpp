// The ramp generator of positioning: SetpointPos H491 (IPOSplus p. 34). A travel is planned as a few phases
// of constant or evenly changing speed in continuous time and read out once a millisecond, so the end is met
// exactly and the times are those of the closed form. Whatever changes on the way (target, speed, ramp) is a
// new plan from the present position and speed.
//
// Positions are not bound to 32 bits: the caller wraps what it shows.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "runtime/positioning/fixed_point.hpp"
#include "runtime/positioning/ramp_shape.hpp"

namespace ipos::runtime {

struct TravelRules {
  Rate cw = 0;  // top speeds, not negative
  Rate ccw = 0;
  Rate reference = 1;  // a ramp time is the time for this change of speed
  int32_t up_ms = 1;
  int32_t down_ms = 1;
  RampShape shape = RampShape::Linear;
  bool operator==(const TravelRules&) const = default;
};

enum class Goal : uint8_t {
  New,   // braked for with the ramp only: a target too near to stop at is passed and returned to
  Kept,  // other rules towards the same target: the brake takes the way there is, however short
};

class Profile {
 public:
  Fine position() const { return position_; }
  Rate speed() const { return speed_; }
  // Nothing is left to be done.
  bool at_rest() const { return phases_ == 0; }

  // One millisecond.
  void tick();
  // Several of them within a phase (profile_stretch.hpp).
  class Stretch;

  // No plan: the shaft is somewhere else in charge, or rests.
  void hold(Fine position, Rate speed);
  void travel(int64_t target, const TravelRules& rules, Goal goal);
  // Endlessly with rules.cw or rules.ccw.
  void run(int way, const TravelRules& rules);
  void stop(const TravelRules& rules);

  // Where a stop now would end: the first whole increment in reach.
  int64_t stop_position(const TravelRules& rules) const;
  // The target cannot be reached without passing it first.
  bool overruns(int64_t target, const TravelRules& rules) const;

  // The counting has moved: every position is another number by so much.
  void shift(int64_t increments);
  bool operator==(const Profile&) const = default;

 private:
  struct Phase {
    Rate from, to;
    Span duration;
    RampShape shape;
    bool operator==(const Phase&) const = default;
  };
  static constexpr size_t kMostPhases = 4;  // turn back, up, cruise, down

  void begin();
  void add(Rate from, Rate to, Span duration, RampShape shape);
  void brake_to(Fine goal, RampShape shape);

  void enter_phase();
  bool next_phase();
  bool at_last_phase() const { return arrives_ && phase_ + 1U == phases_; }
  void arrive();
  static int64_t share_in(const Phase& phase, Span time);
  static int64_t share_in_long(Span duration, Span time);
  static Fine way_in(const Phase& phase, Span time, int64_t distance_share);
  static Rate speed_in(const Phase& phase, int64_t speed_share) {
    return phase.from + static_cast<Rate>((Wide{phase.to - phase.from} * speed_share) >> kShareBits);
  }
  // Rounding must not carry it past the target.
  bool ends_at_goal() const { return arrives_ && !(turns_ && phase_ == 0); }
  void read_out(const Phase& phase, int64_t speed_share, int64_t distance_share);
  void read_out_curve(const Phase& phase, int64_t share);

  Fine position_ = 0;
  Rate speed_ = 0;

  uint8_t phase_ = 0;  // the one that runs
  bool entered_ = false;
  Span elapsed_ = 0;  // since it began
  Fine begin_ = 0;    // where it began
  Fine way_ = 0;      // all of it
  Fine origin_ = 0;   // where its way is counted from
  Fine goal_ = 0;
  bool arrives_ = false;  // the last phase ends at goal_
  bool turns_ = false;    // the first one passes it, or leads away from it
  uint8_t phases_ = 0;
  std::array<Phase, kMostPhases> plan_{};
};

static_assert(std::is_trivially_copyable_v<Profile>, "a copy is a snapshot");

}  // namespace ipos::runtime
