// The order of standing frames, and the one event that they have in the queue.
#include "runtime/bus/can/standing_frames.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "runtime/bus/can/line.hpp"

namespace ipos::runtime {
namespace {

bool before(const StandingFrame& a, const StandingFrame& b) {
  return a.at != b.at ? a.at < b.at : a.source < b.source;
}

}  // namespace

void StandingFrames::grow(size_t nodes) {
  begin_with_first();
  frames_.reserve(kOfNode * nodes);
  first_ = frames_.begin();
}

void StandingFrames::add(const StandingFrame& frame) {
  assert(has_room(1) && frame.at > queue_.now() && frame.cycle != 0 && is_valid(frame.frame) &&
         frame.frame == canonical(frame.frame));
  if (frame.at >= frame.until) return;
  begin_with_first();
  frames_.insert(std::upper_bound(frames_.begin(), frames_.end(), frame, before), frame);
  first_ = frames_.begin();
  schedule();
}

void StandingFrames::remove(NodeId node) {
  begin_with_first();
  std::erase_if(frames_, [node](const StandingFrame& frame) { return frame.node == node; });
  schedule();
}

void StandingFrames::begin_with_first() {
  std::rotate(frames_.begin(), first_, frames_.end());
  first_ = frames_.begin();
}

// The event stands where that of the station would, which may be between two others of the same time.
void StandingFrames::schedule() {
  if (event_ != kNoEvent) {
    if (!frames_.empty() && event_at_ == first_->at && event_source_ == first_->source) return;
    queue_.cancel(std::exchange(event_, kNoEvent));
  }
  if (frames_.empty()) return;
  event_at_ = first_->at;
  event_source_ = first_->source;
  event_ = queue_.schedule(event_at_, event_source_, *this, 0);
}

void StandingFrames::on_event(Time /*now*/, uint32_t /*kind*/, uint64_t /*argument*/) {
  event_ = kNoEvent;
  do send_first();
  while (!frames_.empty() && queue_.advance(first_->at, first_->source));
  schedule();
}

inline void StandingFrames::send_first() {
  const Place sent = first_;
  line_.send_canonical(sent->node, sent->frame, sent->tag, true);
  sent->at += static_cast<Time>(sent->cycle) * kMillisecond;
  if (sent->at >= sent->until) [[unlikely]] {
    first_ = frames_.erase(sent);
    if (first_ == frames_.end()) first_ = frames_.begin();
  } else {
    if (++first_ == frames_.end()) first_ = frames_.begin();
    sink(sent);
  }
}

// The last one goes in front of those that are sent later.
inline void StandingFrames::sink(Place place) {
  while (place != first_) {
    const Place next = (place == frames_.begin() ? frames_.end() : place) - 1;
    if (!before(*place, *next)) return;
    std::swap(*place, *next);
    place = next;
  }
}

}  // namespace ipos::runtime
