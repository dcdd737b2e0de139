// Positioning of one axis: what the program orders becomes a speed the drive follows, once a millisecond, and
// positions and bits the program sees. docs/inside/positioning.md has the rules; no manual at hand describes them
// beyond what is cited. A Positioner is a plain value, a copy of it is a snapshot.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "runtime/part/part.hpp"
#include "runtime/positioning/encoders.hpp"
#include "runtime/positioning/follower.hpp"
#include "runtime/positioning/modulo.hpp"
#include "runtime/positioning/profile.hpp"
#include "runtime/positioning/reference_travel.hpp"
#include "runtime/positioning/settings.hpp"
#include "runtime/positioning/touch_probe.hpp"

namespace ipos::runtime {

enum class PositioningEvent : uint8_t {
#define POSITIONING_EVENT(name, fault, cause, text) name,
#include "runtime/positioning/events.def"
};
inline constexpr size_t kPositioningEvents = 0
#define POSITIONING_EVENT(name, fault, cause, text) +1
#include "runtime/positioning/events.def"
    ;
// What an event comes from: the last order of its kind. Motion: the target or the reference travel, whichever
// moves the axis.
enum class PositioningCause : uint8_t { None, Target, Reference, Setting, Motion };
inline constexpr size_t kPositioningCauses = 5;

uint8_t fault_of(PositioningEvent event);  // 0: none
PositioningCause cause_of(PositioningEvent event);
std::string_view text_of(PositioningEvent event);

// Keywords of _AxisStop that hold the axis until it is enabled again.
enum class Halt : uint8_t { None, RapidStop, HoldControl };

struct PositioningInputs {
  bool possible = false;   // the operating mode is one with positioning
  bool following = false;  // enabled, magnetized, brake open: the axis turns as it is told
  int32_t speed = 0;       // of the motor, 1/1000 rpm
  uint16_t levels = 0;     // of the inputs, as InputLevel H483
  bool cam = false;        // and by their functions; a limit switch is true where it is reached
  bool limit_cw = false;
  bool limit_ccw = false;
  bool has_cam = false;
  bool has_limits = false;
  bool reference_start = false;
  int32_t override_permille = 1000;  // 1000 with P930 = OFF
  uint32_t modulo_control = 0;       // H453
  std::optional<int32_t> external;   // count of an encoder X14 that does not follow the motor
  MasterInputs master;
  bool operator==(const PositioningInputs&) const = default;
};

// For the drive.
struct PositioningOrder {
  bool controls = false;  // the speed below counts, not the setpoint of P100
  int32_t speed = 0;      // 1/1000 rpm, without ramp
  Halt halt = Halt::None;
};

class Positioner {
 public:
  // Once, after what holds the settings: not referenced, no target. `shaft`: increments it was ever turned.
  void power_on(const PositioningSettings& settings, int32_t shaft);
  // Other settings, before a tick.
  void take_over(const PositioningSettings& settings);

  // --- the millisecond ---
  // Before the axis moves: sensors belong to where it is now.
  PositioningOrder tick(const PositioningInputs& inputs);
  // Nothing can act: the mode is one without positioning, nothing is under way and nothing has just happened.
  // Then idle() is tick() with the same settings and inputs except the speed, which it orders.
  bool idles() const {
    return !inputs_.possible && !reference_.active() && follower_.silent() && !touch_probes_.probe(0).fresh &&
           !touch_probes_.probe(1).fresh && !has_events();
  }
  void idle();
  // The last tick() has gone on with its plan, or rested at the end of it. Then go_on() is tick() with
  // the same settings and inputs except the speed, which it orders.
  bool goes_on() const;
  int32_t go_on();
  // The same and observe() in several milliseconds within a phase of a travel (positioner_leading.hpp).
  class Leading;
  // idle() and observe() for several ms at once, where nobody looks at the order, and for how many of them
  // that holds; `before` is the counter one ms before the end.
  void advance(int32_t before, int32_t motor_counter);
  Ticks bound() const { return idles() ? kNoBound : 0; }
  // After it has moved: the counter of the motor encoder.
  void observe(int32_t motor_counter) {
    move(motor_counter);
    lag_ = following_ ? wrapped(int64_t{setpoint()} - actual()) : 0;
  }
  // A reference travel has given the motor encoder another count, which the axis must take over.
  std::optional<int32_t> take_motor_counter() { return std::exchange(motor_counter_, std::nullopt); }
  bool has_events() const { return events_.which.any(); }
  bool lags_too_far() const {
    return settings_.lag_window > 0 && (lag_ < 0 ? -int64_t{lag_} : int64_t{lag_}) > settings_.lag_window;
  }
  // What has been reported since the last call, and the target that was ordered by then; nothing: there was none, as
  // the axis stopped, was referenced or followed a master.
  struct Events {
    std::bitset<kPositioningEvents> which;
    std::optional<int64_t> target;
    bool operator==(const Events&) const = default;
  };
  Events take_events() { return std::exchange(events_, {}); }

  // --- the program ---
  void write_target(int32_t target);                                  // H492, _GoAbs
  void move_target(int64_t way);                                      // _GoRel
  void write_modulo_target(int32_t target);                           // H454
  void set_modulo_turns(int32_t turns) { modulo_.set_turns(turns); }  // H456
  // _Go0; `conditional`: only an axis that is not referenced.
  void start_reference(bool conditional, bool zero_pulse);
  void end_reference();  // and not referenced any more
  void halt(Halt halt) { halt_ = halt; }
  void stop_here();  // on the positioning ramp; the target is where that ends
  TouchProbes& touch_probes() { return touch_probes_; }
  void report(PositioningEvent event) { report(event, ordered_target_); }

