// A frame that nobody acknowledges, sent again and again by an error-passive station that is alone: it fails each time in
// the same way and changes nothing (ISO 11898-1: its error counter stays). The next repetitions are counted in one step.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/bus/line/line_load.hpp"
#include "runtime/bus/line/node_id.hpp"

namespace ipos::runtime {

struct Repeats {
  NodeId sender = kNoNode;
  uint64_t begin = 0;   // bit in which the first of them starts
  uint64_t period = 0;  // from start to start
  uint32_t end = 0;     // bits from a start to the end of its error delimiter
  uint32_t bits = 0;    // to the end of the intermission
  uint64_t times = 0;   // 0: none are left to be counted

  bool any() const { return times != 0; }
  uint64_t start(uint64_t n) const { return begin + n * period; }
  // How many have come to their end when what is due in the bit `passed` has happened.
  uint64_t ended(uint64_t passed) const {
    return !any() || passed < begin + end ? 0 : std::min(times, (passed - begin - end) / period + 1);
  }
  void count(LoadMeter& meter, uint64_t ended) const { meter.add_repeated(begin, bits, period, ended); }
};

}  // namespace ipos::runtime
