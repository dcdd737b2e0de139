// How late a run may be that keeps in step with the clock of the machine.
#pragma once

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

// What is later than this is not made up for (ours): after a process that was stopped for seconds, a real bus would get all
// the telegrams of that time at once, with setpoints of then. The clock of the run goes on from there.
inline constexpr Time kForgiven = 200 * kMillisecond;

}  // namespace ipos::runtime
