// Sleep: ticks that would change nothing are left out, and made up for when somebody looks or something
// happens. When a steady drive (station_steady.cpp) stands, a tick has left positioning and variables
// as they were, and the program goes round in a loop that leads nowhere, those behind it do the same.
#include <algorithm>

#include "runtime/plant/station.hpp"

namespace ipos::runtime {
namespace {

// A station that did not rest is tried again after 2, 4, 8.. ticks, so that trying costs a busy one nothing.
// To go through its program is what costs most.
constexpr uint32_t kLongestPause = 32, kLongestPauseOfProgram = 1024;

}  // namespace

// What could still change while nobody touches the station is looked at when a tick has passed.
void Station::begin_trial() {
  const bool reads_variables = machine_ && ((pid_ && !PidBlock::is_off(machine_->variables())) ||
                                            (positioning_ && !positioning_->reads_system_variables_only()));
  if (reads_variables) return;
  if (positioning_) rest_.positioning = positioning_->left();
  if (machine_) std::ranges::copy(machine_->variables(), rest_.h.begin());
  trial_ = true;
}

// In the middle of the tick, before the tasks: nobody has written a variable, so the tasks' own promise
// holds.
void Station::try_program() {
  if (!trial_) return;
  const std::span<const int32_t> h = machine_->variables();
  idle_ticks_ = std::equal(h.begin(), h.end(), rest_.h.begin())
                    ? machine_->idle_ticks(rates().commands, 256, &variables_rest_)
                    : 0;
  trial_ = idle_ticks_ != 0;
  if (!trial_) end_trial_without(kLongestPauseOfProgram);
}

void Station::end_trial_without(Ticks longest) {
  trial_ = false;
  sleep_backoff_.fail(next_tick_, longest);
}

// How many ticks may be left out behind that of the trial.
uint64_t Station::end_trial() {
  const uint64_t ticks = steady_ ? drive_.state().steady_left() : 0;
  if (positioning_ && !(rest_.positioning == positioning_->left())) return 0;
  return machine_ ? std::min(ticks, idle_ticks_ - 1) : ticks;
}

void Station::schedule_tick(Time now, Time telegram) {
  late_ = false;
  if (execution_.skip_idle && runner_ == nullptr) {
    if (trial_ || (steady_ && drive_.state().standing())) try_sleep();
    if (!asleep_ && !trial_) try_late(now, telegram);
  }
  if (!late_) end_ahead();
  const Time next = asleep_ || late_ ? std::min(back_at_, telegram) : next_tick_;
  tick_ = queue_.schedule(next, source_, *this, kTick);
}

void Station::try_sleep() {
  const uint64_t ticks = trial_ ? end_trial() : 0;
  if (ticks != 0) {
    trial_ = false;
    sleep_backoff_.succeed();
    asleep_ = true;
    back_at_ = next_tick_ + static_cast<Time>(ticks) * kMillisecond;
  } else if (trial_) {
    end_trial_without(kLongestPause);
  } else if (sleep_backoff_.due(next_tick_)) {
    begin_trial();
  }
}

// A telegram of a station that sleeps is due.
void Station::sleep_through(Time now) {
  Time next = back_at_;
  for (const auto& port : sbus_) {
    if (!port) continue;
    if (!variables_rest_ || port->sends_more_than_variables()) leave_out_to(now);
    next = std::min(next, port->tick(now));
  }
  if (asleep_) tick_ = queue_.schedule(next, source_, *this, kTick);
}

// All ticks up to that at `last`.
void Station::leave_out_to(Time last) {
  if (last < next_tick_) return;
  const auto ticks = static_cast<uint64_t>((last - next_tick_) / kMillisecond + 1);
  if (machine_) machine_->skip_ticks(rates().commands, ticks);
  drive_.state().advance(static_cast<uint32_t>(ticks));
  drive_.memory().set_time(last);
  next_tick_ = last + kMillisecond;
}

// The tick of this moment counts when its turn is over.
Time Station::last_tick() const {
  const Time now = queue_.now();
  Time last = now / kMillisecond * kMillisecond;
  if (last == now && !queue_.has_passed(source_)) last -= kMillisecond;
  return std::min(last, back_at_ - kMillisecond);
}

void Station::make_up() {
  if (asleep_) return leave_out_to(last_tick());
  if (!late_) return;
  run_late();
  end_ahead();
}

bool Station::make_up_variables() {
  if (!asleep_) return false;
  if (!variables_rest_) make_up();
  return variables_rest_;
}

void Station::get_up() {
  asleep_ = late_ = false;
  for (const auto& port : sbus_)
    if (port) port->want_again();
}

void Station::wake() {
  make_up();
  touch();
  trial_ = false;
  if (!asleep_ && !late_) return;
  get_up();
  sleep_backoff_.try_now();
  queue_.cancel(tick_);
  tick_ = queue_.schedule(next_tick_, source_, *this, kTick);
}

}  // namespace ipos::runtime
