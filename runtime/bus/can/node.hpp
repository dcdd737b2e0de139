// What a CAN line and its participants say to each other: nodes send and receive, observers only look.
#pragma once

#include <cstdint>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/line/node_id.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

class CanLine;

enum class SendStatus : uint8_t { Queued, NotActive, QueueFull, InvalidFrame };

enum class NotSent : uint8_t {
  NoAcknowledge,  // nobody else on the line; the frame stays queued and is sent again
  Collision,      // same identifier, other data, at the same time; the frame stays queued and is sent again
  Corrupted,      // a line fault destroyed the frame; it stays queued and is sent again
  Dropped,        // bus-off or cut off: the frame is gone
};

// A participant. `tag` is what the frame was queued with. Calls come in virtual time order and may send.
class CanNode {
 public:
  virtual void on_frame(Time now, const Frame& frame) = 0;
  virtual void on_sent(Time now, const Frame& frame, uint64_t tag) = 0;
  virtual void on_not_sent(Time now, const Frame& frame, uint64_t tag, NotSent reason) = 0;
  // False: while a frame stays queued and is sent again, it does nothing when it hears once more that nobody has
  // acknowledged it.
  virtual bool minds_repeats() const { return true; }
  // Too many errors: it takes no part any more until it has recovered; its sender can ask for that.
  virtual void on_bus_off(Time /*now*/) {}

 protected:
  ~CanNode() = default;
};

// The sending half of a participant, for protocol machines that share one node.
class FrameSender {
 public:
  virtual SendStatus send(const Frame& frame, uint64_t tag) = 0;
  // Takes back every waiting frame with this tag; one on the wire is not sent again should it fail.
  virtual void withdraw(uint64_t tag) = 0;
  // Both: of the frames with this tag only this one still waits.
  virtual void send_latest(const Frame& frame, uint64_t tag) {
    withdraw(tag);
    send(frame, tag);
  }
  // Asks to come back after bus-off.
  virtual void recover() {}
  // Frames with this standard identifier are wanted from now on. Without effect where all are heard anyway.
  virtual void listen(uint32_t /*id*/) {}

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

// An error frame that all who listen have seen: an active error flag, on its end the delimiter.
struct ErrorRecord {
  Time start;  // of the frame that it destroyed
  Time end;
  uint32_t bits;        // both together, with intermission
  bool unacknowledged;  // nobody had acknowledged the frame
};

enum class LineEventKind : uint8_t {
#define LINE_EVENT(name, text) name,
#include "runtime/bus/can/line_events.def"
};

struct LineEvent {
  LineEventKind kind;
  Time time;
  NodeId node;             // kNoNode: the line as a whole
  NodeId other = kNoNode;  // the partner of a collision; the station before a cut
  uint32_t id = 0;         // identifier of the frame, where there is one
  uint8_t fault = 0;       // FaultKind of the events about planted faults
  size_t senders = 1;      // how many stations send the frame
  bool of_line = false;    // the fault was not planted: the data of the line say it
};

// Looks at what happens to a line, but not at its frames.
class LineObserver {
 public:
  virtual void on_line_event(const CanLine& line, const LineEvent& event) = 0;

 protected:
  ~LineObserver() = default;
};

class CanObserver : public LineObserver {
 public:
  virtual void on_frame(const CanLine& line, const FrameRecord& record) = 0;
  virtual void on_error_frame(const CanLine& /*line*/, const ErrorRecord& /*record*/) {}

 protected:
  ~CanObserver() = default;
};

}  // namespace ipos::runtime
