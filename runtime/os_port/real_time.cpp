// The loop: read the clock, take what has arrived, run up to the clock, send, wait.
#include "runtime/os_port/real_time.hpp"

#include <algorithm>

namespace ipos::runtime {

RealTimeLoop::End RealTimeLoop::run(Time end) {
  const Time epoch = clock_.now() - simulation_.now();
  End result = End::Reached;
  for (;;) {
    // The clock first: what arrives after this reading belongs to the next round, at its own time.
    const Time target = std::min(clock_.now() - epoch, end);
    bool all_there = true;
    for (RealTimeMember* member : members_) all_there &= member->collect(epoch);
    judge(target);
    const bool goes_on = simulation_.run_until(target);
    all_there &= flush();
    if (!goes_on) result = End::Stopped;
    if (!all_there) result = End::PortGone;
    if (result != End::Reached || target >= end) break;
    needs_.clear();
    for (const RealTimeMember* member : members_) needs_.push_back(member->needs());
    clock_.wait(epoch + std::min(simulation_.next_time(), end), needs_);
  }
  punctuality_.lag = std::max<Time>(0, clock_.now() - epoch - simulation_.now());
  return result;
}

bool RealTimeLoop::flush() {
  bool all_there = true;
  for (RealTimeMember* member : members_) all_there &= member->flush();
  return all_there;
}

void RealTimeLoop::judge(Time target) {
  const Time due = simulation_.next_time();
  if (due >= target) return;
  const Time late = target - due;
  punctuality_.worst = std::max(punctuality_.worst, late);
  if (late <= kLateTick) return;
  if (punctuality_.first_late < 0) punctuality_.first_late = due;
  punctuality_.late_ticks += static_cast<uint64_t>((late - kLateTick + kMillisecond - 1) / kMillisecond);
}

}  // namespace ipos::runtime
