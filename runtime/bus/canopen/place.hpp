// Where the parts of a node send and how they wait: the line, the queue of events, and a timer that can be
// started again.
#pragma once

#include <cstdint>

#include "runtime/bus/can/node.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime::canopen {

constexpr Time kInhibitUnit = 100 * kMicrosecond;  // of inhibit times, in 1015h and in PDO parameters (CiA 301)

struct Place {
  EventQueue& queue;
  uint32_t source;
  FrameSender& sender;
  uint64_t tag;  // of the frames of a node: this one and the kTags - 1 after it
};
inline constexpr uint64_t kTags =
    5;  // one for each transmit PDO, whose latest frame counts, and one for the rest

class Timer final : private EventTarget {
 public:
  class Owner {
   public:
    virtual void on_timer(Time now, uint32_t kind) = 0;

   protected:
    ~Owner() = default;
  };

  Timer(const Place& place, Owner& owner, uint32_t kind) : place_(place), owner_(owner), kind_(kind) {}
  ~Timer() { stop(); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  void start(Time at) {
    stop();
    id_ = place_.queue.schedule(at, place_.source, *this, 0);
  }
  void stop() {
    if (runs()) place_.queue.cancel(id_);
    id_ = kNoEvent;
  }
  bool runs() const { return id_ != kNoEvent; }

 private:
  void on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) override {
    id_ = kNoEvent;
    owner_.on_timer(now, kind_);
  }

  Place place_;
  Owner& owner_;
  uint32_t kind_;
  EventId id_ = kNoEvent;
};

}  // namespace ipos::runtime::canopen
