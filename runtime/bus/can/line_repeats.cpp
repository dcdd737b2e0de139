// What is left out while a station repeats a frame that nobody acknowledges, and how the line comes to be as if nothing
// had been left out. When such a transfer has ended the next ones are foreseen, for a second at most; whatever changes
// something of the line wakes it first. The plain run is repeat_in_turn(); tests compare both.
#include <algorithm>
#include <utility>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/can/line_event_kinds.hpp"

namespace ipos::runtime {

// The transfer that has just ended would be followed by others like it from this bit on: then they are foreseen.
bool CanLine::begin_repeats(uint64_t bit) {
  const Transfer& last = segments_[0].transfer;
  if (last.outcome != Transfer::Outcome::NoAcknowledge || last.senders.size() != 1 || in_turn_) return false;
  const NodeId id = last.senders.front().node;
  const Node& node = nodes_[id];
  // Its counter does not change any more, and what happens was told.
  if (node.counters.state() != ErrorState::Passive || !node.unacknowledged || node.node->minds_repeats()) return false;
  if (node.queue.empty() || node.queue.front().frame != last.senders.front().frame || !contenders_.all_ready(bit))
    return false;
  if (last.flagged || !strangers_.empty()) return false;  // others hear it, or take part
  if (bit != segments_[0].free_bit + kSuspendBits || recovering_ || shorts_ != 0 || faults_.may_strike(queue_.now())) return false;
  const auto active = [](const Node& other) { return is_active(other); };
  if (!is_active(node) || std::count_if(nodes_.begin(), nodes_.end(), active) != 1) return false;
  repeats_ = {id, bit, last.bits + kSuspendBits, last.end, last.bits, 0};
  repeats_.times = baud_ / repeats_.period;
  segments_[0].start_bit = repeats_.start(repeats_.times);
  segments_[0].start_event = queue_.schedule(static_cast<Time>(segments_[0].start_bit) * bit_time_, source_, *this,
                                             line_event::kStart, 0);
  return true;
}

// What the line does in this bit has happened, and nothing of a later one.
uint64_t CanLine::passed_bit() const {
  const Time now = queue_.now();
  const auto bit = static_cast<uint64_t>(now / bit_time_);
  return now % bit_time_ == 0 && bit != 0 && !queue_.has_passed(source_) ? bit - 1 : bit;
}

// As after the last of them that has ended; the one under way goes on as any other.
void CanLine::catch_up() {
  const Repeats repeats = std::exchange(repeats_, {});
  const uint64_t passed = passed_bit();
  const uint64_t ended = repeats.ended(passed);
  Segment& segment = segments_[0];
  Node& node = nodes_[repeats.sender];
  cancel_start(segment);
  if (ended != 0) {
    repeats.count(meter_, ended);
    segment.end_at(repeats.start(ended - 1) + repeats.bits);
    known_.stir_all(node.queue.front().frame);
    node.suspended_until = segment.free_bit + kSuspendBits;
    queue_changed(repeats.sender);
  }
  const uint64_t next = repeats.start(ended);
  if (next > passed || !begin_transfer(0, next)) return schedule_start(0);
  queue_.schedule(static_cast<Time>(next + repeats.end) * bit_time_, source_, *this, line_event::kEnd, 0);
}

}  // namespace ipos::runtime
