// The milliseconds of one unit. Its quartz may be a little slow or fast, and SYNC telegrams may shift them (P887); then they are not
// those of the plant.
#pragma once

#include <cstdint>

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

class OwnMilliseconds {
 public:
  // A quartz is wrong by 100 ppm at most; more shows the same sooner (ours).
  static constexpr int64_t kMostPpm = 10'000;

  // `ppm`: how much faster the quartz is than the time of the plant. One ppm of a millisecond is a nanosecond.
  explicit OwnMilliseconds(int64_t ppm = 0) : length_(kMillisecond - ppm) {}

  // One begins now, for example with the unit.
  void begin(Time now) {
    first_ = now;
    number_of_first_ = now / kMillisecond;
  }
  // Their begins move by this much; their numbers stay.
  void shift(Time by) { first_ += by; }

  Time length() const { return length_; }
  bool is_exact() const { return length_ == kMillisecond; }
  // How many go into a span of time.
  int64_t count(Time span) const { return is_exact() ? span / kMillisecond : span / length_; }
  // The begin of the one that holds this time.
  Time begin_of(Time time) const { return first_ + count(time - first_) * length_; }
  // Its number. They follow each other, and with an exact quartz they are those of the plant.
  int64_t number(Time time) const { return number_of_first_ + count(time - first_); }
  // When the one of this number begins, seen from a time at which one does.
  Time begin_of(int64_t number, Time begin) const { return begin + (number - this->number(begin)) * length_; }

 private:
  Time length_;
  Time first_ = 0;  // the begin of one of them, and its number
  int64_t number_of_first_ = 0;
};

}  // namespace ipos::runtime
