// What a campaign measures of a run: a number over the course of a signal, looked at once a millisecond.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/find.hpp"

namespace ipos::tools::campaign {

enum class Take : uint8_t { Max, Min, Mean, Final, Overshoot, Settling, Time };

struct TakeWord {
  std::string_view word;
  Take take;
  std::string_view unit;  // empty: that of the signal
};
inline constexpr TakeWord kTakes[] = {
    {"max", Take::Max, ""},         {"min", Take::Min, ""},         {"mean", Take::Mean, ""}, {"final", Take::Final, ""},
    {"overshoot", Take::Overshoot, "%"}, {"settling", Take::Settling, "ms"}, {"time", Take::Time, "ms"}};

struct Measure {
  std::string signal;
  Take take = Take::Final;
  double band = 2;  // Settling: % of the way from the first value to the last
  enum class When : uint8_t { Above, Below, Equals } when = When::Above;  // Time
  double threshold = 0;
  runtime::FilePlace signal_place;
};

// One measure under way.
class Meter {
 public:
  Meter(const Measure& measure, signals::Signal signal) : measure_(&measure), signal_(std::move(signal)) {}

  // After every millisecond.
  void sample(runtime::Time now);
  // Nothing: the moment did not come, or there is no such number.
  std::optional<double> value() const;

 private:
  double shown(int64_t sample) const { return static_cast<double>(sample) * signal_.factor; }
  bool is_moment(double value) const;

  const Measure* measure_;
  signals::Signal signal_;
  uint64_t count_ = 0;
  int64_t first_ = 0;
  int64_t last_ = 0;
  int64_t most_ = 0;
  int64_t least_ = 0;
  double sum_ = 0;
  runtime::Time begin_ = 0;
  std::optional<runtime::Time> moment_;
  std::vector<int64_t> course_;  // Settling: what is far from the last value is known at the end only
};

}  // namespace ipos::tools::campaign
