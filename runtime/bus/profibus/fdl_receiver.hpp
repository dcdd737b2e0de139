// Frames from octets as they come from a line, one at a time. A receiver drops in silence what has an error;
// here each dropped frame is told once, for people. After an error nothing counts until the line has paused.
#pragma once

#include <vector>

#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/bus/rs485/character.hpp"

namespace ipos::profibus {

using runtime::Time;

// What was heard from the first octet to the last.
struct Reception {
  tl::expected<FdlFrame, FrameError> frame;
  Octets octets;
  Time start = 0;
  Time end = 0;
};

struct ReceiverLimits {
  Time gap;     // at most between two characters of a frame
  Time idle;    // at least before a request or a token; 0: not looked at
  Time resync;  // at least after an error
};

// The rules of the norm; the nanosecond is for times that were rounded. That a gap is seen from one bit on
// is ours.
constexpr ReceiverLimits strict_limits(uint32_t baud) {
  const Time idle = 33 * runtime::kSecond / baud - 1;
  return {runtime::kSecond / baud, idle, idle};
}
// For a port of the operating system, which hands over characters in lumps (ours).
inline constexpr ReceiverLimits kPortLimits{10 * runtime::kMillisecond, 0, runtime::kMillisecond};

class FdlReceiver {
 public:
  explicit FdlReceiver(ReceiverLimits limits) : limits_(limits) {}

  // Up to two: a frame that was cut off ends when the next one begins.
  std::vector<Reception> take(const runtime::Character& character);

  bool receiving() const { return !octets_.empty(); }

 private:
  void fail(FrameError error, std::vector<Reception>& receptions);
  void finish(tl::expected<FdlFrame, FrameError> frame, std::vector<Reception>& receptions);

  ReceiverLimits limits_;
  Octets octets_;  // of the frame under way
  Time start_ = 0;
  Time idle_before_ = 0;
  Time quiet_since_ = 0;
  bool heard_ = false;  // anything at all
  bool skipping_ = false;
};

}  // namespace ipos::profibus
