// Reference signals first, then a level for each output.
#include "runtime/drive/outputs.hpp"

#include <cstdlib>

namespace ipos::runtime {
namespace {

int64_t magnitude(int32_t value) { return std::abs(int64_t{value}); }

uint32_t flags_of(const OutputInputs& in) {
  const auto bit = [](bool flag, unsigned n) { return (flag ? 1U : 0U) << n; };
  return bit(in.fault, 0) | bit(in.ipos_fault, 1) | bit(in.ready, 2) | bit(in.output_stage, 3) |
         bit(in.brake_released, 4) | bit(in.standstill, 5) | bit(in.second_set, 6) |
         bit(in.motor_1_overloaded, 7) | bit(in.motor_2_overloaded, 8) | bit(in.in_position, 9) |
         bit(in.referenced, 10);
}

}  // namespace

uint16_t Outputs::tick(const Settings& s, const OutputInputs& in) {
  const int64_t speed = magnitude(in.speed);
  const int64_t current = magnitude(in.current);
  const int64_t deviation = std::abs(int64_t{in.speed} - in.setpoint);
  const int64_t half = s.window_width / 2;
  const int64_t from_center = std::abs(speed - s.window_center);
  speed_.tick(speed > s.speed_reference, speed <= int64_t{s.speed_reference} - s.speed_hysteresis,
              s.speed_delay);
  window_.tick(from_center <= half, from_center > half, s.window_delay);
  compare_.tick(deviation <= s.compare_hysteresis, deviation > s.compare_hysteresis, s.compare_delay);
  current_.tick(current > s.current_reference, current <= int64_t{s.current_reference} - s.current_hysteresis,
                s.current_delay);
  limit_.tick(current >= in.current_limit, current < int64_t{in.current_limit} - s.limit_hysteresis,
              s.limit_delay);

  signals_ = {speed_.value() == (s.speed_when == 1), window_.value() == (s.window_when == 0),
              compare_.value() == (s.compare_when == 1), current_.value() == (s.current_when == 1),
              limit_.value() == (s.limit_when == 0)};

  // With no input 1, no signal shown and no function chosen every level is 0, so the first basis is good,
  // too.
  const Basis basis{flags_of(in), in.ipos_outputs, signals_, s.outputs};
  if (basis == basis_) return levels_;
  basis_ = basis;
  uint16_t levels = in.brake_released ? 1 : 0;  // DB00
  for (unsigned bit = 1; bit < s.outputs.size(); ++bit)
    if (level(static_cast<OutputFunction>(s.outputs[bit]), in, bit))
      levels |= static_cast<uint16_t>(1U << bit);
  return levels_ = levels;
}

// P403, P413, P422, P432, P442 say for which case the signal is 1.
bool Outputs::level(OutputFunction function, const OutputInputs& in, unsigned bit) const {
  using F = OutputFunction;
  switch (function) {
    case F::None: return false;
    case F::NoFault: return !in.fault;
    case F::Ready: return in.ready;
    case F::OutputStageOn:
    case F::RotatingField: return in.output_stage;
    case F::BrakeReleased: return in.brake_released;
    case F::BrakeApplied: return !in.brake_released;
    case F::Standstill: return in.standstill;
    case F::ParameterSet: return in.second_set;
    case F::SpeedReference: return signals_.speed;
    case F::SpeedWindow: return signals_.window;
    case F::SetpointReached: return signals_.compare;
    case F::CurrentReference: return signals_.current;
    case F::CurrentLimit: return signals_.limit;
    case F::NoMotorUtilization1: return !in.motor_1_overloaded;
    case F::NoMotorUtilization2: return !in.motor_2_overloaded;
    case F::NoDrsPrewarning:
    case F::NoDrsLagError: return true;
    case F::DrsInPosition:
    case F::PiReference: return false;
    case F::IposInPosition: return in.in_position;
    case F::IposReferenced: return in.referenced;
    case F::IposOutput: return (in.ipos_outputs >> bit & 1) != 0;
    case F::NoIposFault: return !in.ipos_fault;
  }
  return false;
}

}  // namespace ipos::runtime
