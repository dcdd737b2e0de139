// Grid, random and Latin designs: each case is computed from its number.
#include "tools/campaign/design.hpp"

#include <algorithm>
#include <utility>

namespace ipos::tools::campaign {
namespace {

// A good mixer of 64 bits: the one of splitmix64.
uint64_t mixed(uint64_t value) {
  value += 0x9E3779B97F4A7C15;
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EB;
  return value ^ (value >> 31U);
}

}  // namespace

// A Feistel network permutes the numbers of an even count of bits; what falls outside goes round again until it is inside.
uint64_t shuffled(uint64_t n, uint64_t size, uint64_t seed) {
  unsigned half = 1;
  while (half < 32 && (uint64_t{1} << (2 * half)) < size) ++half;
  const uint64_t mask = (uint64_t{1} << half) - 1;
  do {
    uint64_t left = n >> half;
    uint64_t right = n & mask;
    for (uint64_t round = 0; round < 4; ++round)
      left = std::exchange(right, left ^ (mixed(mixed(seed + round) ^ right) & mask));
    n = left << half | right;
  } while (n >= size);
  return n;
}

Design::Design(const Sampling& sampling, std::vector<uint32_t> counts) : sampling_(sampling), counts_(std::move(counts)) {
  for (const uint32_t count : counts_) grid_ = grid_ > UINT64_MAX / count ? UINT64_MAX : grid_ * count;
  switch (sampling_.sample) {
    case Sample::Grid: size_ = grid_; break;
    case Sample::Random: size_ = std::min(sampling_.count, grid_); break;
    case Sample::Latin: size_ = sampling_.count; break;
    case Sample::Pairs:
      rows_ = pairwise(counts_, sampling_.seed);
      size_ = sampling_.count == 0 ? rows_.size() : std::min<uint64_t>(sampling_.count, rows_.size());
      break;
  }
}

void Design::levels(uint64_t rank, std::vector<uint32_t>& levels) const {
  if (sampling_.sample == Sample::Pairs) {
    levels = rows_[rank];
    return;
  }
  levels.resize(counts_.size());
  const bool drawn = sampling_.sample == Sample::Random;
  if (sampling_.sample == Sample::Latin || (drawn && grid_ == UINT64_MAX)) {
    for (size_t n = 0; n < counts_.size(); ++n) {
      const uint64_t seed = mixed(sampling_.seed) + n;
      // Of a hypercube each factor has as many strata as there are cases, and each stratum is met once.
      levels[n] = drawn ? static_cast<uint32_t>(mixed(mixed(seed) ^ rank) % counts_[n])
                        : static_cast<uint32_t>(shuffled(rank, size_, seed) * counts_[n] / size_);
    }
    return;
  }
  uint64_t number = drawn ? shuffled(rank, grid_, mixed(sampling_.seed)) : rank;
  for (size_t n = counts_.size(); n-- > 0; number /= counts_[n])
    levels[n] = static_cast<uint32_t>(number % counts_[n]);
}

}  // namespace ipos::tools::campaign