  // --- what it shows ---
  int32_t setpoint() const {  // H491
    return following_ ? wrapped(whole(profile_.position())) : actual();
  }
  int32_t target() const { return target_; }  // H492
  int32_t lag() const { return lag_; }        // H495
  int32_t modulo_target() const { return modulo_target_; }
  const Modulo& modulo() const { return modulo_; }
  const Encoders& encoders() const { return encoders_; }
  const TouchProbes& touch_probes() const { return touch_probes_; }
  const PositioningInputs& inputs() const { return inputs_; }  // of the last tick()
  bool in_position() const {                                   // H473 bit 19
    return inputs_.possible && !reference_.active() &&
           magnitude(distance(actual(), target_)) <= std::max(settings_.window, 0);
  }
  bool referenced() const { return referenced_ || source() == PositionSource::Absolute; }  // H473 bit 20
  PositionSource source() const { return settings_.position_source(); }
  bool referencing() const { return reference_.active(); }
  FollowState follow_state() const { return follow_state_; }  // H562
  bool operator==(const Positioner&) const = default;

 private:
  int32_t actual() const { return encoders_.position(source()); }
  bool high_resolution() const { return (inputs_.modulo_control >> 1 & 1) != 0; }

  // With the modulo function positions are points on the circle of 2^32 increments, so that an axis may turn
  // for ever; without it they are points on a line.
  int64_t distance(int32_t from, int32_t to) const {
    const int64_t way = int64_t{to} - from;
    return modulo_.on() ? wrapped(way) : way;
  }
  int64_t target_on_line() const;
  bool target_allowed() const;

  void report(PositioningEvent event, std::optional<int64_t> target) {
    events_.which.set(static_cast<size_t>(event));
    if (target) events_.target = target;
  }
  void configure_modulo();
  void find_rules();
  void rest();
  void resume();
  void run_travel();
  bool follow_master();
  void couple();
  Fine approach(Rate& speed);
  void watch_limit_switches();
  bool plan_holds(int64_t goal) const { return plan_follows_ && planned_target_ == goal; }
  void plan(int64_t goal, const TravelRules& rules);
  void brake_here();
  void drop_target();
  void move(int32_t motor_counter) {
    const int32_t before = actual();
    encoders_.count(motor_counter);
    modulo_.move(wrapped(int64_t{actual()} - before));
  }
  void count_external();
  void keep_in_range();
  int32_t lead();
  // P910 and P915. The unit of the gain is ours: with 1.000 a lag of one motor increment gives 0.5 rpm.
  int32_t speed_order(Rate rate, int32_t lag, const EncoderFactor& factor, int64_t top) const {
    constexpr int32_t kAll = 100'000;
    const int64_t speed = speed_of_rate(rate, factor);
    const int64_t feed = settings_.feedforward == kAll ? speed : speed * settings_.feedforward / kAll;
    return static_cast<int32_t>(std::clamp(feed + motor_way(lag, factor) * settings_.gain / 2, -top, top));
  }

  void run_reference();
  void finish_reference(int32_t reference_point);
  void take_pending();

  PositioningSettings settings_;
  // Made of the settings.
  EncoderFactor factor_;  // of the source
  TravelRules full_rules_;
  TravelRules rules_;  // with the override of
  int32_t rules_override_ = 0;

  PositioningInputs inputs_;
  Encoders encoders_;
  Modulo modulo_;
  TouchProbes touch_probes_;
  ReferenceTravel reference_;
  Follower follower_;
  Profile profile_;

  int32_t target_ = 0;
  bool target_follows_ = true;  // no target is wanted: it is where the axis is, until one is given
  int32_t modulo_target_ = 0;
  int32_t lag_ = 0;
  Halt halt_ = Halt::None;
  bool referenced_ = false;
  bool following_ = false;       // in the last millisecond
  bool interrupted_ = false;     // a travel was on its way when it ended
  bool reference_input_ = true;  // at 1 from the beginning it starts nothing
  bool reference_failed_ = false;
  ReferenceTravel::Order reference_order_;
  FollowState follow_state_ = FollowState::Free;
  bool follow_refused_ = false;  // until the program gives it up
  Fine follow_lost_ = 0;         // way of the master, since it was to be followed, that the axis has not made

  // Of the present plan; nothing: there is none.
  std::optional<int64_t> planned_target_;
  TravelRules planned_rules_;
  TravelRules planned_full_;               // the same without override
  bool plan_follows_ = false;              // these are those that hold now: only another target can change it
  std::optional<int32_t> refused_target_;  // beyond a software limit switch, already reported
  bool at_limit_ = false;                  // moving into a limit switch, already reported
  bool given_up_ = false;                  // the travel, for that

  // Ordered during a reference travel, for after it.
  enum class Pending : uint8_t { None, Absolute, Relative, Modulo };
  Pending pending_ = Pending::None;
  int64_t pending_value_ = 0;

  std::optional<int32_t> motor_counter_;
  // The target as it was given, while the axis has it or is on its way there. target_ is also where a stop ends.
  std::optional<int64_t> ordered_target_;
  Events events_;
};

static_assert(std::is_trivially_copyable_v<Positioner>, "a copy is a snapshot");

}  // namespace ipos::runtime
