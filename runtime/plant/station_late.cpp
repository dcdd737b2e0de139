// Late ticks: a station that can tell nobody anything before its next telegram need not execute its ticks in
// turn with those of the others. It executes them all in one go when that telegram is due, when something
// comes from outside, or when somebody looks; each finds the time it belongs to. So what it works with is in
// the cache once for many ticks.
//
// A late station runs ahead when its ticks are steady (station_steady.cpp) and its tasks look at neither each
// other nor what the unit does meanwhile: then each task runs for many ticks at a time, and drive and
// positioning follow when they are asked for.
#include <algorithm>

#include "runtime/plant/station.hpp"

namespace ipos::runtime {
namespace {

// How late it may be, so that who watches the run sees it move on.
constexpr Time kLatest = 32 * kMillisecond;

// The program is looked at again after 2, 4, 8.. ticks.
constexpr Ticks kLongestPause = 4096;

// A program that stops on its way is let run ahead again after 2, 4, 8.. ticks.
constexpr uint32_t kLongestAheadPause = 64;

}  // namespace

void Station::forget_reach() {
  reach_ = {};
  reach_backoff_ = {};
}

void Station::find_reach() {
  std::array<const VariableObjects*, 2> objects{};
  size_t count = 0;
  for (const auto& port : sbus_)
    if (port) objects[count++] = &port->objects();
  reach_ = ProgramReach(*machine_, std::span(objects).first(count));
  reach_backoff_.fail(next_tick_, kLongestPause);
}

// Nothing the station does reaches anybody before its next telegram. A fault of the program would: it takes
// back telegrams that wait, and when it is reset the program, started anew, calls the bus. It is not reset in
// time where the program does not order it.
bool Station::can_be_late() const {
  if (x13_ || xt_) return false;
  if (!machine_) return true;
  if (!reach_.mute || machine_->fault().number != 0) return false;
  if (!reach_.may_fault && !timers_.watchdog_runs()) return true;
  return !may_order_ && std::none_of(sbus_.begin(), sbus_.end(),
                                     [](const auto& port) { return port && port->has_waiting_frames(); });
}

void Station::try_late(Time now, Time telegram) {
  if (ahead_left_ == 0 || reach_.may_fault) {
    const bool known = reach_.mute && reach_.apart;
    if (machine_ && !known && reach_backoff_.due(next_tick_) && machine_->fault().number == 0) find_reach();
    if (!can_be_late()) return;
  }
  back_at_ = now + kLatest;
  late_ = telegram > next_tick_;
}

// All late ticks up to that at `last`, and the telegrams that came in between.
void Station::execute_to(Time last) {
  for (; read_ != posted_ && inbox_[read_].after <= last; ++read_) {
    const Telegram& telegram = inbox_[read_];
    execute_all_to(telegram.after);
    telegram.reader->read(telegram.object, telegram.frame);
  }
  if (read_ == posted_) read_ = posted_ = 0;
  execute_all_to(last);
}

void Station::execute_all_to(Time last) {
  while (next_tick_ <= last) {
    if (run_ahead(last)) continue;
    const Time now = next_tick_;
    next_tick_ += kMillisecond;
    const EventQueue::Past past(queue_, now, source_);
    execute(now);
  }
}

// A program that cannot fault keeps its receive objects.
bool Station::keep(ObjectReader& reader, size_t object, const Frame& frame) {
  if (!runs_ahead() || reach_.may_fault || posted_ == inbox_.size()) return false;
  inbox_[posted_++] = {last_tick(), &reader, object, frame};
  return true;
}

bool Station::run_ahead(Time last) {
  if (ahead_left_ == 0 && (!steady_ || !ahead_backoff_.due(next_tick_) || !begin_ahead())) return false;
  const auto ticks = std::min(static_cast<uint32_t>((last - next_tick_) / kMillisecond + 1), ahead_left_);
  if (!machine_->run_ahead(ahead_rates_.commands, ticks, reach_.rollback)) {
    end_ahead();
    ahead_backoff_.fail(next_tick_, kLongestAheadPause);
    return false;
  }
  ahead_backoff_.succeed();
  ahead_left_ -= ticks;
  behind_ += ticks;
  next_tick_ += ticks * kMillisecond;
  return true;
}

// Nothing that is asked here changes before somebody touches the station.
bool Station::begin_ahead() {
  if (!reach_.apart || !quiet_ || touched_ || behind_ != 0 || !machine_) return false;
  if (!stays_steady() || (positioning_ && !positioning_->idles()) || must_look()) return false;
  const bool moves = !drive_.state().standing();
  if ((reach_.reads_position && moves) || !timers_.rest(machine_->variables())) return false;
  ahead_rates_ = rates();
  ahead_left_ = drive_.state().steady_left();
  return true;
}

// The last tick by itself: some values are those of the tick before.
void Station::finish_ahead() {
  ahead_left_ = 0;
  if (behind_ == 0) return;
  drive_.state().advance(behind_ - 1);
  go_on(machine_->variables());
  drive_.memory().set_time(next_tick_ - kMillisecond);
  behind_ = 0;
}

void Station::run_late() { execute_to(last_tick()); }

// A variable that no part of the unit looks at does not end running ahead.
void Station::expect_variables(uint32_t first) {
  if (!late_ || is_system_variable(first) || is_system_variable(first + 1)) wake();
}

}  // namespace ipos::runtime
