// Equations 7 and following of the paper, in whole nanoseconds.
#include "runtime/bus_plan/response_time.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

constexpr Time kGiveUp = 1000 * kSecond;  // a busy period this long is none that ends

Time ceil_div(Time value, Time divisor) { return (value + divisor - 1) / divisor; }

class Analysis {
 public:
  Analysis(std::span<const PeriodicFrame> frames, size_t subject, Time bit_time)
      : subject_(frames[subject]), bit_time_(bit_time) {
    for (size_t n = 0; n < frames.size(); ++n) {
      if (n == subject) continue;
      if (frames[n].id <= subject_.id)
        higher_.push_back(frames[n]);
      else
        blocking_ = std::max(blocking_, frames[n].length);
    }
  }

  ResponseTime run() const {
    ResponseTime result;
    result.blocking = blocking_;
    if (overloaded()) return result;
    result.busy_period = busy_period();
    if (result.busy_period >= kGiveUp) return result;
    result.bounded = true;
    result.instances = static_cast<uint32_t>(ceil_div(result.busy_period + subject_.jitter, subject_.period));
    Time queueing = blocking_;
    for (uint32_t q = 0; q < result.instances; ++q) {
      queueing = queueing_delay(q, queueing);
      const Time response = subject_.jitter + queueing - q * subject_.period + subject_.length;
      result.worst = std::max(result.worst, response);
      queueing += subject_.length;
    }
    return result;
  }

 private:
  // The frames take the whole of each second, where what each takes is rounded up to nanoseconds.
  bool overloaded() const {
    const auto share = [](const PeriodicFrame& frame) {
      return ceil_div(frame.length * kSecond, frame.period);
    };
    Time sum = share(subject_);
    for (const PeriodicFrame& frame : higher_) sum += share(frame);
    return sum >= kSecond;
  }

  Time busy_period() const {
    Time length = subject_.length;
    for (;;) {
      Time next = blocking_ + ceil_div(length + subject_.jitter, subject_.period) * subject_.length;
      for (const PeriodicFrame& frame : higher_)
        next += ceil_div(length + frame.jitter, frame.period) * frame.length;
      if (next == length || next >= kGiveUp) return next;
      length = next;
    }
  }

  Time queueing_delay(uint32_t instance, Time start) const {
    for (Time delay = start;;) {
      Time next = blocking_ + instance * subject_.length;
      for (const PeriodicFrame& frame : higher_)
        next += ceil_div(delay + frame.jitter + bit_time_, frame.period) * frame.length;
      if (next == delay) return delay;
      delay = next;
    }
  }

  PeriodicFrame subject_;
  Time bit_time_;
  std::vector<PeriodicFrame> higher_;
  Time blocking_ = 0;
};

}  // namespace

std::vector<ResponseTime> response_times(std::span<const PeriodicFrame> frames, Time bit_time) {
  std::vector<ResponseTime> results;
  for (size_t n = 0; n < frames.size(); ++n) results.push_back(Analysis(frames, n, bit_time).run());
  return results;
}

}  // namespace ipos::runtime
