// Reference signals first, then a level for each output.
#include "runtime/drive/outputs.hpp"

namespace ipos::runtime {
namespace {

// Where a signal falls again. A hysteresis wider than its reference ends at 0, or the signal would stay for ever
// (ours).
constexpr int64_t falls_at(int64_t reference, int64_t hysteresis) {
  return std::max<int64_t>(reference - hysteresis, 0);
}

// That of Imax is still within its hysteresis at the edge.
constexpr int64_t limit_falls_at(int64_t limit, int64_t hysteresis) {
  return std::max<int64_t>(limit - hysteresis - 1, 0);
}

}  // namespace

uint16_t Outputs::tick(const Settings& s, const OutputInputs& in) {
  for (ReferenceSignal* signal : {&speed_, &window_, &compare_, &current_, &limit_}) signal->advance(ticks_);
  const int64_t speed = magnitude(in.speed);
  const int64_t current = magnitude(in.current);
  const int64_t deviation = magnitude(int64_t{in.speed} - in.setpoint);
  const int64_t half = s.window_width / 2;
  const int64_t from_center = magnitude(speed - s.window_center);
  speed_.tick(speed > s.speed_reference, speed <= falls_at(s.speed_reference, s.speed_hysteresis), s.speed_delay);
  window_.tick(from_center <= half, from_center > half, s.window_delay);
  compare_.tick(deviation <= s.compare_hysteresis, deviation > s.compare_hysteresis, s.compare_delay);
  current_.tick(current > s.current_reference, current <= falls_at(s.current_reference, s.current_hysteresis),
                s.current_delay);
  limit_.tick(in.limited_current() >= in.current_limit,
              in.limited_current() <= limit_falls_at(in.current_limit, s.limit_hysteresis), s.limit_delay);
  find_ranges(s, in);

  signals_ = {speed_.value() == (s.speed_when == 1), window_.value() == (s.window_when == 0),
              compare_.value() == (s.compare_when == 1), current_.value() == (s.current_when == 1),
              limit_.value() == (s.limit_when == 0)};

  // With no input 1, no signal shown and no function chosen every level is 0, so the first basis is good,
  // too.
  const Basis basis{in.flags, in.ipos_outputs, signals_, s.outputs};
  if (basis == basis_) return levels_;
  basis_ = basis;
  uint16_t levels = in.is(output_flags::kBrakeReleased) ? 1 : 0;  // DB00
  for (unsigned bit = 1; bit < s.outputs.size(); ++bit)
    if (level(static_cast<OutputFunction>(s.outputs[bit]), in, bit))
      levels |= static_cast<uint16_t>(1U << bit);
  return levels_ = levels;
}

void Outputs::find_ranges(const Settings& s, const OutputInputs& in) {
  const int64_t speed = magnitude(in.speed);
  const int64_t half = s.window_width / 2;
  speeds_ =
      both(staying(speed_, int64_t{s.speed_reference} + 1, falls_at(s.speed_reference, s.speed_hysteresis)),
           around(window_, s.window_center - half, s.window_center + half, speed));
  const int64_t deviation = magnitude(int64_t{in.speed} - in.setpoint);
  deviations_ = around(compare_, 0, s.compare_hysteresis, deviation);
  const Range currents = staying(current_, int64_t{s.current_reference} + 1,
                                 falls_at(s.current_reference, s.current_hysteresis));
  const Range limits = staying(limit_, in.current_limit, limit_falls_at(in.current_limit, s.limit_hysteresis));
  currents_ = {both(currents, limits), both(currents, at_least(limits, in.current_limit))};
  current_limit_ = in.current_limit;
  ticks_left_ =
      std::min({speed_.bound(s.speed_delay), window_.bound(s.window_delay), compare_.bound(s.compare_delay),
                current_.bound(s.current_delay), limit_.bound(s.limit_delay)});
  ticks_ = 0;
}

Outputs::Range Outputs::staying(const ReferenceSignal& signal, int64_t above_from, int64_t below_to) {
  return signal.raw() ? Range{below_to + 1, INT64_MAX} : Range{INT64_MIN, above_from - 1};
}

// Of values of which the greater one of it and `floor` is in the range (OutputInputs::limited_current()).
Outputs::Range Outputs::at_least(const Range& range, int64_t floor) {
  if (floor > range.high) return {};
  return {floor >= range.low ? INT64_MIN : range.low, range.high};
}

Outputs::Range Outputs::around(const ReferenceSignal& signal, int64_t from, int64_t to, int64_t value) {
  if (signal.raw()) return {from, to};
  return value < from ? Range{INT64_MIN, from - 1} : Range{to + 1, INT64_MAX};
}

// P403, P413, P422, P432, P442 say for which case the signal is 1.
bool Outputs::level(OutputFunction function, const OutputInputs& in, unsigned bit) const {
  using F = OutputFunction;
  using namespace output_flags;
  switch (function) {
    case F::None: return false;
    case F::NoFault: return !in.is(kFault);
    case F::Ready: return in.is(kReady);
    case F::OutputStageOn:
    case F::RotatingField: return in.is(kOutputStage);
    case F::BrakeReleased: return in.is(kBrakeReleased);
    case F::BrakeApplied: return !in.is(kBrakeReleased);
    case F::Standstill: return in.is(kStandstill);
    case F::ParameterSet: return in.is(kSecondSet);
    case F::SpeedReference: return signals_.speed;
    case F::SpeedWindow: return signals_.window;
    case F::SetpointReached: return signals_.compare;
    case F::CurrentReference: return signals_.current;
    case F::CurrentLimit: return signals_.limit;
    case F::NoMotorUtilization1: return !in.is(kMotor1Overloaded);
    case F::NoMotorUtilization2: return !in.is(kMotor2Overloaded);
    case F::NoDrsPrewarning: return !in.is(kDrsPrewarning);
    case F::NoDrsLagError: return !in.is(kDrsLagError);
    case F::DrsInPosition: return in.is(kDrsInPosition);
    case F::PiReference: return false;
    case F::IposInPosition: return in.is(kInPosition);
    case F::IposReferenced: return in.is(kReferenced);
    case F::IposOutput: return (in.ipos_outputs >> bit & 1) != 0;
    case F::NoIposFault: return !in.is(kIposFault);
  }
  return false;
}

}  // namespace ipos::runtime
