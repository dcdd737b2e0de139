// Samples go round in a ring until the trigger comes.
#include "runtime/drive/scope.hpp"

#include <algorithm>
#include <cassert>

namespace ipos::runtime {

void Scope::start(const Order& order) {
  order_ = order;
  order_.every = std::max(order.every, 1U);
  order_.samples = std::clamp(order.samples, 2U, kMostSamples);
  order_.before = order.edge == Edge::None ? 0 : std::min(order.before, order_.samples - 1);
  samples_.clear();
  samples_.reserve(order_.samples);
  oldest_ = 0;
  wait_ = 0;
  if (order_.edge == Edge::None) {
    state_ = State::Recording;
    left_ = order_.samples;
  } else {
    // An edge needs a sample to come from.
    state_ = State::Filling;
    left_ = std::max(order_.before, 1U);
  }
}

bool Scope::tick() {
  if (wait_ != 0) {
    --wait_;
    return false;
  }
  wait_ = order_.every - 1;
  return true;
}

bool Scope::triggers(int32_t value) const {
  assert(!samples_.empty());  // an edge has a sample to come from
  const int32_t last = samples_[(oldest_ + samples_.size() - 1) % samples_.size()][0];
  return order_.edge == Edge::Rising ? last < order_.level && value >= order_.level
                                     : last > order_.level && value <= order_.level;
}

void Scope::take(const Sample& sample) {
  if (state_ == State::Waiting && triggers(sample[0])) {
    state_ = State::Recording;
    left_ = order_.samples - order_.before;
    std::rotate(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(oldest_), samples_.end());
    oldest_ = 0;
    samples_.resize(order_.before);  // the one that only the edge needed goes
  }
  store(sample);
  if (state_ == State::Waiting || --left_ != 0) return;
  state_ = state_ == State::Filling ? State::Waiting : State::Done;
}

// While it waits, as many are kept as come before the trigger.
void Scope::store(const Sample& sample) {
  assert(state_ != State::Done);
  const size_t most = state_ == State::Waiting ? std::max(order_.before, 1U) : order_.samples;
  if (samples_.size() < most) return samples_.push_back(sample);
  samples_[oldest_] = sample;
  oldest_ = (oldest_ + 1) % samples_.size();
}

}  // namespace ipos::runtime
