// Frames that stations at rest leave to a CAN line: each is sent again and again as it is, until its station takes it back
// or the time is over for which it was left here. The line gets every one of them when the station would have sent it, in the
// order of events, but one event serves all that come before anything else happens.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/line/node_id.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

class CanLine;

struct StandingFrame {
  Time at;      // when it is sent next
  Time until;   // from then on it is not
  Frame frame;  // canonical()
  uint32_t tag;
  uint32_t cycle;   // ms
  uint32_t source;  // of its station's events
  NodeId node;
};

class StandingFrames final : private EventTarget {
 public:
  static constexpr size_t kOfNode = 2;  // room for so many a node

  StandingFrames(EventQueue& queue, CanLine& line) : queue_(queue), line_(line) {}

  void grow(size_t nodes);
  bool has_room(size_t frames) const { return frames_.size() + frames <= frames_.capacity(); }
  // There must be room. A frame of the node with this tag that still waits when its time comes is overtaken.
  void add(const StandingFrame& frame);
  // All of the node. Those whose time has come have been sent.
  void remove(NodeId node);

 private:
  using Place = std::vector<StandingFrame>::iterator;

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void send_first();
  void sink(Place place);
  void begin_with_first();
  void schedule();

  EventQueue& queue_;
  CanLine& line_;
  // A ring in the order in which they are sent next. Those of one cycle follow each other for ever: only the place of the
  // first goes on.
  std::vector<StandingFrame> frames_;
  Place first_ = frames_.begin();
  EventId event_ = kNoEvent;  // of the first
  Time event_at_ = 0;
  uint32_t event_source_ = 0;
};

}  // namespace ipos::runtime
