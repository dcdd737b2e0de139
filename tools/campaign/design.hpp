// Which level each factor has in each case of a campaign: the whole grid, cases drawn at random, a Latin hypercube, or as few
// cases as are found in which every two levels of every two factors meet. Pure: the same numbers give the same cases on every
// machine, so that shards need nothing from each other.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace ipos::tools::campaign {

enum class Sample : uint8_t { Grid, Random, Latin, Pairs };

struct SampleWord {
  std::string_view word;
  Sample sample;
};
inline constexpr SampleWord kSamples[] = {
    {"grid", Sample::Grid}, {"random", Sample::Random}, {"latin", Sample::Latin}, {"pairs", Sample::Pairs}};

struct Sampling {
  Sample sample = Sample::Grid;
  uint64_t count = 0;  // 0: as many as there are (grid, pairs)
  uint64_t seed = 1;
};

// More cases nobody runs (ours): their numbers are held in memory.
inline constexpr uint64_t kMostCases = 100'000'000;

class Design {
 public:
  // `counts`: the levels of each factor, at least one each.
  Design(const Sampling& sampling, std::vector<uint32_t> counts);

  // May be above kMostCases. Cases of a Latin hypercube may come twice where factors have few levels.
  uint64_t size() const { return size_; }
  // The last factor changes first.
  void levels(uint64_t rank, std::vector<uint32_t>& levels) const;

 private:
  Sampling sampling_;
  std::vector<uint32_t> counts_;
  uint64_t grid_ = 1;  // cases of the whole grid; UINT64_MAX where they are too many to count
  uint64_t size_ = 0;
  std::vector<std::vector<uint32_t>> rows_;  // Pairs
};

// An order of the numbers below `size`, another one for each seed, without a list of them: where `n` comes.
uint64_t shuffled(uint64_t n, uint64_t size, uint64_t seed);

// Rows in which every two levels of every two factors meet.
std::vector<std::vector<uint32_t>> pairwise(const std::vector<uint32_t>& counts, uint64_t seed);
// How many such pairs there are.
uint64_t pair_count(const std::vector<uint32_t>& counts);
inline constexpr uint64_t kMostPairs = 4'000'000;  // ours: each is held while rows are made

}  // namespace ipos::tools::campaign
