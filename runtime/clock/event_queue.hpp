// Virtual time and the queue of everything that happens in it. The order of events is total: time, then
// source, then the order of scheduling; so the same plant gives the same run on any build. Nothing here reads
// a clock.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace ipos::runtime {

using Time = int64_t;  // nanoseconds of virtual time, 0 = power-on of the plant

inline constexpr Time kMicrosecond = 1'000;
inline constexpr Time kMillisecond = 1'000'000;
inline constexpr Time kSecond = 1'000'000'000;
inline constexpr Time kNever = std::numeric_limits<Time>::max();

// A receiver of events; `kind` and `argument` come back as they were scheduled. Must outlive its events.
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
  // goes first. A time before now() counts as now(); what is to come at kNever does not.
  EventId schedule(Time at, uint32_t source, EventTarget& target, uint32_t kind, uint64_t argument = 0);

  // False when the event has run, is running or was cancelled before.
  bool cancel(EventId id);

  // Cancels all events of a target, which may then end its life.
  void cancel_all(const EventTarget& target);

  Time now() const { return now_; }
  Time next_time() const;  // kNever: nothing pending
  size_t pending() const;

  // An event that `source` has had for now() since before that time has run, as the order of events goes.
  bool has_passed(uint32_t source) const { return source < reached_; }

  // Runs the next event; false when there is none.
  bool step();

  // Runs every event up to and including `end`; now() is `end` afterwards.
  void run_until(Time end);

  // The place of an event in the order of all; two of one source and time are not told apart.
  struct Moment {
    Time at;
    uint32_t source;
  };
  // Runs every event before this moment, which is now then.
  void run_before(Moment moment);
  Moment moment() const { return {now_, reached_}; }
  // Of the next event, which there must be.
  Moment next_moment() const { return {next()->at, next()->source}; }

  // What is executed late finds the time that it belongs to, and what has happened by then. Nothing may be
  // scheduled in it before the time it comes back to.
  class Past {
   public:
    Past(EventQueue& queue, Time at, uint32_t source)
        : queue_(queue), now_(queue.now_), reached_(queue.reached_), present_(queue.present_) {
      queue.present_ = std::max(present_, now_);
      queue.now_ = at;
      queue.reached_ = source;
    }
    ~Past() {
      queue_.now_ = now_;
      queue_.reached_ = reached_;
      queue_.present_ = present_;
    }
    // Another time of the past.
    void go_to(Time at) { queue_.now_ = at; }
    Past(const Past&) = delete;
    Past& operator=(const Past&) = delete;

   private:
    EventQueue& queue_;
    Time now_;
    uint32_t reached_;
    Time present_;
  };

  // From within an event: an event of `source` at `at` would be the next of all, and this run goes so far.
  // Then it is that time now, and the caller does at once what it would have scheduled.
  bool advance(Time at, uint32_t source) {
    const bool first = at < rows_[0].first_at && at < rows_[1].first_at && at < heap_first_at_;
    if (at > run_end_ || (!first && !comes_first(at, source))) return false;
    reach(at, source);
    return true;
  }

 private:
  // Ids of events in a row: this bit, the row, the number there. Others have generation and slot.
  static constexpr EventId kInRow = EventId{1} << 63;
  static constexpr int kRowShift = 62;
  static constexpr uint32_t kGenerations = 1U << 31;

  struct Order {
    Time at;
    uint64_t sequence;
    uint32_t source;
  };
  struct Entry : Order {  // of the heap
    uint32_t slot;
  };
  struct Slot {
    EventTarget* target;
    uint64_t argument;
    uint32_t kind;
    uint32_t generation;  // makes an id of an earlier use of the slot invalid
    uint32_t position;    // in heap_
  };
  struct Waiting : Order {  // of a row
    uint32_t kind;
    EventTarget* target;  // null: cancelled
    uint64_t argument;
  };
  static bool before(const Order& a, const Order& b) {
    if (a.at != b.at) return a.at < b.at;
    if (a.source != b.source) return a.source < b.source;
    return a.sequence < b.sequence;
  }

  // Events that were scheduled in their order. Only events at most `reach` ahead are accepted; a later one
  // would block the row.
  struct Row {
    EventId ids;  // from this one on: kInRow and the number of the row
    Time reach;
    std::vector<Waiting> ring{};  // its size is a power of 2
    uint64_t mask = 0;
    uint64_t begin = 0;  // numbers of its entries, first and after the last
    uint64_t end = 0;
    Time first_at = kNever;  // of the first entry
    Time last_at = 0;        // of the last one, and its source
    uint32_t last_source = 0;

    bool empty() const { return begin == end; }
    Waiting& at(uint64_t number) { return ring[static_cast<size_t>(number & mask)]; }
    const Waiting& at(uint64_t number) const { return ring[static_cast<size_t>(number & mask)]; }
    const Waiting& front() const { return at(begin); }
    bool takes(Time time, uint32_t source, Time now) const {
      return time - now <= reach && end - begin <= mask &&
             (last_at < time || (last_at == time && last_source <= source) || empty());
    }
    EventId join(const Waiting& event) {
      if (empty()) first_at = event.at;
      last_at = event.at;
      last_source = event.source;
      at(end) = event;
      return ids | end++;
    }
    void pop() {
      do {
        if (++begin == end) {
          first_at = kNever;
          return;
        }
      } while (front().target == nullptr);
      first_at = front().at;
    }
    // Its order stays known when it is cancelled; only at the front it must not stand.
    void cancel(uint64_t number) {
      at(number).target = nullptr;
      if (number == begin) pop();
    }
  };

  // That with the next event; empty when both are.
  const Row& first_row() const {
    const Row& near = rows_[0];
    const Row& far = rows_[1];
    if (near.first_at != far.first_at) return near.first_at < far.first_at ? near : far;
    return near.empty() || (!far.empty() && before(far.front(), near.front())) ? far : near;
  }
  bool in_heap(const Row& first) const {  // the next event is there, not in the row
    return heap_first_at_ <= first.first_at && !heap_.empty() &&
           (first.empty() || before(heap_.front(), first.front()));
  }
  const Order* next() const;
  bool comes_first(Time at, uint32_t source) const;
  bool run(Time end, bool all);
  bool run_from_heap(Time end);
  void reach(Time at, uint32_t source) {
    reached_ = at == now_ ? std::max(reached_, source) : source;
    now_ = at;
  }
  EventId schedule_behind(Time at, uint32_t source, EventTarget& target, uint32_t kind, uint64_t argument);
  EventId push(Time at, uint32_t source, EventTarget& target, uint32_t kind, uint64_t argument);
  void place(size_t position, const Entry& entry);
  void sift_up(size_t position, const Entry& entry);
  void sift_down(size_t position, const Entry& entry);
  void remove(size_t position);
  void heap_changed() { heap_first_at_ = heap_.empty() ? kNever : heap_.front().at; }

  Time now_ = 0;
  uint32_t reached_ = 0;  // the highest source that had an event at now()
  Time present_ = 0;  // within a Past: the time it comes back to, and nothing is scheduled before that
  Time run_end_ = -1;  // of run_until()
  uint64_t next_sequence_ = 0;
  // What is scheduled in its order anyway, as the ticks of all stations are, stands in a row; the heap has
  // the rest. One row is for ticks of a millisecond, one for the telegrams of stations that sleep.
  std::array<Row, 2> rows_{{{kInRow, kMillisecond}, {kInRow | EventId{1} << kRowShift, 10 * kMillisecond}}};
  std::vector<Entry> heap_;
  Time heap_first_at_ = kNever;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_slots_;
};

}  // namespace ipos::runtime
