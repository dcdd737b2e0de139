// The loop: read the clock, take what has arrived, run up to the clock, send, wait.
#include "runtime/os_port/real_time.hpp"

#include <algorithm>

namespace ipos::runtime {

RealTimeLoop::End RealTimeLoop::run(Time end) {
  Time epoch = clock_.now() - simulation_.now();
  End result = End::Reached;
  for (;;) {
    // The clock first: what arrives after this reading belongs to the next round, at its own time.
    const Time now = clock_.now();
    epoch += forgive(now - epoch);
    const Time target = std::min(now - epoch, end);
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

Time RealTimeLoop::forgive(Time target) {
  const Time late = target - simulation_.next_time();
  if (late <= kForgiven) return 0;
  note_late(late);
  punctuality_.left_out += late;
  return late;
}

void RealTimeLoop::note_late(Time late) {
  punctuality_.worst = std::max(punctuality_.worst, late);
  if (late > kLateTick && punctuality_.first_late < 0) punctuality_.first_late = simulation_.next_time();
}

void RealTimeLoop::judge(Time target) {
  const Time late = target - simulation_.next_time();
  if (late <= 0) return;
  note_late(late);
  if (late <= kLateTick) return;
  punctuality_.late_ticks += static_cast<uint64_t>((late - kLateTick + kMillisecond - 1) / kMillisecond);
}

}  // namespace ipos::runtime
