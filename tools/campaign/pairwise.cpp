// Every two levels of every two factors meet: rows one after the other, each begun with a pair that has not met yet and filled
// with the levels that bring most others together. Each row covers its first pair, so all are covered at the end.
#include <algorithm>
#include <numeric>

#include "tools/campaign/design.hpp"

namespace ipos::tools::campaign {
namespace {

class Pairs {
 public:
  explicit Pairs(const std::vector<uint32_t>& counts) : counts_(counts), begins_(counts.size() * counts.size()) {
    size_t size = 0;
    for (size_t a = 0; a < counts.size(); ++a)
      for (size_t b = a + 1; b < counts.size(); ++b) {
        begins_[a * counts.size() + b] = size;
        size += size_t{counts[a]} * counts[b];
      }
    met_.resize(size);
  }

  bool have_met(size_t a, uint32_t of_a, size_t b, uint32_t of_b) const { return met_[at(a, of_a, b, of_b)]; }
  void meet(size_t a, uint32_t of_a, size_t b, uint32_t of_b) { met_[at(a, of_a, b, of_b)] = true; }

 private:
  size_t at(size_t a, uint32_t of_a, size_t b, uint32_t of_b) const {
    if (a > b) return at(b, of_b, a, of_a);
    return begins_[a * counts_.size() + b] + size_t{of_a} * counts_[b] + of_b;
  }

  const std::vector<uint32_t>& counts_;
  std::vector<size_t> begins_;
  std::vector<bool> met_;
};

class Builder {
 public:
  Builder(const std::vector<uint32_t>& counts, uint64_t seed) : counts_(counts), seed_(seed), pairs_(counts) {}

  std::vector<std::vector<uint32_t>> rows() {
    for (size_t a = 0; a < counts_.size(); ++a)
      for (size_t b = a + 1; b < counts_.size(); ++b)
        for (uint32_t of_a = 0; of_a < counts_[a]; ++of_a)
          for (uint32_t of_b = 0; of_b < counts_[b]; ++of_b)
            if (!pairs_.have_met(a, of_a, b, of_b)) rows_.push_back(row_with(a, of_a, b, of_b));
    return std::move(rows_);
  }

 private:
  std::vector<uint32_t> row_with(size_t a, uint32_t of_a, size_t b, uint32_t of_b) {
    std::vector<uint32_t> row(counts_.size());
    std::vector<size_t> set{a, b};
    row[a] = of_a;
    row[b] = of_b;
    pairs_.meet(a, of_a, b, of_b);
    for (size_t n = 0; n < counts_.size(); ++n) {
      const size_t factor = shuffled(n, counts_.size(), seed_ + rows_.size());
      if (factor == a || factor == b) continue;
      row[factor] = best(factor, row, set);
      for (const size_t other : set) pairs_.meet(factor, row[factor], other, row[other]);
      set.push_back(factor);
    }
    return row;
  }

  // The level that meets most of the row for the first time; among equals one by chance.
  uint32_t best(size_t factor, const std::vector<uint32_t>& row, const std::vector<size_t>& set) const {
    uint32_t found = 0;
    size_t most = 0;
    const uint64_t first = shuffled(rows_.size() % counts_[factor], counts_[factor], seed_ + factor);
    for (uint32_t n = 0; n < counts_[factor]; ++n) {
      const auto level = static_cast<uint32_t>((first + n) % counts_[factor]);
      const auto fresh = static_cast<size_t>(std::count_if(set.begin(), set.end(), [&](size_t other) {
        return !pairs_.have_met(factor, level, other, row[other]);
      }));
      if (n != 0 && fresh <= most) continue;
      found = level;
      most = fresh;
    }
    return found;
  }

  const std::vector<uint32_t>& counts_;
  uint64_t seed_;
  Pairs pairs_;
  std::vector<std::vector<uint32_t>> rows_;
};

}  // namespace

uint64_t pair_count(const std::vector<uint32_t>& counts) {
  uint64_t pairs = 0;
  for (size_t a = 0; a < counts.size(); ++a)
    for (size_t b = a + 1; b < counts.size(); ++b) pairs += uint64_t{counts[a]} * counts[b];
  return pairs;
}

std::vector<std::vector<uint32_t>> pairwise(const std::vector<uint32_t>& counts, uint64_t seed) {
  if (counts.size() != 1) return Builder(counts, seed).rows();
  std::vector<std::vector<uint32_t>> rows;
  for (uint32_t n = 0; n < counts[0]; ++n) rows.push_back({n});
  return rows;
}

}  // namespace ipos::tools::campaign
