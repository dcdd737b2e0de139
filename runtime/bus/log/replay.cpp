// One event a frame.
#include "runtime/bus/log/replay.hpp"

#include <algorithm>

#include "runtime/bus/can/frame_bits.hpp"

namespace ipos::runtime {

Replay::Replay(EventQueue& queue, uint32_t source, std::vector<LogEntry> entries, Time begin)
    : queue_(queue), source_(source), entries_(std::move(entries)) {
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const LogEntry& a, const LogEntry& b) { return a.time < b.time; });
  if (entries_.empty()) return;
  const Time shift = begin - entries_.front().time;
  for (LogEntry& entry : entries_) entry.time += shift;
}

void Replay::start(FrameSender& sender, Time bit_time) {
  sender_ = &sender;
  bit_time_ = bit_time;
  if (!entries_.empty()) schedule(0);
}

// It begins at the next bit boundary and ends without the intermission.
void Replay::schedule(size_t entry) {
  const Time length = (frame_bits(entries_[entry].frame) - kIntermissionBits + 1) * bit_time_;
  queue_.schedule(std::max(queue_.now(), entries_[entry].time - length), source_, *this, 0, entry);
}

void Replay::on_event(Time /*now*/, uint32_t /*kind*/, uint64_t argument) {
  const auto entry = static_cast<size_t>(argument);
  if (sender_->send(entries_[entry].frame, 0) != SendStatus::Queued) ++refused_;
  if (entry + 1 < entries_.size()) schedule(entry + 1);
}

void Replay::on_not_sent(Time, const Frame&, uint64_t, NotSent reason) {
  if (reason == NotSent::Dropped) ++refused_;
}

}  // namespace ipos::runtime
