// A binary heap of small entries that know their slot, and slots that know their place in the heap: so an
// event can be cancelled in logarithmic time, and nothing is allocated once both vectors have their size. In
// front of it the row, where most events come and go in constant time.
#include "runtime/clock/event_queue.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace ipos::runtime {

EventQueue::EventQueue(size_t capacity) : row_(std::bit_ceil(capacity + 1)) {
  heap_.reserve(capacity);
  slots_.reserve(capacity);
  free_slots_.reserve(capacity);
}

void EventQueue::place(size_t position, const Entry& entry) {
  heap_[position] = entry;
  slots_[entry.slot].position = static_cast<uint32_t>(position);
  slots_[entry.slot].in_row = false;
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
  const uint32_t slot = heap_[position].slot;
  const Entry last = heap_.back();
  heap_.pop_back();
  if (position < heap_.size()) {
    if (before(last, heap_[position]))
      sift_up(position, last);
    else
      sift_down(position, last);
  }
  release(slot);
}

// Its order stays known when it is cancelled; only at the front it must not stand.
void EventQueue::remove_from_row(uint32_t number) {
  release(std::exchange(row_at(number).slot, kGone));
  --row_count_;
  while (row_begin_ != row_end_ && row_at(row_begin_).slot == kGone) ++row_begin_;
}

EventId EventQueue::schedule(Time at, uint32_t source, EventTarget& target, uint32_t kind,
                             uint64_t argument) {
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<uint32_t>(slots_.size()));
    slots_.push_back({nullptr, 0, 0, 1, 0, false});
  }
  const uint32_t index = free_slots_.back();
  free_slots_.pop_back();
  Slot& slot = slots_[index];
  slot.target = &target;
  slot.argument = argument;
  slot.kind = kind;
  const Entry entry{std::max(at, now_), next_sequence_++, source, index};
  if (joins_row(entry)) {
    slot.position = row_end_;
    slot.in_row = true;
    row_at(row_end_++) = entry;
    ++row_count_;
  } else {
    heap_.push_back(entry);
    sift_up(heap_.size() - 1, entry);
  }
  return (EventId{slot.generation} << 32) | index;
}

bool EventQueue::cancel(EventId id) {
  const uint32_t index = static_cast<uint32_t>(id);
  if (id == kNoEvent || index >= slots_.size() || slots_[index].generation != id >> 32) return false;
  if (slots_[index].in_row)
    remove_from_row(slots_[index].position);
  else
    remove(slots_[index].position);
  return true;
}

void EventQueue::cancel_all(const EventTarget& target) {
  for (size_t position = heap_.size(); position-- > 0;)
    if (position < heap_.size() && slots_[heap_[position].slot].target == &target) {
      remove(position);
      position = heap_.size();  // the order of the others has changed
    }
  for (uint32_t number = row_begin_; number != row_end_; ++number)
    if (row_at(number).slot != kGone && slots_[row_at(number).slot].target == &target)
      remove_from_row(number);
}

bool EventQueue::step() {
  const bool in_row = row_begin_ != row_end_;
  if (heap_.empty() && !in_row) return false;
  const bool from_row = in_row && (heap_.empty() || before(row_at(row_begin_), heap_.front()));
  const Entry entry = from_row ? row_at(row_begin_) : heap_.front();
  const Slot event = slots_[entry.slot];
  if (from_row)
    remove_from_row(row_begin_);
  else
    remove(0);
  reached_ = entry.at == now_ ? std::max(reached_, entry.source) : entry.source;
  now_ = entry.at;
  event.target->on_event(now_, event.kind, event.argument);
  return true;
}

void EventQueue::run_until(Time end) {
  while (next_time() <= end && step()) {
  }
  if (end < now_) return;
  now_ = end;
  reached_ = UINT32_MAX;
}

}  // namespace ipos::runtime
