// Worst-case response times of CAN messages: Davis, Burns, Bril, Lukkien, "Controller Area Network (CAN)
// schedulability analysis: refuted, revisited and revised" (2007), with every instance of the busy period.
//
// It holds when each station offers the waiting frame with the lowest identifier, and without errors on the
// line. The length of a frame is its worst case with stuff bits and intermission.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

struct PeriodicFrame {
  uint32_t id = 0;  // the lower one wins
  Time length = 0;  // on the wire, worst case
  Time period = 0;  // shortest distance of two
  Time jitter = 0;  // between the event and the frame being ready to be sent
};

struct ResponseTime {
  bool bounded = false;  // false: the line cannot carry this and all before it
  Time blocking = 0;     // by a lower-priority frame under way
  Time busy_period = 0;
  uint32_t instances = 0;
  Time worst = 0;  // from the event to the end of the frame
};

// One result for each frame, in their order. Frames of one identifier count as of equal priority: all others
// of it interfere.
std::vector<ResponseTime> response_times(std::span<const PeriodicFrame> frames, Time bit_time);

}  // namespace ipos::runtime
