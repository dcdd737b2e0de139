// Late ticks: a station that can tell nobody anything before its next telegram need not execute its ticks in
// turn with those of the others. It executes them all in one go when that telegram is due, when something
// comes from outside, or when somebody looks; each finds the time it belongs to. So what it works with is in
// the cache once for many ticks.
//
// A late station cruises when its ticks only go on (station_course.cpp) and its tasks mind neither each other
// nor what the unit does meanwhile: then each task runs for many ticks at a time, and drive and positioning
// follow when they are asked for.
#include <algorithm>

#include "runtime/plant/station.hpp"

namespace ipos::runtime {
namespace {

// How late it may be, so that who watches the run sees it move on.
constexpr Time kLatest = 32 * kMillisecond;

// The program is looked at again after 16, 32, 64.. ticks.
constexpr uint32_t kFirstPause = 8, kLongestPause = 4096;

// A program that stops on its way is let run ahead again after 2, 4, 8.. ticks.
constexpr uint32_t kLongestCruisePause = 64;

}  // namespace

void Station::forget_prospect() {
  prospect_ = {};
  prospect_at_ = 0;
  prospect_pause_ = kFirstPause;
}

void Station::look_ahead() {
  std::array<const VariableObjects*, 2> objects{};
  size_t count = 0;
  for (const auto& port : sbus_)
    if (port) objects[count++] = &port->objects();
  prospect_ = Prospect(*machine_, std::span(objects).first(count));
  prospect_pause_ = std::min(2 * prospect_pause_, kLongestPause);
  prospect_at_ = next_tick_ + prospect_pause_ * kMillisecond;
}

// Nothing the station does reaches anybody before its next telegram. A fault of the program would: it takes
// back telegrams that wait, and when it is reset the program, started anew, calls the bus. It is not reset in
// time where the program does not order it.
bool Station::can_be_late() const {
  if (x13_ || xt_) return false;
  if (!machine_) return true;
  if (!prospect_.mute || machine_->fault().number != 0) return false;
  if (!prospect_.may_fault && !timers_.watchdog_runs()) return true;
  return !may_order_ && std::none_of(sbus_.begin(), sbus_.end(),
                                     [](const auto& port) { return port && port->has_waiting_frames(); });
}

void Station::try_late(Time now, Time telegram) {
  if (cruise_left_ == 0 || prospect_.may_fault) {
    const bool known = prospect_.mute && prospect_.apart;
    if (machine_ && !known && next_tick_ >= prospect_at_ && machine_->fault().number == 0) look_ahead();
    if (!can_be_late()) return;
  }
  back_at_ = now + kLatest;
  late_ = telegram > next_tick_;
}

// All late ticks up to that at `last`, and the telegrams that came in between.
void Station::execute_to(Time last) {
  for (; letters_read_ != letters_ahead_ && letters_[letters_read_].after <= last; ++letters_read_) {
    const Letter& letter = letters_[letters_read_];
    execute_all_to(letter.after);
    letter.reader->read(letter.object, letter.frame);
  }
  if (letters_read_ == letters_ahead_) letters_read_ = letters_ahead_ = 0;
  execute_all_to(last);
}

void Station::execute_all_to(Time last) {
  while (next_tick_ <= last) {
    if (stride(last)) continue;
    const Time now = next_tick_;
    next_tick_ += kMillisecond;
    const EventQueue::Past past(queue_, now, source_);
    execute(now);
  }
}

// A program that cannot fault keeps its receive objects.
bool Station::keep(ObjectReader& reader, size_t object, const Frame& frame) {
  if (!cruises() || prospect_.may_fault || letters_ahead_ == letters_.size()) return false;
  letters_[letters_ahead_++] = {last_tick(), &reader, object, frame};
  return true;
}

bool Station::stride(Time last) {
  if (cruise_left_ == 0 && (!on_course_ || next_tick_ < cruise_at_ || !begin_cruise())) return false;
  const auto ticks = std::min(static_cast<uint32_t>((last - next_tick_) / kMillisecond + 1), cruise_left_);
  if (!machine_->run_ahead(cruise_rates_.commands, ticks, prospect_.undone)) {
    end_cruise();
    cruise_pause_ = std::min(2 * cruise_pause_, kLongestCruisePause);
    cruise_at_ = next_tick_ + cruise_pause_ * kMillisecond;
    return false;
  }
  cruise_pause_ = 1;
  cruise_left_ -= ticks;
  owed_ += ticks;
  next_tick_ += ticks * kMillisecond;
  return true;
}

// Nothing that is asked here changes before somebody touches the station.
bool Station::begin_cruise() {
  if (!prospect_.apart || !quiet_ || touched_ || owed_ != 0 || !machine_) return false;
  if (!stays_on_course() || (positioning_ && !positioning_->idles()) || has_news()) return false;
  const bool moves = !drive_.state().standing();
  if ((prospect_.minds_motion && moves) || !timers_.rest(machine_->variables())) return false;
  cruise_rates_ = rates();
  cruise_left_ = drive_.state().course_left();
  return true;
}

// The last tick by itself: some values are those of the tick before.
void Station::finish_cruise() {
  cruise_left_ = 0;
  if (owed_ == 0) return;
  drive_.state().go_on(owed_ - 1);
  go_on(machine_->variables());
  drive_.memory().set_time(next_tick_ - kMillisecond);
  owed_ = 0;
}

void Station::run_late() { execute_to(last_tick()); }

// What no part of the unit looks at does not end a cruise.
void Station::expect_variables(uint32_t first) {
  if (!late_ || is_system_variable(first) || is_system_variable(first + 1)) wake();
}

}  // namespace ipos::runtime
