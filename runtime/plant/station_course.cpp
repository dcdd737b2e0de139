// Ticks on a course: drive and positioning go on as in the last millisecond, and only what moves, warms and
// counts is computed. A tick is a function of what the station is; so when one has changed nothing else
// (DriveCourse), and nobody has touched what it follows since, the next one need not be decided anew.
#include <algorithm>

#include "runtime/plant/station.hpp"
#include "runtime/services/drive_variables.hpp"

namespace ipos::runtime {
namespace {

// A drive that was not on a course is tried again after 2, 4, 8.. ticks, so that trying costs little.
constexpr uint32_t kLongestPause = 16;

}  // namespace

// The tick of a station on its course whose positioning has nothing to do.
void Station::glide(Time now) {
  const std::span<int32_t> h = machine_->variables();
  go_on(h);
  count_timers(h);
  if (!quiet_) noted_.note(h);
  try_program();
  vm::run_tick(*machine_, rates());
  if (has_news()) end_program(now);
  settle(now);
}

// Drive and positioning, and what the variables show of them.
void Station::go_on(std::span<int32_t> h) {
  Drive& drive = drive_.state();
  const int32_t before = drive.position();
  drive.go_on(1);
  if (positioning_)
    positioning_->go_on(h, drive_.syncs(), before);
  else
    show_drive(drive, h);
}

// What is written is compared with what was there before. A program that can write it with commands of its
// own is not asked: there the variables are noted each time before it runs.
void Station::touch() {
  if (touched_) return;
  touched_ = true;
  if (on_course_ && quiet_) noted_.note(machine_->variables());
}

void Station::leave_course() {
  wake();
  on_course_ = false;
}

// Behind a tick that was executed in full.
void Station::try_course() {
  if (drive_.state().accelerates() || (positioning_ && positioning_->writes_variables())) {
    course_noted_ = false;
    return;
  }
  if (!course_noted_) {
    if (course_in_ != 0) {
      --course_in_;
      return;
    }
    course_.note(drive_.state());
    course_noted_ = true;
    return;
  }
  course_noted_ = false;
  const uint32_t ticks = course_.ticks(drive_.state());
  on_course_ = ticks != 0;
  if (on_course_ && machine_) {
    const std::span<const int32_t> h = machine_->variables();
    on_course_ = noted_.same(h) && (!pid_ || PidBlock::is_off(h));
  }
  if (on_course_) {
    drive_.state().hold_course(ticks);
    course_pause_ = 1;
  } else {
    course_in_ = course_pause_ = std::min(2 * course_pause_, kLongestPause);
  }
}

}  // namespace ipos::runtime
