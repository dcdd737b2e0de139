// A binary heap of small entries that know their slot, and slots that know their place in the heap: so an
// event can be cancelled in logarithmic time, and nothing is allocated once both vectors have their size. In
// front of it two rows, where most events come and go in constant time.
#include "runtime/clock/event_queue.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

namespace ipos::runtime {

EventQueue::EventQueue(size_t capacity) {
  for (Row& row : rows_) {
    row.ring.resize(std::bit_ceil(capacity + 1));
    row.mask = row.ring.size() - 1;
  }
  heap_.reserve(capacity);
  slots_.reserve(capacity);
  free_slots_.reserve(capacity);
}

void EventQueue::place(size_t position, const Entry& entry) {
  heap_[position] = entry;
  slots_[entry.slot].position = static_cast<uint32_t>(position);
}

void EventQueue::sift_up(size_t position, const Entry& entry) {
  while (position > 0) {
    const size_t parent = (position - 1) / 2;
    if (!before(entry, heap_[parent])) break;
    place(position, heap_[parent]);
    position = parent;
  }
  place(position, entry);
}

void EventQueue::sift_down(size_t position, const Entry& entry) {
  for (;;) {
    size_t child = 2 * position + 1;
    if (child >= heap_.size()) break;
    if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
    if (!before(heap_[child], entry)) break;
    place(position, heap_[child]);
    position = child;
  }
  place(position, entry);
}

void EventQueue::remove(size_t position) {
  assert(position < heap_.size());
  const uint32_t slot = heap_[position].slot;
  const Entry last = heap_.back();
  heap_.pop_back();
  if (position < heap_.size()) {
    if (before(last, heap_[position]))
      sift_up(position, last);
    else
      sift_down(position, last);
  }
  heap_changed();
  if (++slots_[slot].generation == kGenerations) slots_[slot].generation = 1;
  free_slots_.push_back(slot);
}

EventId EventQueue::schedule(Time at, uint32_t source, EventTarget& target, uint32_t kind,
                             uint64_t argument) {
  assert(present_ == 0 || at >= present_);
  at = std::max(at, now_);
  if (!rows_[0].takes(at, source, now_)) return schedule_behind(at, source, target, kind, argument);
  return rows_[0].join({{at, next_sequence_++, source}, kind, &target, argument});
}

// What the first row does not take.
EventId EventQueue::schedule_behind(Time at, uint32_t source, EventTarget& target, uint32_t kind,
                                    uint64_t argument) {
  if (!rows_[1].takes(at, source, now_)) return push(at, source, target, kind, argument);
  return rows_[1].join({{at, next_sequence_++, source}, kind, &target, argument});
}

EventId EventQueue::push(Time at, uint32_t source, EventTarget& target, uint32_t kind, uint64_t argument) {
  const Order order{at, next_sequence_++, source};
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<uint32_t>(slots_.size()));
    slots_.push_back({nullptr, 0, 0, 1, 0});
  }
  const uint32_t index = free_slots_.back();
  free_slots_.pop_back();
  Slot& slot = slots_[index];
  slot.target = &target;
  slot.argument = argument;
  slot.kind = kind;
  const Entry entry{order, index};
  heap_.push_back(entry);
  sift_up(heap_.size() - 1, entry);
  heap_changed();
  return (EventId{slot.generation} << 32) | index;
}

bool EventQueue::cancel(EventId id) {
  if ((id & kInRow) != 0) {
    Row& row = rows_[id >> kRowShift & 1];
    const uint64_t number = id & ((EventId{1} << kRowShift) - 1);
    if (number < row.begin || number >= row.end || row.at(number).target == nullptr) return false;
    row.cancel(number);
    return true;
  }
  const uint32_t index = static_cast<uint32_t>(id);
  if (index >= slots_.size() || slots_[index].generation != id >> 32) return false;
  assert(heap_[slots_[index].position].slot == index);  // slot and entry know each other
  remove(slots_[index].position);
  return true;
}

void EventQueue::cancel_all(const EventTarget& target) {
  for (size_t position = heap_.size(); position-- > 0;)
    if (position < heap_.size() && slots_[heap_[position].slot].target == &target) {
      remove(position);
      position = heap_.size();  // the order of the others has changed
    }
  for (Row& row : rows_)
    for (uint64_t number = row.begin; number != row.end; ++number)
      if (row.at(number).target == &target) row.cancel(number);
}

const EventQueue::Order* EventQueue::next() const {
  const Row& row = first_row();
  if (in_heap(row)) return &heap_.front();
  return row.empty() ? nullptr : &row.front();
}

Time EventQueue::next_time() const {
  const Order* event = next();
  return event == nullptr ? kNever : event->at;
}

size_t EventQueue::pending() const {
  size_t count = heap_.size();
  for (const Row& row : rows_)
    for (uint64_t number = row.begin; number != row.end; ++number) count += row.at(number).target != nullptr;
  return count;
}

// The next event, when it is not later than `end`, which is before kNever, or all of them.
bool EventQueue::run(Time end, bool all) {
  do {
    Row& row = const_cast<Row&>(first_row());
    if (in_heap(row)) {
      if (!run_from_heap(end)) return false;
      continue;
    }
    if (row.first_at > end) return false;
    const Waiting& event = row.front();
    assert(row.first_at >= now_ && event.target != nullptr);  // time does not go back
    reach(row.first_at, event.source);
    row.pop();
    event.target->on_event(now_, event.kind, event.argument);
  } while (all);
  return true;
}

bool EventQueue::run_from_heap(Time end) {
  if (heap_first_at_ > end) return false;
  const Entry entry = heap_.front();
  const Slot event = slots_[entry.slot];
  assert(entry.at >= now_ && event.target != nullptr);  // time does not go back
  remove(0);
  reach(entry.at, entry.source);
  event.target->on_event(entry.at, event.kind, event.argument);
  return true;
}

bool EventQueue::step() { return run(kNever - 1, false); }

void EventQueue::run_until(Time end) {
  run_end_ = end;
  run(std::min(end, kNever - 1), true);
  run_end_ = -1;
  if (end < now_) return;
  now_ = end;
  reached_ = UINT32_MAX;
}

// The last events one by one: none of them may advance() beyond the moment.
void EventQueue::run_before(Moment moment) {
  if (moment.at - 1 > now_) run_until(moment.at - 1);
  for (const Order* event = next(); event != nullptr && event->at <= moment.at; event = next()) {
    if (event->at == moment.at && event->source >= moment.source) break;
    step();
  }
  reach(moment.at, moment.source);
}

// Before the next event, if it were scheduled now.
bool EventQueue::comes_first(Time at, uint32_t source) const {
  const Order* event = next();
  return event == nullptr || before({at, next_sequence_, source}, *event);
}

}  // namespace ipos::runtime
