// One axis: ramp, brake, motor and load, advanced by one millisecond a tick. Everything is in the units of
// the parameters: 1/1000 rpm, 1/1000 % of IN, ms, mV; the position counts 4096 increments a turn (IPOSplus p.
// 34). Exact integers but for what axis_in_detail.cpp adds, no allocation: an Axis is a plain value, a copy of it is a snapshot.
#pragma once

#include <cstdint>
#include <type_traits>

#include "runtime/motion/brake.hpp"
#include "runtime/motion/brake_sequence.hpp"
#include "runtime/motion/control_order.hpp"
#include "runtime/motion/machine_data.hpp"
#include "runtime/motion/power_section.hpp"
#include "runtime/motion/ramp.hpp"
#include "runtime/motion/second_mass.hpp"
#include "runtime/motion/shaft.hpp"
#include "runtime/motion/speed_control.hpp"
#include "runtime/motion/voltage_control.hpp"
#include "runtime/part/part.hpp"

namespace ipos::runtime {

enum class AxisCommand : uint8_t {
  Inhibit,   // output stage off at once; the brake falls in, or the motor coasts (MOVITRAC 07 chapter 6.3)
  Stop,      // down on the stop ramp, then brake, then output stage off or standstill current
  HoldZero,  // down on the stop ramp, then held at 0 by the motor with the brake released
  Run,       // ramp towards the target
  Follow,    // the target is the setpoint as it is, without ramp: for positioning
  Torque,    // the motor gives a torque, and the speed is what comes of it
};

struct AxisOrder {
  AxisCommand command = AxisCommand::Inhibit;
  int32_t target = 0;       // 1/1000 rpm, positive is clockwise; beyond 100000 rpm counts as that
  int32_t current = 0;      // of Torque: active current, 1/1000 % of IN, positive drives clockwise
  int32_t speed_limit = 0;  // of Torque, of the amount, 1/1000 rpm
  RampTimes ramp;
  uint32_t stop_ramp_ms = 0;        // of Stop and HoldZero, always linear
  int32_t current_limit = 150'000;  // P303
  int32_t load_torque = 0;          // added to MachineData::load_torque
  int32_t shaft_speed = 0;          // of a shaft that is driven from outside, 1/1000 rpm
  int32_t standstill_current = 0;   // P710; 0: the output stage goes off at standstill

  bool brake_function = true;     // P730; without it the brake times are 0 and no brake acts
  uint16_t brake_release_ms = 0;  // P731
  uint16_t brake_apply_ms = 0;    // P732
  uint16_t premagnetize_ms = 0;   // P323
  ControlOrder control;           // of MachineData::real
};

struct AxisState {
  AxisPhase phase = AxisPhase::Off;
  bool output_stage = false;
  bool brake_released = false;   // as commanded: DB00
  bool standing = true;          // the shaft
  bool ramping = false;          // the ramp is on its way
  bool current_limited = false;  // the shaft lags the setpoint
  int32_t setpoint = 0;          // ramp output; 0 while no setpoint acts
  int32_t speed = 0;
  int32_t position = 0;  // wraps like the 32-bit counter
  int32_t torque = 0;    // of the motor, 1/1000 % of its rated torque
  int32_t output_current = 0;
  int32_t active_current = 0;  // negative when the torque acts counter-clockwise
  int32_t frequency = 0;       // mHz
  int32_t dc_link = 0;         // mV
  int32_t heat_sink = 0;       // °C
  int32_t utilization = 0;     // of the unit, 1/1000 %
  int32_t motor_utilization = 0;
  int64_t energy = 0;  // Ws since reset

  bool operator==(const AxisState&) const = default;
};

// What a machine has beyond the plainest shaft (is_detailed()).
struct AxisDetails {
  explicit AxisDetails(const MachineData& machine) : voltage(machine), control(machine), second(machine) {}
  bool operator==(const AxisDetails&) const = default;

  Brake brake;
  VoltageControl voltage;
  SpeedControl control;
  SecondMass second;
  uint32_t zero = 0;          // of the machine, as the counter counts
  bool has_encoder = false;   // by the last order
};

// What an Axis is made of.
struct AxisParts {
  explicit AxisParts(const MachineData& machine)
      : machine_(within_limits(machine)),
        ramp_(machine_.ramp_reference),
        shaft_(machine_),
        power_(machine_),
        detailed_(is_detailed(machine_)),
        details_(machine_) {}
  bool operator==(const AxisParts&) const = default;

