// When a message has come, at the latest: what lay in the system's buffers while nobody read them may be as old as the
// pause in reading. So what is read right after a pause counts from the pause's beginning.
#pragma once

#include <algorithm>
#include <chrono>

#include "tools/serve/host/message.hpp"

namespace ipos::tools::serve {

class Arrival {
 public:
  // Reading stops, and goes on.
  void pause(WallClock::time_point now) { paused_ = now; }
  void resume(WallClock::time_point now) { resumed_ = now; }
  // The reader says from time to time that it is awake. A process that was stopped, or had no processor, was not.
  void awake(WallClock::time_point now) {
    if (now - awake_ > kNap && awake_ != WallClock::time_point{}) {
      paused_ = awake_;
      resumed_ = now;
    }
    awake_ = now;
  }
  WallClock::time_point of_message(WallClock::time_point now) const {
    return now - resumed_ < kEmptied && paused_ != WallClock::time_point{} ? std::min(paused_, now) : now;
  }

  // Both ours: longer than a busy system lets a process wait; and as long as it takes to empty the buffers.
  static constexpr auto kNap = std::chrono::milliseconds(250);
  static constexpr auto kEmptied = std::chrono::milliseconds(100);

 private:
  WallClock::time_point paused_{}, resumed_{}, awake_{};
};

}  // namespace ipos::tools::serve
