// Numbers over the course of a signal.
#include "tools/campaign/measure.hpp"

#include <algorithm>
#include <cmath>

namespace ipos::tools::campaign {

using runtime::kMillisecond;

bool Meter::is_moment(double value) const {
  switch (measure_->when) {
    case Measure::When::Above: return value > measure_->threshold;
    case Measure::When::Below: return value < measure_->threshold;
    case Measure::When::Equals: return std::abs(value - measure_->threshold) <= std::abs(signal_.factor) / 2;
  }
  return false;
}

void Meter::sample(runtime::Time now) {
  if (measure_->take == Take::Time && moment_) return;
  const int64_t value = signal_.read();
  if (count_++ == 0) {
    first_ = most_ = least_ = value;
    begin_ = now;
  }
  last_ = value;
  most_ = std::max(most_, value);
  least_ = std::min(least_, value);
  sum_ += static_cast<double>(value);
  if (measure_->take == Take::Settling) course_.push_back(value);
  if (measure_->take == Take::Time && is_moment(shown(value))) moment_ = now;
}

std::optional<double> Meter::value() const {
  if (measure_->take == Take::Time)
    return moment_ ? std::optional(static_cast<double>(*moment_) / kMillisecond) : std::nullopt;
  if (count_ == 0) return std::nullopt;
  const int64_t way = last_ - first_;
  switch (measure_->take) {
    case Take::Max: return shown(most_);
    case Take::Min: return shown(least_);
    case Take::Mean: return sum_ / static_cast<double>(count_) * signal_.factor;
    case Take::Final: return shown(last_);
    case Take::Overshoot: {
      if (way == 0) return std::nullopt;
      const int64_t beyond = way > 0 ? most_ - last_ : last_ - least_;
      return 100 * static_cast<double>(beyond) / std::abs(static_cast<double>(way));
    }
    case Take::Settling: {
      const double band = measure_->band / 100 * std::abs(static_cast<double>(way));
      const auto far = std::find_if(course_.rbegin(), course_.rend(), [&](int64_t value) {
        return std::abs(static_cast<double>(value - last_)) > band;
      });
      if (far == course_.rend()) return 0;
      // The first millisecond of those that are all within.
      return static_cast<double>(begin_) / kMillisecond + static_cast<double>(course_.rend() - far);
    }
    case Take::Time: break;
  }
  return std::nullopt;
}

}  // namespace ipos::tools::campaign
