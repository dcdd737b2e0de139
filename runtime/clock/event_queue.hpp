// Virtual time and the queue of everything that happens in it. The order of events is total: time, then
// source, then the order of scheduling; so the same plant gives the same run on any build. Nothing here reads
// a clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace ipos::runtime {

using Time = int64_t;  // nanoseconds of virtual time, 0 = power-on of the plant

inline constexpr Time kMicrosecond = 1'000;
inline constexpr Time kMillisecond = 1'000'000;
inline constexpr Time kSecond = 1'000'000'000;
inline constexpr Time kNever = std::numeric_limits<Time>::max();

// Whoever takes events; `kind` and `argument` come back as they were scheduled. Must outlive its events.
class EventTarget {
 public:
  virtual void on_event(Time now, uint32_t kind, uint64_t argument) = 0;

 protected:
  ~EventTarget() = default;
};

using EventId = uint64_t;
inline constexpr EventId kNoEvent = 0;

class EventQueue {
 public:
  // Room for `capacity` pending events; more are possible, at the price of an allocation.
  explicit EventQueue(size_t capacity = 256);

  // `source` is the number the plant gives each of its members; among events of one time the lower source
  // goes first. A time before now() counts as now().
  EventId schedule(Time at, uint32_t source, EventTarget& target, uint32_t kind, uint64_t argument = 0);

  // False when the event has run, is running or was cancelled before.
  bool cancel(EventId id);

  // Cancels all events of a target, which may then end its life.
  void cancel_all(const EventTarget& target);

  Time now() const { return now_; }
  Time next_time() const { return heap_.empty() ? kNever : heap_.front().at; }  // kNever: nothing pending
  size_t pending() const { return heap_.size(); }

  // An event that `source` has had for now() since before that time has run, as the order of events goes.
  bool has_passed(uint32_t source) const { return source < reached_; }

  // Runs the next event; false when there is none.
  bool step();

  // Runs every event up to and including `end`; now() is `end` afterwards.
  void run_until(Time end);

 private:
  struct Entry {
    Time at;
    uint64_t sequence;
    uint32_t source;
    uint32_t slot;
  };
  struct Slot {
    EventTarget* target;
    uint64_t argument;
    uint32_t kind;
    uint32_t generation;  // makes an id of an earlier use of the slot invalid
    uint32_t position;    // in heap_
  };

  static bool before(const Entry& a, const Entry& b);
  void place(size_t position, const Entry& entry);
  void sift_up(size_t position, const Entry& entry);
  void sift_down(size_t position, const Entry& entry);
  void remove(size_t position);

  Time now_ = 0;
  uint32_t reached_ = 0;  // the highest source that had an event at now()
  uint64_t next_sequence_ = 0;
  std::vector<Entry> heap_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_slots_;
};

}  // namespace ipos::runtime
