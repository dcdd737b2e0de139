// Virtual time and the queue of everything that happens in it. The order of events is total: time, then
// source, then the order of scheduling; so the same plant gives the same run on any build. Nothing here reads
// a clock.
#pragma once

#include <algorithm>
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
  Time next_time() const {  // kNever: nothing pending
    const Time in_row = row_begin_ == row_end_ ? kNever : row_at(row_begin_).at;
    return heap_.empty() ? in_row : std::min(in_row, heap_.front().at);
  }
  size_t pending() const { return heap_.size() + row_count_; }

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
    uint32_t position;    // in heap_, or number in the row
    bool in_row;
  };
  static constexpr uint32_t kGone = ~0U;  // slot of a cancelled entry of the row
  static constexpr Time kNear = kMillisecond;

  static bool before(const Entry& a, const Entry& b) {
    if (a.at != b.at) return a.at < b.at;
    if (a.source != b.source) return a.source < b.source;
    return a.sequence < b.sequence;
  }
  void place(size_t position, const Entry& entry);
  void sift_up(size_t position, const Entry& entry);
  void sift_down(size_t position, const Entry& entry);
  void remove(size_t position);
  Entry& row_at(uint32_t number) { return row_[number & (row_.size() - 1)]; }
  const Entry& row_at(uint32_t number) const { return row_[number & (row_.size() - 1)]; }
  bool joins_row(const Entry& entry) const {
    return entry.at - now_ <= kNear && row_end_ - row_begin_ < row_.size() &&
           (row_begin_ == row_end_ || !before(entry, row_at(row_end_ - 1)));
  }
  void remove_from_row(uint32_t number);
  void release(uint32_t slot) {
    ++slots_[slot].generation;
    free_slots_.push_back(slot);
  }

  Time now_ = 0;
  uint32_t reached_ = 0;  // the highest source that had an event at now()
  uint64_t next_sequence_ = 0;
  // What is scheduled in its order anyway, as the ticks of all stations are, stands in a row; the heap has
  // the rest. Far events stay out of the row, or nothing could join behind them.
  std::vector<Entry> row_;  // a ring, its size a power of 2
  uint32_t row_begin_ = 0;  // numbers of its entries, first and behind the last
  uint32_t row_end_ = 0;
  uint32_t row_count_ = 0;  // of them not cancelled
  std::vector<Entry> heap_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_slots_;
};

}  // namespace ipos::runtime
