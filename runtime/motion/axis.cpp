// The tick: sequence, setpoint, shaft, position, power section.
#include "runtime/motion/axis.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace ipos::runtime {
namespace {

// 4096 increments a turn: speed in 1/1000 rpm x 4096 / 60000000 increments a millisecond. With twice the mean
// speed the fraction is 8 / 234375.
constexpr int64_t kIncrementShare = 8;
constexpr int64_t kIncrement = 234'375 * kFine;

// A shaft that something outside turns is never quite at 0: the brake may fall in below this (ours).
constexpr FineSpeed kNearlyStanding = 1'000 * kFine;

FineSpeed target_of(const AxisOrder& order) {
  const bool moves = order.command == AxisCommand::Run || order.command == AxisCommand::Follow;
  return moves ? fine_speed(order.target) : 0;
}

}  // namespace

Axis::Axis(const MachineData& machine) : AxisParts(machine) { show_power(); }

void Axis::set_position(int32_t position) {
  position_ = static_cast<uint32_t>(position);
  position_rest_ = 0;
  state_.position = position;
}

double Axis::part_of_increment() const { return static_cast<double>(position_rest_) / static_cast<double>(kIncrement); }

// The motor is magnetized and follows the setpoint.
inline bool Axis::has_torque(AxisPhase phase) {
  return phase == AxisPhase::Releasing || phase == AxisPhase::Moving || phase == AxisPhase::Applying;
}

inline bool Axis::brake_open() const {
  return sequence_.phase() == AxisPhase::Releasing || sequence_.phase() == AxisPhase::Moving;
}

inline void Axis::advance_sequence(const AxisOrder& order) {
  BrakeTimes times{order.premagnetize_ms, order.brake_release_ms, order.brake_apply_ms};
  if (!order.brake_function) times.release = times.apply = 0;
  switch (order.command) {
    case AxisCommand::Inhibit: return sequence_.inhibit();
    case AxisCommand::Stop: {
      const bool standing = std::abs(speed_) <= (machine_.driven ? kNearlyStanding : 0) && ramp_.output() == 0;
      return sequence_.stop(times, standing, order.standstill_current > 0);
    }
    case AxisCommand::HoldZero:
    case AxisCommand::Run:
    case AxisCommand::Follow:
    case AxisCommand::Torque: return sequence_.enable(times);
  }
}

inline void Axis::advance_setpoint(const AxisOrder& order) {
  // A motor that still turns when its torque comes back is caught at its speed (ours).
  if (!has_torque(state_.phase)) ramp_.set(speed_);
  if (sequence_.phase() != AxisPhase::Moving) return;
  if (order.command >= AxisCommand::Follow)
    return ramp_.set(order.command == AxisCommand::Follow ? target_of(order) : speed_);
  // At the current limit the ramp waits for the shaft, or a stop would begin with more speed (ours).
  if (state_.current_limited) ramp_.wait_at(speed_);
  if (order.command == AxisCommand::Run) return ramp_.step(target_of(order), order.ramp);
  const uint32_t ms = order.stop_ramp_ms;
  ramp_.step(0, {ms, ms, ms, ms, 0});
}

inline Resistance Axis::resistance(const AxisOrder& order, bool brake_acts) const {
  return {machine_.load_torque + std::clamp(order.load_torque, -kTopTorque, kTopTorque),
          machine_.friction + (brake_acts ? machine_.brake_torque : 0)};
}

inline Motion Axis::drive_to(FineSpeed setpoint, const AxisOrder& order, bool brake_acts) {
  const int64_t torque_limit = power_.torque_limit(order.current_limit);
  if (machine_.driven) return shaft_.controlled(fine_speed(order.shaft_speed), setpoint, torque_limit);
  return shaft_.driven(speed_, setpoint, torque_limit, resistance(order, brake_acts));
}

inline Motion Axis::advance_shaft(const AxisOrder& order) {
  const bool brake_acts = machine_.brake && order.brake_function && !brake_open();
  if (has_torque(sequence_.phase())) return drive_to(ramp_.output(), order, brake_acts);
  if (!machine_.driven) return {shaft_.free(speed_, 0, resistance(order, brake_acts)), 0, false};
  shaft_.forget_control();
  return {fine_speed(order.shaft_speed), 0, false};
}

