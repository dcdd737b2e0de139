// The steps, each falling through to the next when its time is over.
#include "runtime/motion/brake_sequence.hpp"

namespace ipos::runtime {

void BrakeSequence::begin_motion(const BrakeTimes& times) {
  if (phase_ == AxisPhase::Off) enter(AxisPhase::Magnetizing);
  // The motor is magnetized already.
  if (phase_ == AxisPhase::Applying || phase_ == AxisPhase::StandstillCurrent) enter(AxisPhase::Releasing);
  if (phase_ == AxisPhase::Magnetizing && over(times.premagnetize)) enter(AxisPhase::Releasing);
  if (phase_ == AxisPhase::Releasing && over(times.release)) enter(AxisPhase::Moving);
}

void BrakeSequence::stop(const BrakeTimes& times, bool standing, bool hold_current) {
  if (phase_ == AxisPhase::Magnetizing) enter(AxisPhase::Off);
  // A shaft that was found turning has to be stopped first.
  if (phase_ == AxisPhase::Releasing) enter(standing ? AxisPhase::Applying : AxisPhase::Moving);
  if (phase_ == AxisPhase::Moving && standing) enter(AxisPhase::Applying);
  if (phase_ == AxisPhase::Applying && over(times.apply)) enter(AxisPhase::Off);
  if (phase_ == AxisPhase::Off && standing && hold_current) enter(AxisPhase::StandstillCurrent);
  if (phase_ == AxisPhase::StandstillCurrent && !hold_current) enter(AxisPhase::Off);
}

}  // namespace ipos::runtime
