// What the scope has recorded: a sample of each channel a millisecond, the last million of them. Extremes of long ranges
// are found without looking at every sample, so that a whole recording can be shown at any time.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

namespace ipos::tools::serve {

class ScopeMemory {
 public:
  static constexpr size_t kKept = 1'000'000;  // samples a channel

  explicit ScopeMemory(size_t channels = 0) : channels_(channels) {}

  // Samples are numbered from 0 on; those before first() are forgotten.
  void push(const std::vector<int64_t>& samples);
  uint64_t first() const { return first_; }
  uint64_t end() const { return first_ + size(); }
  size_t channels() const { return channels_.size(); }

  int64_t at(size_t channel, uint64_t number) const { return channels_[channel].samples[number - first_]; }
  // Least and greatest of the samples from `begin` to before `end`, at least one.
  std::pair<int64_t, int64_t> extremes(size_t channel, uint64_t begin, uint64_t end) const;

 private:
  static constexpr uint64_t kBlock = 64;
  struct Channel {
    std::deque<int64_t> samples;
    std::deque<std::pair<int64_t, int64_t>>
        blocks;  // of samples n x kBlock and following, complete ones and the last
  };
  size_t size() const { return channels_.empty() ? 0 : channels_.front().samples.size(); }

  std::vector<Channel> channels_;
  uint64_t first_ = 0;  // a multiple of kBlock
};

}  // namespace ipos::tools::serve