inline void Axis::count_position(int64_t way) {
  position_rest_ += way;
  int64_t increments = position_rest_ / kIncrement;
  position_rest_ %= kIncrement;
  if (position_rest_ < 0) {  // the counter rounds down in both directions
    position_rest_ += kIncrement;
    --increments;
  }
  position_ += static_cast<uint32_t>(increments);
}

// The power section follows the shaft; what nobody looks at every millisecond is shown when somebody asks.
[[gnu::always_inline]] inline void Axis::move(const AxisOrder& order, Supply supply, const Motion& motion) {
  count_position((speed_ + motion.speed) * kIncrementShare);
  speed_ = motion.speed;
  state_.standing = speed_ == 0;
  state_.current_limited = motion.limited;
  state_.speed = whole_speed(speed_);
  state_.position = static_cast<int32_t>(position_);
  state_.torque = static_cast<int32_t>(motion.torque);
  power_.step({supply, state_.speed, motion.torque, order.current_limit, order.standstill_current});
  state_.output_current = power_.output_current();
  power_shown_ = false;
}

void Axis::show_power() const {
  power_shown_ = true;
  state_.active_current = power_.active_current();
  state_.frequency = power_.frequency();
  state_.dc_link = power_.dc_link();
  state_.energy = power_.energy();
  state_.heat_sink = power_.heat_sink();
  state_.utilization = power_.utilization();
  state_.motor_utilization = power_.motor_utilization();
}

// Sequence, setpoint and shaft, each of which may have something to do.
void Axis::go_through(const AxisOrder& order) {
  advance_sequence(order);
  advance_setpoint(order);
  const AxisPhase phase = sequence_.phase();
  Supply supply = Supply::Off;
  if (phase == AxisPhase::Magnetizing) supply = Supply::Magnetizing;
  if (phase == AxisPhase::StandstillCurrent) supply = Supply::DirectCurrent;
  if (has_torque(phase)) supply = Supply::Driving;
  move(order, supply, advance_shaft(order));

  state_.phase = phase;
  state_.output_stage = phase != AxisPhase::Off;
  state_.brake_released = brake_open();
  state_.ramping = phase == AxisPhase::Moving && ramp_.output() != target_of(order);
  // Most of the time the shaft is where the ramp is.
  const bool same = ramp_.output() == speed_;
  state_.setpoint = !has_torque(phase) ? 0 : same ? state_.speed : whole_speed(ramp_.output());
}

// An axis that moves already goes as it is told: only the shaft has something to do.
void Axis::go_directly(const AxisOrder& order) {
  if (order.command == AxisCommand::Torque) return turn(order);
  ramp_.set(fine_speed(order.target));
  move(order, Supply::Driving, drive_to(ramp_.output(), order, false));
  state_.ramping = false;
  state_.setpoint = whole_speed(ramp_.output());
}

// A stop begins from the speed that there is.
void Axis::turn(const AxisOrder& order) {
  const int64_t torque = power_.torque_of(order.current);
  const int64_t torque_limit = power_.torque_limit(order.current_limit);
  const FineSpeed most = std::max<FineSpeed>(fine_speed(order.speed_limit), 0);
  const FineSpeed speed = fine_speed(order.shaft_speed);
  if (!machine_.driven) {
    move(order, Supply::Driving, shaft_.turned(speed_, torque, most, torque_limit, resistance(order, false)));
  } else if (-most <= speed && speed <= most) {
    shaft_.forget_control();
    move(order, Supply::Driving, {speed, std::clamp(torque, -torque_limit, torque_limit), false});
  } else {
    move(order, Supply::Driving, drive_to(speed > 0 ? most : -most, order, false));
  }
  ramp_.set(speed_);
  state_.ramping = false;
  state_.setpoint = state_.speed;
}

void Axis::advance(Ticks ticks) {
  behind_ += ticks;
  power_shown_ = false;
  if (speed_ == 0) return;
  // The whole increments of a tick and what is left, so that no product overflows.
  const int64_t way = 2 * speed_ * kIncrementShare;
  position_ += static_cast<uint32_t>(way / kIncrement * ticks);
  constexpr uint32_t kMost = 1 << 12;
  for (; ticks > kMost; ticks -= kMost) count_position(way % kIncrement * kMost);
  count_position(way % kIncrement * ticks);
  state_.position = static_cast<int32_t>(position_);
}

void Axis::draw_and_warm() const { power_.advance(std::exchange(behind_, 0)); }

}  // namespace ipos::runtime
