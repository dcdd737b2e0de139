// Steady ticks: drive and positioning do what they did in the last millisecond, and only what moves, warms
// and counts is computed. A tick is a function of what the station is; so when one has changed nothing else
// (Drive::steady_since), and nobody has touched what it follows since, the next one need not be decided anew.
#include <algorithm>

#include "runtime/plant/station.hpp"
#include "runtime/services/drive_variables.hpp"

namespace ipos::runtime {
namespace {

// A drive that was not steady is tried again after 2, 4, 8.. ticks, so that trying costs little.
constexpr uint32_t kLongestPause = 16;

}  // namespace

// The tick of a steady station whose positioning has nothing to do.
void Station::steady_tick(Time now) {
  const std::span<int32_t> h = machine_->variables();
  go_on(h);
  count_timers(h);
  if (!quiet_) noted_.note(h);
  try_program();
  vm::run_tick(*machine_, rates());
  if (must_look()) end_program(now);
  settle(now);
}

// Drive and positioning, and what the variables show of them.
void Station::go_on(std::span<int32_t> h) {
  Drive& drive = drive_.state();
  const int32_t before = drive.position();
  drive.advance(1);
  if (positioning_)
    positioning_->advance(h, drive_.syncs(), before);
  else
    show_drive(drive, h);
}

// What is written is compared with what was there before. A program that can write it with commands of its
// own is not asked: there the variables are noted each time before it runs.
void Station::touch() {
  if (touched_) return;
  touched_ = true;
  if (steady_ && quiet_) noted_.note(machine_->variables());
}

void Station::leave_steady() {
  wake();
  steady_ = false;
}

// Behind a tick that was executed in full.
void Station::try_steady() {
  if (positioning_ && positioning_->writes_variables()) {
    before_tick_.reset();
    return;
  }
  if (!before_tick_) {
    if (!steady_backoff_.due(next_tick_)) return;
    before_tick_.emplace(drive_.state().moment());
    return;
  }
  const Ticks ticks = drive_.state().steady_since(*before_tick_);
  before_tick_.reset();
  steady_ = ticks != 0;
  if (steady_ && machine_) {
    const std::span<const int32_t> h = machine_->variables();
    steady_ = noted_.same(h) && (!pid_ || PidBlock::is_off(h));
  }
  if (steady_) {
    drive_.state().hold_steady(ticks);
    steady_backoff_.succeed();
  } else {
    steady_backoff_.fail(next_tick_, kLongestPause);
  }
}

}  // namespace ipos::runtime
