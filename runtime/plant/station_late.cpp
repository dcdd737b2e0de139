// Late ticks: a station that can tell nobody anything before its next telegram need not execute its ticks in
// turn with those of the others. It executes them all in one go when that telegram is due, when something
// comes from outside, or when somebody looks; each finds the time it belongs to. So what it works with is in
// the cache once for many ticks, and where nothing comes in between the tasks can run for many ticks at a
// time.
#include <algorithm>

#include "runtime/plant/station.hpp"
#include "runtime/services/drive_variables.hpp"
#include "vm/sched/outlook.hpp"

namespace ipos::runtime {
namespace {

using stdlib::system_variable;

// How late it may be, so that who watches the run sees it move on.
constexpr Time kLatest = 32 * kMillisecond;

// The program is looked at again after 16, 32, 64.. ticks.
constexpr uint32_t kFirstPause = 8, kLongestPause = 4096;

// What every tick writes when it is not at rest.
constexpr size_t kCounting[] = {system_variable("Timer_0"),   system_variable("Timer_1"),
                                system_variable("Timer_2"),   system_variable("T0_Reload"),
                                system_variable("WdogTimer"), system_variable("VarIntReq")};

}  // namespace

void Station::forget_outlook() {
  mute_ = apart_ = false;
  outlook_at_ = 0;
  outlook_pause_ = kFirstPause;
}

// What the program can reach only gets less until it is started anew: so what has been found stays true.
void Station::look_ahead() {
  const vm::Outlook outlook(*machine_);
  using vm::Opcode;
  mute_ = true;
  for (const Opcode call : {Opcode::Movlnk, Opcode::Scom, Opcode::ScomOn, Opcode::ScomState})
    mute_ = mute_ && !outlook.reaches(call);
  may_fault_ = outlook.may_fault();
  const auto uses = [&](size_t variable) { return outlook.used()[variable]; };
  apart_ = quiet_ && outlook.apart() && outlook.written().count() <= vm::Machine::kMostWrittenAhead &&
           std::none_of(std::begin(kCounting), std::end(kCounting), uses);
  minds_motion_ =
      std::any_of(std::begin(PositioningService::kMoving), std::end(PositioningService::kMoving), uses);
  written_.clear();
  if (apart_)
    for (size_t n = 0; n < outlook.written().size(); ++n)
      if (outlook.written()[n]) written_.push_back(static_cast<uint16_t>(n));
}

// Nothing the station does reaches anybody before its next telegram. A fault of the program would: it takes
// back telegrams that wait, and when it is reset the program, started anew, calls the bus. It is not reset in
// time where the program does not order it.
bool Station::can_be_late() const {
  if (x13_ || xt_) return false;
  if (!machine_) return true;
  if (!mute_ || machine_->fault().number != 0) return false;
  if (!may_fault_ && !timers_.watchdog_runs()) return true;
  return !may_order_ && std::none_of(sbus_.begin(), sbus_.end(),
                                     [](const auto& port) { return port && port->has_waiting_frames(); });
}

void Station::try_late(Time now) {
  if (machine_ && !(mute_ && apart_) && next_tick_ >= outlook_at_ && machine_->fault().number == 0) {
    look_ahead();
    outlook_pause_ = std::min(2 * outlook_pause_, kLongestPause);
    outlook_at_ = next_tick_ + outlook_pause_ * kMillisecond;
  }
  if (!can_be_late()) return;
  back_at_ = now + kLatest;
  late_ = next_event(now) > next_tick_;
}

// All late ticks up to that at `last`.
void Station::execute_to(Time last) {
  while (next_tick_ <= last) {
    if (stride(last)) continue;
    const Time now = next_tick_;
    next_tick_ += kMillisecond;
    const EventQueue::Past past(queue_, now, source_);
    execute(now);
  }
}

// Ticks that only go on, and whose tasks run as if the others were not there: many at a time.
bool Station::stride(Time last) {
  if (!apart_ || last <= next_tick_) return false;
  on_course_ = on_course_ && stays_on_course();
  touched_ = false;
  Drive& drive = drive_.state();
  if (!on_course_ || !machine_ || (positioning_ && !positioning_->idles()) || has_news()) return false;
  const std::span<int32_t> h = machine_->variables();
  if ((minds_motion_ && !drive.standing()) || !timers_.rest(h)) return false;
  const auto ticks =
      std::min(static_cast<uint32_t>((last - next_tick_) / kMillisecond + 1), drive.course_left());
  if (ticks < 2) return false;
  if (!machine_->run_ahead(rates().commands, ticks, written_)) return false;
  drive.go_on(ticks - 1);
  go_on(h);
  next_tick_ += ticks * kMillisecond;
  settle(next_tick_ - kMillisecond);
  return true;
}

// A fault of the program must not be found too late: see can_be_late().
void Station::expect_variables() {
  if (!late_ || may_fault_) return wake();
  make_up();
  touch();
}

}  // namespace ipos::runtime