  MachineData machine_;
  BrakeSequence sequence_;
  Ramp ramp_;
  Shaft shaft_;
  mutable PowerSection power_;
  FineSpeed speed_ = 0;
  uint32_t position_ = 0;
  int64_t position_rest_ = 0;  // part of an increment
  mutable AxisState state_;
  mutable uint32_t behind_ = 0;      // ticks of advance() that the power section has not seen yet
  mutable bool power_shown_ = true;  // the state is as the power section
  bool detailed_;
  AxisDetails details_;
};

class Axis : private AxisParts {
 public:
  explicit Axis(const MachineData& machine);

  // One millisecond under this order; tick() shows it, too.
  void step(const AxisOrder& order) {
    catch_up();
    if (detailed_)
      go_in_detail(order);
    else if (order.command >= AxisCommand::Follow && state_.phase == AxisPhase::Moving)
      go_directly(order);
    else
      go_through(order);
  }
  const AxisState& tick(const AxisOrder& order) {
    step(order);
    return state();
  }
  // The same step again and again while it goes as it is told (axis_following.hpp).
  class Following;
  // What so many ticks under the last order do, at most bound() of them. Only while no ramp runs and the DC
  // link stays as it is: then only position, temperatures and energy change.
  void advance(Ticks ticks);
  Ticks bound() const { return detailed_ && (speed_ != 0 || machine_.noise != 0) ? 0 : power_.bound(); }
  friend bool operator==(const Axis& a, const Axis& b) {
    a.state();
    b.state();
    return static_cast<const AxisParts&>(a) == static_cast<const AxisParts&>(b);
  }
  const AxisState& state() const {
    catch_up();
    if (!power_shown_) show_power();
    return state_;
  }
  const PowerSection& power() const {
    catch_up();
    return power_;
  }
  // Of state(), for who looks every millisecond: what warms and counts is computed when somebody asks for it.
  AxisPhase phase() const { return state_.phase; }
  int32_t position() const { return state_.position; }
  double part_of_increment() const;  // beyond position(), below 1
  int32_t speed() const { return state_.speed; }
  bool standing() const { return state_.standing; }
  bool output_stage() const { return state_.output_stage; }
  bool brake_released() const { return state_.brake_released; }
  bool current_limited() const { return state_.current_limited; }
  int32_t setpoint() const { return state_.setpoint; }
  int32_t output_current() const { return state_.output_current; }
  const MachineData& machine() const { return machine_; }
  // The motor was told a field that it cannot follow: more current than any limiter is quick enough for.
  bool overcurrent() const { return details_.voltage.overcurrent(); }
  // Of the next ticks while it goes on: the highest values, and the most energy for one tick (Ws).
  int32_t heat_sink_ahead() const { return power_.heat_sink_ahead(); }
  int32_t motor_utilization_ahead() const { return power_.motor_utilization_ahead(); }
  int64_t energy_ahead() const { return power_.energy_ahead(); }

  // Off: nothing holds the DC link (PowerSection::set_mains). An empty one has been without them for long.
  void set_mains(bool on) {
    catch_up();
    power_.set_mains(on);
  }
  void empty_dc_link() {
    catch_up();
    power_.empty();
    power_shown_ = false;
  }
  // A reference travel, or the absolute encoder at power-on, sets the counter.
  void set_position(int32_t position);
  // Power off and on: everything stands and is cold, the counter at 0.
  void reset() { *this = Axis(machine_); }

 private:
  void go_directly(const AxisOrder& order);
  void turn(const AxisOrder& order);
  void go_through(const AxisOrder& order);
  void advance_sequence(const AxisOrder& order);
  void advance_setpoint(const AxisOrder& order);
  // axis_in_detail.cpp
  void go_in_detail(const AxisOrder& order);
  bool has_stopped(const AxisOrder& order) const;
  void advance_real_setpoint(const AxisOrder& order);
  void leap_to_start(const AxisOrder& order);
  bool brakes_by_current(const AxisOrder& order) const;
  Motion drive_in_detail(const AxisOrder& order, const Resistance& resistance);
  Motion drive_really(const AxisOrder& order, int64_t torque_limit, const Resistance& resistance);
  void move_second(const AxisOrder& order, const Resistance& resistance, int64_t load, Motion& motion);
  void show_detail() const;
  Motion advance_shaft(const AxisOrder& order);
  Motion drive_to(FineSpeed setpoint, const AxisOrder& order, bool brake_acts);
  Resistance resistance(const AxisOrder& order, bool brake_acts) const;
  void move(const AxisOrder& order, Supply supply, const Motion& motion);
  void count_position(int64_t way);
  void catch_up() const {
    if (behind_ != 0) draw_and_warm();
  }
  void draw_and_warm() const;
  void show_power() const;

  static FineSpeed target_of(const AxisOrder& order);
  static bool has_torque(AxisPhase phase);
  bool brake_open() const;
};

static_assert(std::is_trivially_copyable_v<Axis>, "a copy is a snapshot");

}  // namespace ipos::runtime
