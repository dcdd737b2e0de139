// Whole blocks of samples are forgotten at once.
#include "tools/serve/scope_memory.hpp"

#include <algorithm>

namespace ipos::tools::serve {

void ScopeMemory::push(const std::vector<int64_t>& samples) {
  if (channels_.empty()) return;
  if (size() >= kKept + kBlock) {
    for (Channel& channel : channels_) {
      channel.samples.erase(channel.samples.begin(),
                            channel.samples.begin() + static_cast<ptrdiff_t>(kBlock));
      channel.blocks.pop_front();
    }
    first_ += kBlock;
  }
  const bool begins_block = size() % kBlock == 0;
  for (size_t n = 0; n < channels_.size(); ++n) {
    Channel& channel = channels_[n];
    const int64_t sample = samples[n];
    channel.samples.push_back(sample);
    if (begins_block) {
      channel.blocks.emplace_back(sample, sample);
      continue;
    }
    auto& [least, greatest] = channel.blocks.back();
    least = std::min(least, sample);
    greatest = std::max(greatest, sample);
  }
}

std::pair<int64_t, int64_t> ScopeMemory::extremes(size_t channel, uint64_t begin, uint64_t end) const {
  const Channel& of = channels_[channel];
  std::pair<int64_t, int64_t> found{at(channel, begin), at(channel, begin)};
  const auto add = [&found](int64_t least, int64_t greatest) {
    found.first = std::min(found.first, least);
    found.second = std::max(found.second, greatest);
  };
  for (uint64_t n = begin; n < end;) {
    if (n % kBlock == 0 && n + kBlock <= end) {
      const auto& [least, greatest] = of.blocks[(n - first_) / kBlock];
      add(least, greatest);
      n += kBlock;
      continue;
    }
    const int64_t sample = at(channel, n++);
    add(sample, sample);
  }
  return found;
}

}  // namespace ipos::tools::serve
