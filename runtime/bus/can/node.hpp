// What a CAN line and its participants say to each other: nodes send and receive, observers only look.
#pragma once

#include <cstdint>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/node_id.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

class CanLine;

enum class SendStatus : uint8_t { Queued, NotActive, QueueFull, InvalidFrame };

enum class NotSent : uint8_t {
  NoAcknowledge,  // nobody else on the line; the frame stays queued and is sent again
  Collision,      // same identifier, other data, at the same time; the frame stays queued and is sent again
  Dropped,        // bus-off or cut off: the frame is gone
};

// A participant. `tag` is what the frame was queued with. Calls come in virtual time order and may send.
class CanNode {
 public:
  virtual void on_frame(Time now, const Frame& frame) = 0;
  virtual void on_sent(Time now, const Frame& frame, uint64_t tag) = 0;
  virtual void on_not_sent(Time now, const Frame& frame, uint64_t tag, NotSent reason) = 0;

 protected:
  ~CanNode() = default;
};

// The sending half of a participant, for protocol machines that share one node.
class FrameSender {
 public:
  virtual SendStatus send(const Frame& frame, uint64_t tag) = 0;
  // Takes back every waiting frame with this tag; one on the wire is not sent again should it fail.
  virtual void withdraw(uint64_t tag) = 0;

 protected:
  ~FrameSender() = default;
};

struct FrameRecord {
  Frame frame;
  NodeId sender;
  Time start;     // begin of the start-of-frame bit
  Time end;       // end of the last end-of-frame bit: the moment of delivery
  uint32_t bits;  // on the wire, with intermission
};

enum class LineEventKind : uint8_t {
#define LINE_EVENT(name, text) name,
#include "runtime/bus/can/line_events.def"
};

struct LineEvent {
  LineEventKind kind;
  Time time;
  NodeId node;
  NodeId other = kNoNode;  // the partner of a collision
  uint32_t id = 0;         // identifier of the frame, where there is one
};

class CanObserver {
 public:
  virtual void on_frame(const CanLine& line, const FrameRecord& record) = 0;
  virtual void on_line_event(const CanLine& line, const LineEvent& event) = 0;

 protected:
  ~CanObserver() = default;
};

}  // namespace ipos::runtime
