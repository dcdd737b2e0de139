// Which part of a run's time goes to those who look at it: a tenth at most, however fast they ask. After a look comes a pause that is
// nine times as long, and idle looks come each 2 ms.
#pragma once

#include <algorithm>
#include <chrono>

namespace ipos::tools::debug {

class OnlookerShare {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kBetween{2};  // looks at the port
  static constexpr int kParts = 10;                        // one of so many parts of the time goes to answers, at most

  bool is_due(Time now) const { return now >= next_; }
  void looked(Time begin, Time end) { next_ = begin + std::max<Time::duration>(kBetween, kParts * (end - begin)); }

 private:
  Time next_{};
};

}  // namespace ipos::tools::debug
